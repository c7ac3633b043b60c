// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/operators/external_forces.h"

#include "meniscus/core/chunks.h"
#include "meniscus/core/error.h"
#include "meniscus/operators/lift_films.h"
#include "meniscus/state/contact_line.h"

#include <fmt/format.h>
#include <boost/container/small_vector.hpp>

#include <algorithm>

namespace meniscus {
namespace {

using Eigen::Vector3d;

/// How often a vertex that leaves one solid may end up in another before it is left where it is.
constexpr int max_collision_passes = 3;

constexpr double least_turn_cosine = 0.8660254037844387;  // 30 degrees
constexpr int most_halvings = 5;

/// Where a drop fell to.
struct Fallen {
  Eigen::AlignedBox3d box;
  Vector3d sum;  // of positions and velocities: finite if all are

  Fallen& operator+=(const Fallen& other) {
    box.extend(other.box);
    sum += other.sum;
    return *this;
  }
};

/// v += g dt; x += v dt. Returns the box of the new positions; throws if it is not finite.
Eigen::AlignedBox3d fall(Drop& drop, const Vector3d& gravity, double dt) {
  const Fallen fallen =
      sum_over_chunks(drop.num_rows(), Fallen{{}, Vector3d::Zero()}, [&](std::size_t begin, std::size_t end) {
        Columns x = drop.positions(), v = drop.velocities();
        const std::uint16_t* const degree = drop.connectivity().degrees();
        const Vector3d dv = gravity * dt;
        Eigen::AlignedBox3d box;
        Vector3d sum = Vector3d::Zero();
        for (auto i = static_cast<Eigen::Index>(begin); i < static_cast<Eigen::Index>(end); ++i) {
          if (degree[i] == 0) continue;
          v.col(i) += dv;
          x.col(i) += v.col(i) * dt;
          box.extend(Vector3d(x.col(i)));
          sum += x.col(i) + v.col(i);
        }
        return Fallen{box, sum};
      });
  if (!fallen.sum.allFinite())
    throw NumericsError(
        fmt::format("drop {}: a position or velocity is no longer finite; use a smaller time step", drop.id()));
  return fallen.box;
}

/// Marks in `wet` the colliding vertices that belong to a wetted face.
void mark_wetted(const Drop& drop, std::vector<std::uint8_t>& wet) {
  const Contact* contact = drop.contact();
  wet.assign(drop.num_rows(), 0);
  for (std::uint32_t i = 0; i < drop.num_rows(); ++i) {
    if (!is_colliding(contact[i])) continue;
    const Ring ring = drop.connectivity().ring(i);
    bool previous = ring.degree > 0 && is_colliding(contact[ring.neighbour[ring.degree - 1]]);
    for (int k = 0; k < ring.degree && wet[i] == 0; ++k) {
      const bool colliding = is_colliding(contact[ring.neighbour[k]]);
      wet[i] = colliding && previous;
      previous = colliding;
    }
  }
}

/// Eq 2, relative to the solid: the new velocity.
Vector3d apply_friction(const Vector3d& velocity, const Vector3d& solid_velocity, double epsilon) {
  const Vector3d slip = velocity - solid_velocity;
  const double speed = slip.norm();
  if (speed <= epsilon) return solid_velocity;
  return velocity - epsilon / speed * slip;
}

class Collider {
 public:
  Collider(Drop& drop, const std::vector<Solid>& solids, const Eigen::AlignedBox3d& box, double time, double dt,
           const ExternalForcesOptions& options)
      : drop_(drop),
        solids_(solids),
        x_(drop.positions()),
        v_(drop.velocities()),
        n_(drop.contact_normals()),
        time_(time),
        dt_(dt),
        options_(options) {
    for (std::size_t s = 0; s < solids.size(); ++s) {
      if (!solids[s].is_near(box, time, options.touching_distance)) continue;
      near_.push_back(s);
      hangs_.push_back(solids[s].inflow && hangs_from(drop, static_cast<std::int32_t>(s)));
    }
    if (near_.size() != 1 || !options.no_slip) return;
    const Solid& only = solids[near_[0]];
    if (!only.inflow && only.offset(time) == only.offset(time - dt)) holder_ = static_cast<std::int32_t>(near_[0]);
  }

  /// Whether any vertex needs a look: some solid is near, or some vertex was on one.
  bool has_work(bool was_in_contact) const { return !near_.empty() || was_in_contact; }

