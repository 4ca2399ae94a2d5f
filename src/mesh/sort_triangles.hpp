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
  check_counts(source.size(), vertex_count);
  const auto renamed = [&](std::size_t t, std::size_t i) {
    const VertexId v = source.corner(t, i);
    return number.empty() ? v : number[v.index()];
  };
  SortedCorners sorted{.triangles = {}, .moved = RawVector<TurnedTriangle>(source.size())};
  // Until triangles have their places, `moved` says of each its smallest id and the corner that has it.
  for_each_block(source.size(), kVerticesAtOnce, progress, [&](std::size_t begin, std::size_t limit) {
    for (std::size_t t = begin; t < limit; ++t) {
      if (!source.exists(t)) {
        sorted.moved[t] = {};
        continue;
      }
      const VertexId a = renamed(t, 0), b = renamed(t, 1), c = renamed(t, 2);
      const VertexId smaller = std::min(a, b);
      sorted.moved[t] = {std::min(smaller, c).index(), c < smaller ? 2U : b < a ? 1U : 0U};
    }
  });
  // Each thread fills the buckets of a range of ids, so no two write to the same place.
  const std::vector<std::size_t> limits = even_limits(sorted.moved, vertex_count);
  const auto in_ranges = [&](const auto& body) {
    for_each_block(limits.size() - 1, 1, progress, [&](std::size_t range, std::size_t) {
      body([&, low = limits[range], high = limits[range + 1]](const auto& visit) {
        for (std::size_t t = 0; t < source.size(); ++t) {
          const std::size_t smallest = sorted.moved[t].index();
          if (smallest >= low && smallest < high) visit(t, VertexId{smallest}, sorted.moved[t].corner());
        }
      });
    });
  };
  std::vector<std::uint32_t> end(vertex_count + 1, 0);
  in_ranges([&](const auto& for_each_triangle) {
    for_each_triangle([&](std::size_t, VertexId smallest, std::uint32_t) { ++end[smallest.index() + 1]; });
  });
  std::partial_sum(end.begin(), end.end(), end.begin());
  sorted.triangles.resize(end.back());
  const TriangleBuckets buckets{sorted.triangles, end};
  in_ranges([&](const auto& for_each_triangle) {
    BucketFiller filler(buckets);
    for_each_triangle([&](std::size_t t, VertexId smallest, std::uint32_t corner) {
      const std::uint32_t next = corner == 2 ? 0 : corner + 1, last = corner == 0 ? 2 : corner - 1;
      filler.add({t, corner}, {smallest, renamed(t, next), renamed(t, last)});
    });
    filler.flush();
  });
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
