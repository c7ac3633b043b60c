// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/core/mesh_data.h"
#include "meniscus/core/types.h"
#include "meniscus/geometry/connectivity.h"
#include "meniscus/state/contact.h"
#include "meniscus/state/workspace.h"

#include <Eigen/Geometry>

#include <cstdint>
#include <memory>
#include <vector>

namespace meniscus {

/// A drop of liquid: a closed, outward-oriented triangle mesh with velocities, contact state and
/// the volume that it ought to have.
///
/// Row i of every array is vertex i of the mesh, removed vertices included (their connectivity
/// degree is 0). Views are void once the mesh gains elements. Operators change positions,
/// velocities and contact state; only topology/ changes the mesh's elements, and leaves
/// connectivity() up to date.
class Drop {
 public:
  /// Takes over a closed, outward-oriented mesh at rest; its volume becomes the target volume.
  /// A property map "v:<name>" of doubles that the mesh brings along is carried through remeshing.
  /// Throws GeometryError if the mesh is empty, open, not triangular, not finite or bounds no
  /// positive volume.
  explicit Drop(Mesh mesh);
  /// The drop that a checkpoint holds: the mesh as it is, removed elements included, with the maps that it
  /// brings; rings start at `ring_starts` (one a vertex; removed ones do not count). Its volume may be anything.
  /// Throws GeometryError if the mesh is empty, open, not triangular or not finite.
  static Drop restored(Mesh mesh, const std::vector<std::uint32_t>& ring_starts);
  Drop(const Drop& other);
  Drop& operator=(const Drop& other);
  Drop(Drop&&) noexcept = default;  // so that a growing std::vector moves drops, workspaces and all
  Drop& operator=(Drop&&) noexcept = default;

  Mesh& mesh() { return mesh_; }
  const Mesh& mesh() const { return mesh_; }
  /// Rows of the arrays: vertices of the mesh, removed ones included.
  std::size_t num_rows() const { return mesh_.num_vertices(); }

  Columns positions() { return meniscus::positions(mesh_); }
  ConstColumns positions() const { return meniscus::positions(mesh_); }
  Columns velocities() { return columns(mesh_, velocity_); }  ///< cm/s
  ConstColumns velocities() const { return columns(std::as_const(mesh_), velocity_); }
  /// The last step's displacement by curvature flow (cm): where the next solve starts.
  Columns displacements() { return columns(mesh_, displacement_); }
  /// The solid's outward unit normal at colliding vertices; anything elsewhere.
  Columns contact_normals() { return columns(mesh_, contact_normal_); }
  ConstColumns contact_normals() const { return columns(std::as_const(mesh_), contact_normal_); }
  Contact* contact() { return num_rows() == 0 ? nullptr : &contact_[VertexIndex(0)]; }
  const Contact* contact() const { return num_rows() == 0 ? nullptr : &contact_[VertexIndex(0)]; }
  /// The index of the solid that a colliding vertex touches; -1 elsewhere.
  std::int32_t* contact_solid() { return num_rows() == 0 ? nullptr : &contact_solid_[VertexIndex(0)]; }
  const std::int32_t* contact_solid() const { return num_rows() == 0 ? nullptr : &contact_solid_[VertexIndex(0)]; }
  /// 1 at vertices whose faces are still bad after remeshing: damping smooths their velocity more.
  std::uint8_t* poor_quality() { return num_rows() == 0 ? nullptr : &poor_quality_[VertexIndex(0)]; }
  /// Steps for which the surface near this vertex is watched for folds: merging sets it at a seam, where two
  /// sheets move towards each other; see mend_folds.
  std::uint8_t* seam_watch() { return num_rows() == 0 ? nullptr : &seam_watch_[VertexIndex(0)]; }
  const std::uint8_t* seam_watch() const { return num_rows() == 0 ? nullptr : &seam_watch_[VertexIndex(0)]; }

  /// The state of the contact line that hysteresis needs, kept through remeshing: LineStatus as a number,
  /// in the map "v:line_status".
  std::uint8_t* line_statuses() { return num_rows() == 0 ? nullptr : &line_status_[VertexIndex(0)]; }
  LineStatus line_status(std::uint32_t v) const { return static_cast<LineStatus>(line_status_[VertexIndex(v)]); }
  void set_line_status(std::uint32_t v, LineStatus status) {
    line_status_[VertexIndex(v)] = static_cast<std::uint8_t>(status);
  }

  Connectivity& connectivity() { return connectivity_; }
  const Connectivity& connectivity() const { return connectivity_; }
  /// The arrays that were lent to it, else its own, made at first use.
  Workspace& workspace() { return find_workspace(); }
  const Workspace& workspace() const { return find_workspace(); }
  /// Lends arrays that many drops use in turn, so that they stay in the processor's cache; nullptr ends that. Whoever
  /// lends them keeps them alive and to one drop at a time, and lets their solver forget the drop before.
  void lend_workspace(Workspace* shared) { lent_workspace_ = shared; }