  /// Eqs 1 and 2 at vertex i, which was in state `before` (`stays`: it cannot leave its solid; `drop_is_held`: some
  /// vertex of the drop stays).
  bool collide(std::uint32_t i, Contact before, bool stays, bool drop_is_held) {
    std::int32_t& touched = drop_.contact_solid()[i];
    if (stays && before == Contact::wetted && is_held(i, touched)) return true;
    if (!stays) touched = -1;
    bool colliding = stays && touched >= 0;
    if (colliding && solids_[touched].inflow) {
      hold(i, solids_[touched], before);
      return true;
    }
    if (colliding) place_on(static_cast<std::size_t>(touched), i, follow(i, solids_[touched], before), true);
    const bool may_leave = is_colliding(before) && !stays && drop_is_held;
    for (int pass = 0; pass < max_collision_passes; ++pass) {
      std::size_t deepest = solids_.size();
      SolidContact contact{0, Vector3d::Zero(), Vector3d::Zero()};
      for (std::size_t k = 0; k < near_.size(); ++k) {
        const std::size_t s = near_[k];
        if (colliding && static_cast<std::int32_t>(s) == touched) continue;
        if (!solids_[s].is_near(Vector3d(x_.col(i)), time_, options_.touching_distance)) continue;
        const SolidContact candidate = solids_[s].query(x_.col(i), time_);
        if (candidate.distance <= options_.touching_distance &&
            (deepest == solids_.size() || candidate.distance < contact.distance) &&
            !(solids_[s].inflow && comes_from_behind(i, solids_[s], hangs_[k] != 0, candidate)) &&
            !(may_leave && only_rests_on(solids_[s], i, candidate))) {
          deepest = s;
          contact = candidate;
        }
      }
      if (deepest == solids_.size()) break;
      place_on(deepest, i, contact, !colliding);
      if (!colliding) touched = static_cast<std::int32_t>(deepest);
      colliding = true;
    }
    if (colliding) slow(i, before);
    return colliding;
  }

 private:
  /// Inside the wetted area of a solid at rest, without slip and with no other solid near, a vertex stands still.
  bool is_held(std::uint32_t i, std::int32_t touched) const { return touched == holder_ && v_.col(i).isZero(0); }

  /// A vertex that lies on a solid alone, with no wetted face, is held by nothing, unless its drop is just landing.
  bool only_rests_on(const Solid& solid, std::uint32_t i, const SolidContact& contact) const {
    constexpr double rounding = 1e-12;  // cm
    return contact.distance > -rounding && (v_.col(i) - solid.velocity(time_)).dot(contact.normal) >= 0;
  }

  /// A source's disc stops what comes on it from the front. What else gets behind it passes: a vertex deeper than it
  /// went in this step and its faces reach, and, of a drop that does not hang from the disc, one whose faces look the
  /// disc's way.
  bool comes_from_behind(std::uint32_t i, const Solid& source, bool hangs, const SolidContact& contact) const {
    const Ring ring = drop_.connectivity().ring(i);
    const Vector3d x = x_.col(i);
    Vector3d normal = Vector3d::Zero();
    double length = 0;
    for (int k = 0; k < ring.degree; ++k) {
      const Vector3d u = Vector3d(x_.col(ring.neighbour[k])) - x;
      normal += u.cross(Vector3d(x_.col(ring.neighbour[k + 1 == ring.degree ? 0 : k + 1])) - x);
      length += u.norm() / ring.degree;
    }
    const double way = std::max(0.0, -(v_.col(i) - source.velocity(time_)).dot(contact.normal)) * dt_;
    return -contact.distance > way + 0.5 * length || (!hangs && normal.dot(contact.normal) > 0);
  }

  /// Where a vertex that stays on its solid is now. A contact line vertex goes no further than the normal turns
  /// by 30 degrees, so that it does not pass an edge without having been on it: there Gibbs's condition holds it.
  SolidContact follow(std::uint32_t i, const Solid& solid, Contact before) {
    SolidContact contact = solid.query(x_.col(i), time_);
    if (before != Contact::line) return contact;
    const Vector3d solid_velocity = solid.velocity(time_), normal_old = n_.col(i);
    for (int halving = 0; halving < most_halvings && contact.normal.dot(normal_old) < least_turn_cosine; ++halving) {
      const Vector3d back = 0.5 * (v_.col(i) - solid_velocity);
      v_.col(i) -= back;
      x_.col(i) -= back * dt_;
      contact = solid.query(x_.col(i), time_);
    }
    return contact;
  }

