#pragma once

/// The arrays of a TIN from triangles that have been sorted (sort_triangles.hpp).

#include "base/parallel.hpp"
#include "base/prefetch.hpp"
#include "mesh/sort_triangles.hpp"

#include <thalweg/base/progress.hpp>
#include <thalweg/mesh/tin.hpp>

#include <algorithm>
#include <atomic>
#include <span>

namespace thalweg {

/// The corners of one triangle, as it is now.
template <class Source>
Triangle turned_corners(const Source& source, std::size_t t, TurnedTriangle now, Renaming renamed) {
  const auto corner = [&](std::uint32_t i) { return renamed(source.corner(t, now.corner_before(i))); };
  return {corner(0), corner(1), corner(2)};
}

/// The sorted triangles, without their neighbours. Throws: Error{Cancelled}. Complexity: linear; runs on all
/// threads.
template <class Source>
RawVector<Triangle> place_triangles(const Source& source, const TriangleOrder& order,
                                    std::span<const VertexId> number, const Progress& progress) {
  RawVector<Triangle> corners(order.count);
  for_each_block(source.size(), kTrianglesAtOnce, progress, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      const TurnedTriangle now = order.moved[t];
      if (now.exists()) corners[now.index()] = turned_corners(source, t, now, Renaming{number});
    }
  });
  return corners;
}

/// The sorted triangles with neighbours and kinds, for a source that knows them. Throws: Error{Cancelled}.
/// Complexity: linear; runs on all threads.
template <class Source>
LinkedTriangles link_triangles(Source& source, const TriangleOrder& order, std::span<const VertexId> number,
                               const Progress& progress) {
  const std::span<const TurnedTriangle> moved = order.moved;
  LinkedTriangles linked{.corners = RawVector<Triangle>(order.count),
                         .twins = RawVector<HalfedgeId>(3 * order.count),
                         .kinds = RawVector<EdgeKind>(3 * order.count, EdgeKind::None),
                         .edge_count = 0};
  constexpr std::size_t kAhead = 32;
  std::atomic<std::size_t> rim = 0;
  const auto link_some = [&](std::size_t begin, std::size_t end) {
    std::size_t on_rim = 0;
    for (std::size_t t = begin; t < end; ++t) {
      if (t + kAhead < end && moved[t + kAhead].exists()) {
        prefetch_to_write(&linked.corners[moved[t + kAhead].index()]);
        prefetch_to_write(&linked.twins[moved[t + kAhead].halfedge(0).index()]);
      }
      const TurnedTriangle now = moved[t];
      if (!now.exists()) continue;
      linked.corners[now.index()] = turned_corners(source, t, now, Renaming{number});
      for (std::uint32_t side = 0; side < 3; ++side) {
        const auto [other, other_side] = source.across(t, side);
        const bool inner = other < source.size() && moved[other].exists();
        const std::size_t h = now.halfedge(side).index();
        linked.twins[h] = inner ? moved[other].halfedge(other_side) : HalfedgeId{};
        if (const EdgeKind kind = source.kind(t, side); is_constraint(kind)) linked.kinds[h] = kind;
        on_rim += inner ? 0 : 1;
      }
    }
    rim += on_rim;
  };
  // As results grow, the source may shrink: both need not be in memory whole. Backwards: where triangles are
  // made along a curve, it is the first ones that are strewn.
  constexpr std::size_t kStretch = 16 * kTrianglesAtOnce;
  for (std::size_t to = source.size(); to > 0;) {
    const std::size_t from = to > kStretch ? to - kStretch : 0;
    for_each_block(to - from, kTrianglesAtOnce, progress,
                   [&](std::size_t begin, std::size_t end) { link_some(from + begin, from + end); });
    if constexpr (requires { source.forget(from); }) source.forget(from);
    to = from;
  }
  linked.edge_count = (3 * order.count + rim) / 2;
  return linked;
}

}  // namespace thalweg