  /// Counts up whenever elements of the mesh changed, so that kept factors know that they are void.
  std::uint64_t topology_version() const { return topology_version_; }
  /// Says that elements changed. topology/ calls it; whoever else edits mesh() must call
  /// topology_changed() after connectivity().rebuild(mesh()).
  void topology_changed() {
    ++topology_version_;
    slack_ = 0;
  }

  /// Whether elements changed since the last call: kept factors of the flow's matrix are void.
  bool flow_pattern_changed() {
    const bool changed = flow_version_ != topology_version_;
    flow_version_ = topology_version_;
    return changed;
  }

  /// Moves the elements together if more than `share` of the vertex rows are removed ones, and
  /// rebuilds the connectivity. Returns whether it did.
  bool collect_garbage(double share = 0.25);

  double volume() const { return enclosed_volume(positions(), connectivity_); }  ///< cm^3
  double target_volume() const { return target_volume_; }                        ///< cm^3
  void set_target_volume(double volume) { target_volume_ = volume; }
  /// What sources give it in this step, cm^3/s.
  double inflow() const { return inflow_; }
  void set_inflow(double rate) { inflow_ = rate; }
  int id() const { return id_; }
  void set_id(int id) { id_ = id; }
  /// For how long it has been at rest (s); counted by whoever lets drops sleep.
  double rest_time() const { return rest_time_; }
  void set_rest_time(double seconds) { rest_time_ = seconds; }

  /// How far (cm) its vertices may still move before its faces are looked at again for what to mend or remesh: above 0
  /// only after a look that found nothing, and for as long as no element changes.
  double slack() const { return slack_; }
  void set_slack(double length) { slack_ = length; }

  /// For how many substeps in a row most of its vertices had to be taken back, for they would have met others.
  int stuck_substeps() const { return stuck_substeps_; }
  void set_stuck_substeps(int count) { stuck_substeps_ = count; }

  /// Shows a checkpoint every number that is not in the mesh; what is added to the class is added here.
  /// What lies in vertex maps goes along by itself; workspace() is empty after a resume.
  template <class Self, class Archive>
  static void visit(Self& self, Archive& archive) {
    archive("id", self.id_);
    archive("target_volume", self.target_volume_);
    archive("topology_version", self.topology_version_);
    archive("flow_version", self.flow_version_);
    archive("rest_time", self.rest_time_);
    archive("inflow", self.inflow_);
    archive("slack", self.slack_);
    archive("stuck_substeps", self.stuck_substeps_);
  }

 private:
  Drop() = default;
  void bind();
  Workspace& find_workspace() const {
    if (lent_workspace_) return *lent_workspace_;
    if (!own_workspace_) own_workspace_ = std::make_unique<Workspace>();
    return *own_workspace_;
  }

  Mesh mesh_;
  Mesh::Property_map<VertexIndex, Vector> velocity_, displacement_, contact_normal_;
  Mesh::Property_map<VertexIndex, Contact> contact_;
  Mesh::Property_map<VertexIndex, std::int32_t> contact_solid_;
  Mesh::Property_map<VertexIndex, std::uint8_t> poor_quality_, seam_watch_, line_status_;
  Connectivity connectivity_;
  mutable std::unique_ptr<Workspace> own_workspace_;
  Workspace* lent_workspace_ = nullptr;
  double target_volume_ = 0;
  std::uint64_t topology_version_ = 1, flow_version_ = 0;
  double rest_time_ = 0, inflow_ = 0, slack_ = 0;
  int id_ = 0, stuck_substeps_ = 0;
};

/// The box of a drop's vertices (cm); empty if it has none.
Eigen::AlignedBox3d bounding_box(const Drop& drop);

/// Whether some vertex touches a solid.
bool touches_solid(const Drop& drop);

/// The mean of the columns (3 x rows) of the vertices that are there, each counted once; zero if there are none.
Eigen::Vector3d mean_over_vertices(const Drop& drop, const ConstColumns& columns);

/// The speed of the fastest vertex, seen from a frame that moves with `frame` (cm/s); 0 without vertices.
double top_speed(const Drop& drop, const Eigen::Vector3d& frame = Eigen::Vector3d::Zero());

/// Whether some vertex touches solid s.
bool hangs_from(const Drop& drop, std::int32_t solid);

/// The drops of a mesh file: one for each value of the attribute "drop" (else one for each
/// connected component), with velocities from "vx", "vy", "vz", contact state from "contact" and
/// target volumes from comments "drop <id> target_volume <cm^3>" where the file has them.
/// Throws GeometryError as to_mesh and Drop do.
std::vector<Drop> to_drops(const MeshData& data);

/// All drops as one soup, with the attributes vx, vy, vz (float64), drop (int32) and contact
/// (uint8) and the comments that to_drops reads back.
MeshData to_mesh_data(const std::vector<Drop>& drops);

}  // namespace meniscus
