#pragma once

/// Triangles in the order of a TIN: each from its smallest id on, sorted.

#include <thalweg/base/progress.hpp>
#include <thalweg/mesh/tin.hpp>

#include <span>

namespace thalweg {

struct SortedTriangles {
  RawVector<Triangle> triangles;
  RawVector<HalfedgeId> moved;  ///< for each old triangle: what its first halfedge is now

  /// What an old halfedge is now.
  [[nodiscard]] HalfedgeId now(HalfedgeId old) const {
    const std::size_t t = old.index() / 3;
    const std::size_t first = moved[t].index() / 3 * 3;
    const std::size_t side = moved[t].index() - first + (old.index() - 3 * t);
    return HalfedgeId{first + (side < 3 ? side : side - 3)};
  }
};

/// Sorts triangles of which vertex v is to be called number[v] (empty: v). Pre: corners are vertices, and
/// the numbers a permutation of their ids. Throws: Error{Cancelled}. Complexity: linear for bounded degrees;
/// runs on all threads.
SortedTriangles sort_triangles(std::span<const Triangle> corners, std::span<const VertexId> number,
                               std::size_t vertex_count, const Progress& progress);

}  // namespace thalweg
