#pragma once

/// The two implementations of the constrained Delaunay triangulation.

#include <thalweg/base/progress.hpp>
#include <thalweg/mesh/tin.hpp>

#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace thalweg::detail {

using VertexPair = std::pair<std::uint32_t, std::uint32_t>;

struct Triangulated {
  /// No corners: all points are collinear. No twins: neighbours are not known. `number`: ids of points.
  LinkedTriangles triangles;
  std::optional<VertexPair> crossing;  ///< an edge that crosses another one, or a vertex: no triangles then
};

/// See `triangulate` for promises; edges are distinct. Throws: Error{Cancelled}.
Triangulated triangulate_flat(std::span<const Point2> points, std::span<const VertexPair> edges,
                              Progress& progress);
Triangulated triangulate_by_cgal(std::span<const Point2> points, std::span<const VertexPair> edges,
                                 Progress& progress);

}  // namespace thalweg::detail
