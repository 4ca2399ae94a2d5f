#pragma once

/// Triangles in the order of a TIN: each from its smallest id on, sorted.
///
/// They are read from a source, which has
/// - size(): how many triangles there may be;
/// - exists(t): whether triangle t is one of them;
/// - corner(t, i): its corners, counter-clockwise from any one on;
/// - across(t, i): the side beyond that from corner i on; on the rim one of a triangle that is none of them;
/// - kind(t, i): the kind of that edge.

#include "base/parallel.hpp"
#include "base/prefetch.hpp"
#include "mesh/triangle_buckets.hpp"

#include <thalweg/base/progress.hpp>
#include <thalweg/mesh/tin.hpp>

#include <algorithm>
#include <atomic>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

namespace thalweg {

struct SortedCorners {
  RawVector<Triangle> triangles;
  RawVector<TurnedTriangle> moved;  ///< for each triangle of the source what it is now
};

/// Sorts triangles of which vertex v is to be called number[v] (empty: v). Pre: corners are vertices, and
/// the numbers a permutation of their ids. Throws: Error{Cancelled}, {SizeLimit}. Complexity: linear for
/// bounded degrees; runs on all threads.
template <class Source>
SortedCorners sort_triangles(const Source& source, std::span<const VertexId> number, std::size_t vertex_count,
                             const Progress& progress) {
  check_triangle_count(source.size());
  const auto renamed = [&](std::size_t t, std::size_t i) {
    const VertexId v = source.corner(t, i);
    return number.empty() ? v : number[v.index()];
  };
  std::vector<VertexId> sample;
  for (std::size_t t = 0; t < source.size(); t += source.size() / kTrianglesSampled + 1) {
    if (source.exists(t)) sample.push_back(std::min({renamed(t, 0), renamed(t, 1), renamed(t, 2)}));
  }
  // Each thread fills the buckets of a range of ids, so no two write to the same place.
  const std::vector<std::size_t> limits = even_limits(std::move(sample), vertex_count);
  const auto in_ranges = [&](const auto& body) {
    for_each_block(limits.size() - 1, 1, progress, [&](std::size_t range, std::size_t) {
      const VertexId low{limits[range]}, high{limits[range + 1]};
      body([&](const auto& visit) {
        for (std::size_t t = 0; t < source.size(); ++t) {
          if (!source.exists(t)) continue;
          const VertexId a = renamed(t, 0), b = renamed(t, 1), c = renamed(t, 2);
          const VertexId first = std::min({a, b, c});
          if (first >= low && first < high) visit(t, a, b, c);
        }
      });
    });
  };
  std::vector<std::uint32_t> end(vertex_count + 1, 0);
  in_ranges([&](const auto& for_each_triangle) {
    for_each_triangle([&](std::size_t, VertexId a, VertexId b, VertexId c) {
      ++end[std::min({a, b, c}).index() + 1];
    });
  });
  std::partial_sum(end.begin(), end.end(), end.begin());
  SortedCorners sorted{.triangles = RawVector<Triangle>(end.back()),
                       .moved = RawVector<TurnedTriangle>(source.size())};
  const TriangleBuckets buckets{sorted.triangles, end};
  in_ranges([&](const auto& for_each_triangle) {
    BucketFiller filler(buckets);
    for_each_triangle([&](std::size_t t, VertexId a, VertexId b, VertexId c) { filler.add(t, a, b, c); });
    filler.flush();
  });
  if (end.back() < source.size()) std::ranges::fill(sorted.moved, TurnedTriangle{});
  for_each_block(vertex_count, kVerticesAtOnce, progress, [&](std::size_t first, std::size_t limit) {
    settle_buckets(buckets, first, limit, sorted.moved);
  });
  return sorted;
}

/// The neighbours and kinds of sorted triangles: for a TIN that has them already. Throws: Error{Cancelled}.
/// Complexity: linear; runs on all threads.
template <class Source>
LinkedTriangles link_triangles(const Source& source, SortedCorners& sorted, const Progress& progress) {
  LinkedTriangles linked{.corners = std::move(sorted.triangles), .twins = {}, .kinds = {}, .edge_count = 0};
  const std::size_t halfedges = 3 * linked.corners.size();
  linked.twins.resize(halfedges);
  linked.kinds.assign(halfedges, EdgeKind::None);
  constexpr std::size_t kAhead = 8;
  std::atomic<std::size_t> rim = 0;
  for_each_block(source.size(), kVerticesAtOnce, progress, [&](std::size_t begin, std::size_t end) {
    std::size_t on_rim = 0;
    for (std::size_t t = begin; t < end; ++t) {
      if (t + kAhead < end && sorted.moved[t + kAhead].exists()) {
        prefetch_to_write(&linked.twins[sorted.moved[t + kAhead].halfedge(0).index()]);
      }
      const TurnedTriangle now = sorted.moved[t];
      if (!now.exists()) continue;
      for (std::uint32_t side = 0; side < 3; ++side) {
        const auto [other, other_side] = source.across(t, side);
        const bool inner = other < source.size() && sorted.moved[other].exists();
        const std::size_t h = now.halfedge(side).index();
        linked.twins[h] = inner ? sorted.moved[other].halfedge(other_side) : HalfedgeId{};
        if (const EdgeKind kind = source.kind(t, side); kind != EdgeKind::None) linked.kinds[h] = kind;
        on_rim += inner ? 0 : 1;
      }
    }
    rim += on_rim;
  });
  linked.edge_count = (halfedges + rim) / 2;
  return linked;
}

}  // namespace thalweg
