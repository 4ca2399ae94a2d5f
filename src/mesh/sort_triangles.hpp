#pragma once

/// Triangles in the order of a TIN: each from its smallest id on, sorted.
///
/// They are read from a source, which has
/// - size(): how many triangles there may be;
/// - exists(t): whether triangle t is one of them;
/// - corner(t, i): its corners, counter-clockwise from any one on;
/// - across(t, i): the side beyond that from corner i on; on the rim one of a triangle that is none of them;
/// - kind(t, i): the kind of that edge;
/// - forget(begin), if it can: triangles from that on are not needed any more.
/// Vertex v is to be called number[v] (empty: v), a permutation of the ids.

#include "base/parallel.hpp"
#include "base/prefetch.hpp"
#include "mesh/triangle_buckets.hpp"

#include <thalweg/base/progress.hpp>
#include <thalweg/mesh/tin.hpp>

#include <algorithm>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

namespace thalweg {

/// What the triangles of a source become.
struct TriangleOrder {
  RawVector<TurnedTriangle> moved;  ///< each of the source
  std::size_t count = 0;            ///< how many exist
};

/// What a source's vertex is to be called.
struct Renaming {
  std::span<const VertexId> number;
  [[nodiscard]] VertexId operator()(VertexId v) const { return number.empty() ? v : number[v.index()]; }
};

/// Sorts the buckets, and says in `moved` what their triangles become.
template <class Source>
void settle_buckets(const Source& source, std::span<const VertexId> number, const TriangleBuckets& buckets,
                    std::span<TurnedTriangle> moved, const Progress& progress) {
  // Two on the same side of an edge are no triangulation's; they have an order all the same.
  const auto third = [&](const TurnedSide& side) {
    const std::uint32_t corner = side.corner();
    return Renaming{number}(source.corner(side.triangle(), corner == 0 ? 2 : corner - 1));
  };
  constexpr std::size_t kAhead = 16;
  const RawVector<std::uint32_t> first = first_places(buckets, number);
  for_each_block(buckets.count(), kVerticesAtOnce, progress, [&](std::size_t begin, std::size_t limit) {
    const std::size_t last = buckets.begin_of(limit);
    for (std::size_t v = begin; v < limit; ++v) {
      sort_bucket(buckets.of(v), third);
      if (!number.empty() && v + kAhead < limit) prefetch(&first[number[v + kAhead].index()]);
      std::size_t place = number.empty() ? buckets.begin_of(v) : first[number[v].index()];
      for (std::size_t i = buckets.begin_of(v); i < buckets.end[v]; ++i) {
        if (i + kAhead < last) prefetch_to_write(&moved[buckets.sides[i + kAhead].triangle()]);
        const TurnedSide& side = buckets.sides[i];
        moved[side.triangle()] = {place++, side.corner() == 0 ? 0 : 3 - side.corner()};
      }
    }
  });
}

/// Sorts the triangles. Pre: corners are below vertex_count. Throws: Error{Cancelled}, {SizeLimit}.
/// Complexity: linear for bounded degrees; runs on all threads.
template <class Source>
TriangleOrder sort_triangles(const Source& source, std::span<const VertexId> number, std::size_t vertex_count,
                             const Progress& progress) {
  check_counts(source.size(), vertex_count);
  const Renaming renamed{number};
  RawVector<TurnedTriangle> moved(source.size());
  // Until triangles have their places, `moved` says of each which vertex has its smallest id, and at which
  // corner.
  for_each_block(source.size(), kTrianglesAtOnce, progress, [&](std::size_t begin, std::size_t limit) {
    for (std::size_t t = begin; t < limit; ++t) {
      if (!source.exists(t)) {
        moved[t] = {};
        continue;
      }
      const VertexId a = renamed(source.corner(t, 0)), b = renamed(source.corner(t, 1)),
                     c = renamed(source.corner(t, 2));
      const std::uint32_t first = c < std::min(a, b) ? 2U : b < a ? 1U : 0U;
      moved[t] = {source.corner(t, first).index(), first};
    }
  });
  // Each thread fills the buckets of a range of vertices, so no two write to the same place.
  const std::vector<std::size_t> limits = even_limits(moved, vertex_count);
  const auto for_each_triangle = [&](const auto& body) {
    for_each_block(limits.size() - 1, 1, progress, [&](std::size_t range, std::size_t) {
      for (std::size_t t = 0; t < moved.size(); ++t) {
        const std::size_t v = moved[t].index();
        if (v >= limits[range] && v < limits[range + 1]) body(t, v);
      }
    });
  };
  std::vector<std::uint32_t> end(vertex_count + 1, 0);
  for_each_triangle([&](std::size_t, std::size_t v) { ++end[v + 1]; });
  std::partial_sum(end.begin(), end.end(), end.begin());
  RawVector<TurnedSide> sides(end.back());
  for_each_triangle([&](std::size_t t, std::size_t v) {
    const std::uint32_t corner = moved[t].corner();
    sides[end[v]++] = {renamed(source.corner(t, corner == 2 ? 0 : corner + 1)), t, corner};
  });
  settle_buckets(source, number, {sides, std::span(end).first(vertex_count)}, moved, progress);
  return {std::move(moved), sides.size()};
}

}  // namespace thalweg
