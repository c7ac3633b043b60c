// SPDX-License-Identifier: GPL-3.0-or-later
#include "references/drop_at_rest.h"

#include "meniscus/core/error.h"

#include <fmt/format.h>
#include <boost/math/constants/constants.hpp>
#include <boost/math/tools/roots.hpp>
#include <boost/numeric/odeint.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

namespace meniscus::references {
namespace {

constexpr double pi = boost::math::constants::pi<double>();

/// r, z (down from a sessile drop's apex, up from a pendant one's), phi, volume, air area, moment of z.
using State = std::array<double, 6>;

/// The equations in units of the radius of the ball of the same volume. `bond` is rho g R^2/sigma, negative
/// for pendant drops.
struct YoungLaplace {
  double apex_curvature, bond;

  double turn(double r, double z, double phi) const {
    const double around = r > 1e-9 ? std::sin(phi) / r : apex_curvature;  // at the apex both curvatures are b
    return 2 * apex_curvature + bond * z - around;
  }
  void operator()(const State& y, State& dy, double) const {
    const double r = y[0], z = y[1], phi = y[2], slice = pi * r * r * std::sin(phi);
    dy = {std::cos(phi), std::sin(phi), turn(r, z, phi), slice, 2 * pi * r, slice * z};
  }
};

/// Integrates from the apex to the first place where the slope is `angle`; nothing if the profile turns back
/// before (a pendant drop beyond its widest slope).
std::optional<State> integrate(const YoungLaplace& equations, double angle, std::vector<State>* states = nullptr) {
  namespace odeint = boost::numeric::odeint;
  auto stepper = odeint::make_dense_output(1e-13, 1e-12, odeint::runge_kutta_dopri5<State>());
  State start{};
  if (states) states->push_back(start);
  stepper.initialize(start, 0.0, 1e-4 / equations.apex_curvature);
  const double longest = 1e4 * std::max(1.0, 1 / equations.apex_curvature);
  while (stepper.current_time() < longest) {
    const auto [from, to] = stepper.do_step(equations);
    const State& y = stepper.current_state();
    if (y[2] >= angle || !(y[0] > 0)) {
      const auto slope_beyond = [&](double s) {
        State at;
        stepper.calc_state(s, at);
        return at[2] - angle;
      };
      if (!(y[2] >= angle) || slope_beyond(from) >= 0) return std::nullopt;
      std::uintmax_t iterations = 100;
      const auto bracket = boost::math::tools::toms748_solve(slope_beyond, from, to,
                                                             boost::math::tools::eps_tolerance<double>(50), iterations);
      State end;
      stepper.calc_state(0.5 * (bracket.first + bracket.second), end);
      if (states) states->push_back(end);
      return end;
    }
    if (equations.turn(y[0], y[1], y[2]) <= 0) return std::nullopt;
    if (states) states->push_back(y);
  }
  return std::nullopt;
}

void check(double volume, double contact_angle) {
  if (!(volume > 0) || !std::isfinite(volume)) throw UsageError(fmt::format("a volume of {} cm^3; give > 0", volume));
  if (!(contact_angle > 0) || contact_angle > pi)
    throw UsageError(fmt::format("a contact angle of {} radians; give one in (0, pi]", contact_angle));
}

/// ln of the apex curvature that gives a drop of the ball's volume.
double find_apex(double bond, double angle, double cap_curvature) {
  const double ball = 4 * pi / 3;
  const auto excess = [&](double log_apex) {
    const auto end = integrate({std::exp(log_apex), bond}, angle);
    return end ? std::log((*end)[3] / ball) : std::numeric_limits<double>::quiet_NaN();
  };
  // Flatter at the apex means larger. From well above the cap's curvature downwards until it is large enough.
  double low = std::log(cap_curvature) + std::log(4.0), value_high = excess(low), high = low;
  double step = 0.1;
  for (;;) {
    const double next = low - step;
    const double value = excess(next);
    if (bond < 0 && !(value > value_high)) {  // past the largest pendant drop, or no such profile
      step /= 2;
      if (step < 1e-6)
        throw UsageError(
            "no pendant drop of that volume steepens all the way to the plane at that angle: it is too heavy");
      continue;
    }
    high = low;
    low = next;
    if (value >= 0) break;
    value_high = value;
    if (low < -600) throw UsageError("the drop is too wide a puddle for its profile to be computed");
    if (bond > 0) step *= 1.5;
  }
  std::uintmax_t iterations = 200;
  const auto bracket =
      boost::math::tools::toms748_solve(excess, low, high, boost::math::tools::eps_tolerance<double>(48), iterations);
  return 0.5 * (bracket.first + bracket.second);
}

}  // namespace

SphericalCap spherical_cap(double volume, double contact_angle) {
  check(volume, contact_angle);
  const double c = std::cos(contact_angle);
  const double radius = std::cbrt(3 * volume / (pi * (2 - 3 * c + c * c * c)));
  const double height = radius * (1 - c);
  return {radius, height, radius * std::sin(contact_angle), 2 * pi * radius * height};
}

DropAtRest drop_at_rest(double volume, double contact_angle, double gravity, const Liquid& liquid, Hold hold) {
  check(volume, contact_angle);
  if (!(gravity >= 0) || (gravity > 0 && !(liquid.surface_tension > 0)))
    throw UsageError("gravity must be >= 0, and surface tension > 0 where there is gravity");
  const double ball = std::cbrt(3 * volume / (4 * pi));
  const double weight = gravity > 0 ? liquid.density * gravity * ball * ball / liquid.surface_tension : 0;
  const double bond = hold == Hold::sessile ? weight : -weight;
  const double apex = std::exp(find_apex(bond, contact_angle, ball / spherical_cap(volume, contact_angle).radius));

  std::vector<State> states;
  const auto end = integrate({apex, bond}, contact_angle, &states);
  if (!end) throw UsageError("the drop's profile could not be integrated");
  const auto& [r, z, phi, v, a, moment] = *end;
  DropAtRest drop;
  drop.height = z * ball;
  drop.contact_radius = r * ball;
  drop.volume = v * std::pow(ball, 3);
  drop.air_area = a * ball * ball;
  drop.apex_curvature = apex / ball;
  drop.base_pressure = liquid.surface_tension * (2 * apex + bond * z) / ball;
  drop.centroid_height = (z - moment / v) * ball;
  for (const State& state : states) drop.profile.emplace_back(state[0] * ball, state[1] * ball);
  return drop;
}

double retention(RetentionForm form, double contact_radius, double advancing_angle, double receding_angle) {
  const double factor = form == RetentionForm::furmidge ? 1 : pi / 4;
  return factor * 2 * contact_radius * (std::cos(receding_angle) - std::cos(advancing_angle));
}

double critical_tilt(RetentionForm form, double volume, double deposited_angle, double advancing_angle,
                     double receding_angle, double gravity, const Liquid& liquid) {
  const DropAtRest drop = drop_at_rest(volume, deposited_angle, gravity, liquid, Hold::sessile);
  const double hold = liquid.surface_tension * retention(form, drop.contact_radius, advancing_angle, receding_angle);
  return std::asin(std::min(1.0, hold / (liquid.density * gravity * volume)));
}

}  // namespace meniscus::references