  /// On a source: where it was, with the velocity of what comes out.
  void hold(std::uint32_t i, const Solid& source, Contact before) {
    const Vector3d solid_velocity = source.velocity(time_);
    const Vector3d was = x_.col(i) - (v_.col(i) - solid_velocity) * dt_;
    const SolidContact contact = source.query(was, time_);
    x_.col(i) = before == Contact::line ? source.rim_point(was, time_, options_.longest_edge) : contact.point;
    v_.col(i) = solid_velocity + source.inflow->speed_at(time_) * contact.normal;
    n_.col(i) = contact.normal;
  }

  /// To the nearest point of the solid, without relative velocity along the normal (Eq 1).
  void place_on(std::size_t s, std::uint32_t i, const SolidContact& contact, bool keep_normal) {
    const Vector3d relative = v_.col(i) - solids_[s].velocity(time_);
    x_.col(i) = contact.point;
    v_.col(i) -= relative.dot(contact.normal) * contact.normal;
    if (keep_normal) n_.col(i) = contact.normal;
  }

  /// Friction, or no slip inside the wetted area; moves the vertex by the change of its velocity.
  void slow(std::uint32_t i, Contact before) {
    const Solid& solid = solids_[drop_.contact_solid()[i]];
    const Vector3d solid_velocity = solid.velocity(time_);
    const double epsilon = options_.friction_per_step ? solid.friction_speed : solid.friction_speed * dt_ * 240;
    const Vector3d old = v_.col(i);
    v_.col(i) =
        options_.no_slip && before == Contact::wetted ? solid_velocity : apply_friction(old, solid_velocity, epsilon);
    const Vector3d change = v_.col(i) - old, n = n_.col(i);
    x_.col(i) += (change - change.dot(n) * n) * dt_;
  }

  Drop& drop_;
  const std::vector<Solid>& solids_;
  boost::container::small_vector<std::size_t, 8> near_;
  boost::container::small_vector<std::uint8_t, 8> hangs_;  // for each: it is a source, and the drop hangs from it
  std::int32_t holder_ = -2;  // the one solid that is near, if it is at rest and holds what is on it; else none
  Columns x_, v_, n_;
  double time_, dt_;
  const ExternalForcesOptions& options_;
};

}  // namespace

ExternalForcesReport apply_external_forces(Drop& drop, const std::vector<Solid>& solids, double time, double dt,
                                           const ExternalForcesOptions& options) {
  ExternalForcesReport report;
  const Eigen::AlignedBox3d box = fall(drop, options.gravity, dt);
  if (solids.empty()) return report;
  Contact* contact = drop.contact();
  const auto n = static_cast<std::uint32_t>(drop.num_rows());
  const bool was_in_contact = touches_solid(drop);
  Collider collider(drop, solids, box, time, dt, options);
  if (!collider.has_work(was_in_contact)) return report;

  std::vector<std::uint8_t>& stays = drop.workspace().fixed;
  mark_wetted(drop, stays);
  const bool drop_is_held = std::any_of(stays.begin(), stays.end(), [](std::uint8_t s) { return s != 0; });
  std::vector<std::uint32_t> landed;
  for (std::uint32_t i = 0; i < n; ++i) {
    if (drop.connectivity().degree(i) == 0) continue;
    const bool colliding = collider.collide(i, contact[i], stays[i] != 0, drop_is_held);
    if (colliding && !is_colliding(contact[i])) landed.push_back(i);
    contact[i] = colliding ? Contact::wetted : Contact::free;
  }
  lift_landed(drop, solids, time, landed, stays);
  report.colliding = static_cast<std::size_t>(std::count_if(contact, contact + n, is_colliding));
  mark_contact_line(drop);
  return report;
}

void find_contact(Drop& drop, const std::vector<Solid>& solids, double time, double tolerance) {
  Contact* contact = drop.contact();
  for (std::uint32_t i = 0; i < drop.num_rows(); ++i) {
    contact[i] = Contact::free;
    drop.contact_solid()[i] = -1;
    double nearest = tolerance;
    for (std::size_t s = 0; s < solids.size(); ++s) {
      const Vector3d x = drop.positions().col(i);
      if (!solids[s].is_near(x, time, tolerance)) continue;
      const SolidContact candidate = solids[s].query(x, time);
      if (candidate.distance > nearest || (solids[s].inflow && candidate.distance < -tolerance)) continue;
      nearest = candidate.distance;
      contact[i] = Contact::wetted;
      drop.contact_solid()[i] = static_cast<std::int32_t>(s);
      drop.contact_normals().col(i) = candidate.normal;
    }
  }
  mark_contact_line(drop);
}

}  // namespace meniscus
