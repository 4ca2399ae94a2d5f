#pragma once

/// The two implementations of the constrained Delaunay triangulation.

#include <thalweg/base/progress.hpp>
#include <thalweg/delaunay/triangulate.hpp>
#include <thalweg/mesh/tin.hpp>

#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace thalweg::detail {

using VertexPair = std::pair<std::uint32_t, std::uint32_t>;

/// An edge to be constrained, its smaller vertex first.
struct DrawnEdge {
  VertexPair ends;
  EdgeKind kind = EdgeKind::None;
};

/// No triangles at all: all points are collinear.
struct Triangulated {
  LinkedTriangles linked;
  std::vector<Triangle> plain;         ///< instead, if neighbours are not known
  std::optional<VertexPair> crossing;  ///< an edge that crosses another one, or a vertex: no triangles then
};

/// What is known of the order of points; no outcome depends on it.
enum class PointOrder : std::uint8_t {
  Any,
  AlongCurve  ///< as `hilbert_order` has them
};

/// As `thalweg::triangulate`.
Tin triangulate(std::vector<Point2> points, std::vector<double> heights,
                std::span<const ConstraintEdge> constraints, PointOrder points_are, Progress& progress,
                TriangulationEngine engine);

/// See `triangulate` for promises; edges are distinct. Throws: Error{Cancelled}.
Triangulated triangulate_flat(std::span<const Point2> points, std::span<const DrawnEdge> edges,
                              PointOrder points_are, Progress& progress);
Triangulated triangulate_by_cgal(std::span<const Point2> points, std::span<const DrawnEdge> edges,
                                 Progress& progress);

}  // namespace thalweg::detail
