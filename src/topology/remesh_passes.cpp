// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/core/error.h"
#include "remesh_state.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace meniscus {
namespace {

void refuse(RemeshState& state, EdgeIndex e, Refusal why) {
  if (why != Refusal::none && why != Refusal::not_wanted) state.scratch.refused.emplace_back(e, why);
}

/// Faces that cutting all long edges to size would make, at the least.
double faces_to_be(const RemeshState& state) {
  double faces = static_cast<double>(state.mesh.number_of_faces());
  const double high2 = state.options.band.edge_max * state.options.band.edge_max;
  for (const auto& queued : state.scratch.splits) faces += queued.squared_length / high2;
  return faces;
}

void check_face_budget(const RemeshState& state) {
  const double faces = faces_to_be(state);
  if (faces > state.options.max_faces)
    throw GeometryError(
        fmt::format("the drop's edges are so long for edge_max = {} cm that it would need {:.3g} faces "
                    "(at most {:.3g}); take a wider band, or a smaller time step if it blew up",
                    state.options.band.edge_max, faces, state.options.max_faces));
}

template <class Later, class Try>
void empty_heap(RemeshState& state, std::vector<QueuedEdge>& heap, Later later, Try try_one) {
  while (!heap.empty()) {
    std::pop_heap(heap.begin(), heap.end(), later);
    const QueuedEdge queued = heap.back();
    heap.pop_back();
    if (state.mesh.is_removed(queued.edge)) continue;
    const auto h = state.mesh.halfedge(queued.edge);
    if (state.squared_length(h) != queued.squared_length)
      state.queue(queued.edge);  // out of date: by its present length, if that is still out of the band
    else
      refuse(state, queued.edge, try_one(h));
  }
}

void flip_edges(RemeshState& state) {
  auto& scratch = state.scratch;
  std::size_t budget = 4 * std::size_t{state.mesh.number_of_edges()};  // on curved surfaces flips need not end
  while (!scratch.flips.empty() && budget > 0) {
    std::swap(scratch.flips, scratch.flips_now);
    scratch.flips.clear();
    std::sort(scratch.flips_now.begin(), scratch.flips_now.end());
    for (const auto e : scratch.flips_now) {
      scratch.in_flips[e] = 0;
      if (budget == 0 || state.mesh.is_removed(e)) continue;
      --budget;
      try_flip(state, state.mesh.halfedge(e));
    }
  }
}

/// In rounds: the halves and medians that are still long wait for the next, with flips in between,
/// so that medians turn into sides where they can.
void split_long_edges(RemeshState& state) {
  const auto later = [](const QueuedEdge& a, const QueuedEdge& b) {
    return a.squared_length != b.squared_length ? a.squared_length < b.squared_length : a.edge > b.edge;
  };
  auto& now = state.scratch.splits_now;
  int rounds = 60;  // each halves edges, so that no sound mesh needs as many; folded ones might never end
  while (!state.scratch.splits.empty() && rounds-- > 0) {
    now.clear();
    std::swap(now, state.scratch.splits);
    empty_heap(state, now, later, [&](HalfedgeIndex h) { return try_split(state, h); });
    if (!state.scratch.splits.empty()) flip_edges(state);
  }
}

void collapse_short_edges(RemeshState& state) {
  const auto later = [](const QueuedEdge& a, const QueuedEdge& b) {
    return a.squared_length != b.squared_length ? a.squared_length > b.squared_length : a.edge > b.edge;
  };
  empty_heap(state, state.scratch.collapses, later, [&](HalfedgeIndex h) {
    const Refusal refusal = try_collapse(state, h);
    return refusal == Refusal::link_condition ? try_cut(state, h) : refusal;
  });
}

/// Near a seam: takes out a vertex of each edge that is far too short and that could not collapse.
void remove_bad_vertices(RemeshState& state) {
  if (!state.scratch.guard) return;
  const double short2 = 0.25 * state.options.band.edge_min * state.options.band.edge_min;
  const auto refused = state.scratch.refused;
  for (const auto& [edge, why] : refused) {
    if (state.mesh.is_removed(edge)) continue;
    const auto h = state.mesh.halfedge(edge);
    if (state.squared_length(h) < short2 && !try_remove_vertex(state, state.mesh.source(h)))
      try_remove_vertex(state, state.mesh.target(h));
  }
}

/// Puts what was refused, and is still there and out of the band, into the queues again.
void queue_refused(RemeshState& state) {
  auto& refused = state.scratch.refused;
  for (const auto& entry : refused)
    if (!state.mesh.is_removed(entry.first)) state.queue(entry.first);
  refused.clear();
}

void queue_all(RemeshState& state) {
  for (const auto e : state.mesh.edges()) {
    state.queue(e);
    state.queue_flip(e);
  }
}

}  // namespace

void run_passes(RemeshState& state) {
  const RemeshOptions& options = state.options;
  check_face_budget(state);
  for (int pass = 0; pass < options.max_passes; ++pass) {
    const RemeshReport before = state.report;
    ++state.report.passes;
    state.scratch.max_valence = 12;  // a fold is worse than a long ring
    if (state.has_films && pass == 0) dewet(state);
    if (state.has_slits && pass == 0) close_slits(state);
    if (state.has_turned_faces) mend_contact(state);
    state.scratch.max_valence = pass == 0 ? 8 : 10;
    split_long_edges(state);
    collapse_short_edges(state);
    remove_bad_vertices(state);
    flip_edges(state);
    const bool is_last = pass + 1 == options.max_passes;
    const bool did_something = state.report.splits + state.report.collapses + state.report.flips + state.report.cuts >
                               before.splits + before.collapses + before.flips + before.cuts;
    if (is_last || (!did_something && pass > 0)) break;
    if (options.smoothing > 0) {
      smooth_tangentially(state, options.smoothing);
      state.scratch.refused.clear();
      queue_all(state);
    } else {
      if (!did_something) break;
      queue_refused(state);
    }
  }
  // A collapse in the last pass may have lengthened nothing, but a cut may have left work: count it.
  for (const auto* heap : {&state.scratch.splits, &state.scratch.collapses})
    for (const auto& queued : *heap) refuse(state, queued.edge, Refusal::would_invert);
}

}  // namespace meniscus
