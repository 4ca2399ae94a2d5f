#pragma once

/// The distinct positions of a survey.

#include <thalweg/delaunay/ground.hpp>

#include <cstdint>
#include <vector>

namespace thalweg {

/// Distinct vertices in order of first appearance: points, then line vertices.
struct MergedVertices {
  std::vector<Point2> xy;
  std::vector<VertexOrigin> origins;       ///< whose position it is
  std::size_t point_count = 0;             ///< vertices [0, point_count) are points
  double pixel = 0;                        ///< side of the snapping grid
  std::vector<std::uint32_t> of_point;     ///< the vertex of each point of the survey
  std::vector<std::size_t> first_of_line;  ///< where the vertices of line l start in of_line_vertex
  std::vector<std::uint32_t> of_line_vertex;
  std::vector<std::uint32_t> along_curve;  ///< the vertices along a Hilbert curve; empty: that is not known

  /// The vertex of a position: of a point, or after all points of a line vertex.
  [[nodiscard]] std::uint32_t& number(std::size_t position) {
    return position < of_point.size() ? of_point[position] : of_line_vertex[position - of_point.size()];
  }
  [[nodiscard]] std::uint32_t of_line(std::size_t line, std::size_t vertex) const {
    return of_line_vertex[first_of_line[line] + vertex];
  }
};

/// Merges equal positions, and those within `snap` (see GroundOptions). A line vertex within a quarter of a
/// pixel of a point is that point, and two such line vertices are one: the same place computed in two ways.
/// Throws: Error{BadCoordinate} naming the first position or height that is not finite or beyond 1e15.
MergedVertices merge_vertices(const Survey& survey, const GroundOptions& options, Progress& progress);

}  // namespace thalweg
