// SPDX-License-Identifier: GPL-3.0-or-later
#include "page.h"

#include "meniscus/core/error.h"
#include "meniscus/frames/frame_time.h"
#include "meniscus/frames/packed_surface.h"
#include "meniscus/io/base64.h"
#include "meniscus/io/read_mesh.h"
#include "mesh_files.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace meniscus::tools {
namespace {

constexpr std::size_t batch = 16;  // frames that are read and packed at once

/// A frame as it was read.
struct Frame {
  PackedSurface surface;
  double time = 0, volume = 0;
  std::size_t drops = 1;
};

/// Six times the volume by the divergence theorem, and how many drops there are.
void measure(const MeshData& data, Frame& frame) {
  using Eigen::Vector3d;
  for (const auto& [a, b, c] : data.triangles)
    frame.volume += Eigen::Map<const Vector3d>(data.points[a].data())
                        .dot(Eigen::Map<const Vector3d>(data.points[b].data())
                                 .cross(Eigen::Map<const Vector3d>(data.points[c].data()))) /
                    6;
  if (const VertexAttribute* drop = data.attribute("drop")) {
    std::vector<double> ids = drop->values;
    std::sort(ids.begin(), ids.end());
    frame.drops = static_cast<std::size_t>(std::unique(ids.begin(), ids.end()) - ids.begin());
  }
}

/// Writes the page's data: first the blocks, as lines, then what tells where they are.
class PageData {
 public:
  explicit PageData(const PageInput& input) : input_(input) {}

  void add_frames() {
    const std::size_t n = input_.frames.size();
    for (std::size_t first = 0; first < n; first += batch) {
      std::vector<Frame> frames(std::min(batch, n - first));
      tbb::parallel_for(std::size_t{0}, frames.size(), [&](std::size_t k) { frames[k] = read(first + k); });
      for (std::size_t k = 0; k < frames.size(); ++k) add(frames[k], first + k);
    }
  }

  void add_solids() {
    for (const PageSolid& solid : input_.scene.solids) {
      Json keys = solid.keys;
      if (solid.mesh) keys["surface"] = describe(pack_surface(*solid.mesh));
      solids_.push_back(std::move(keys));
    }
  }

  /// As JSON that may stand in HTML.
  std::string scene() const {
    const double radius = std::cbrt(3 * drop_volume_ / (4 * 3.14159265358979323846));
    const Json scene{{"format", 1},
                     {"title", input_.title},
                     {"timed", input_.timed},
                     {"frames", frames_},
                     {"solids", solids_},
                     {"sources", input_.scene.sources},
                     {"blocks", num_blocks_},
                     {"speed_max", speed_},
                     {"drop_radius", radius > 0 ? radius : 1},
                     {"bounds", {{"min", Json(min_)}, {"max", Json(max_)}}}};
    std::string text = scene.dump(-1, ' ', true, Json::error_handler_t::replace);
    for (std::size_t at = 0; (at = text.find('<', at)) != std::string::npos;) text.replace(at, 1, "\\u003c");
    return text;
  }
  const std::string& blocks() const { return blocks_; }
  PageReport report() const { return {frames_.size(), max_triangles_, num_topologies_}; }

 private:
  Frame read(std::size_t k) const {
    const std::string file = input_.frames[k].string();
    const MeshData data = read_mesh(input_.frames[k]);
    Frame frame;
    frame.surface = naming(file, [&] { return pack_surface(data); });
    measure(data, frame);
    frame.time = static_cast<double>(k);
    if (!input_.timed) return frame;
    const std::optional<double> time = frame_time(data);
    if (!time) throw FileError(fmt::format("{}: tells no time, while others do; write the frames again", file));
    frame.time = *time;
    return frame;
  }

  std::size_t add_block(const std::string& bytes) {
    blocks_ += base64(bytes) + '\n';
    return num_blocks_++;
  }

  /// Adds the blocks of a surface; one whose triangles are the last one's shares them.
  Json describe(const PackedSurface& surface) {
    Json json{{"vertices", surface.num_vertices},
              {"triangles", surface.num_triangles},
              {"min", Json(surface.min)},
              {"step", Json(surface.step)},
              {"speed", surface.speed}};
    json["block"] = add_block(surface.vertices);
    if (last_topology_ != surface.triangles) {
      last_topology_ = surface.triangles;
      topology_block_ = add_block(surface.triangles);
      ++num_topologies_;
    }
    json["topology"] = topology_block_;
    return json;
  }

  void add(const Frame& frame, std::size_t k) {
    const PackedSurface& surface = frame.surface;
    Json json = describe(surface);
    json["time"] = frame.time;
    if (!input_.timed) json["name"] = input_.frames[k].filename().string();
    frames_.push_back(std::move(json));
    for (std::size_t axis = 0; axis < 3 && surface.num_vertices > 0; ++axis) {
      const double low = surface.min[axis], high = low + 65535 * surface.step[axis];
      min_[axis] = is_bounded_ ? std::min(min_[axis], low) : low;
      max_[axis] = is_bounded_ ? std::max(max_[axis], high) : high;
    }
    is_bounded_ = is_bounded_ || surface.num_vertices > 0;
    speed_ = std::max(speed_, surface.speed);
    drop_volume_ = std::max(drop_volume_, frame.volume / static_cast<double>(std::max<std::size_t>(frame.drops, 1)));
    max_triangles_ = std::max<std::size_t>(max_triangles_, surface.num_triangles);
  }

  const PageInput& input_;
  Json frames_ = Json::array(), solids_ = Json::array();
  std::string blocks_ = "\n", last_topology_;
  std::size_t num_blocks_ = 0, num_topologies_ = 0, topology_block_ = 0, max_triangles_ = 0;
  std::array<double, 3> min_{}, max_{};
  bool is_bounded_ = false;
  double speed_ = 0, drop_volume_ = 0;
};

}  // namespace

std::string make_page(const PageInput& input, const std::vector<std::string>& pieces, PageReport& report) {
  PageData data(input);
  data.add_frames();
  data.add_solids();
  report = data.report();
  return pieces.at(0) + data.scene() + pieces.at(1) + data.blocks() + pieces.at(2);
}

}  // namespace meniscus::tools
