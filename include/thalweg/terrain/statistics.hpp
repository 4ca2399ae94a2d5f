#pragma once

/// What a TIN is, in numbers.

#include <thalweg/mesh/tin.hpp>

#include <array>
#include <cstddef>

namespace thalweg {

/// Units of a TIN's plane and heights.
struct MetricScale {
  double horizontal_metres_per_unit = 1;
  double vertical_metres_per_unit = 1;
};

/// Figures of a TIN's shape; all zero for a TIN without triangles.
struct TinStatistics {
  double area_m2 = 0;          ///< in the plane
  double surface_area_m2 = 0;  ///< along the slopes
  double min_angle_deg = 0;    ///< smallest angle of any triangle, in the plane
  /// Triangles by their smallest angle, in the plane: below 10, 20, 30, 40, 50 and up to 60 degrees.
  std::array<std::size_t, 6> angle_histogram{};
  /// Triangles by their slope: below 10, 20, ... 80, 90 degrees.
  std::array<std::size_t, 9> slope_histogram{};
  /// Triangles by the direction in which they fall: N, NE, E, SE, S, SW, W, NW (north is +y), and level ones
  /// last.
  std::array<std::size_t, 9> aspect_histogram{};
  std::size_t flat_triangles = 0;  ///< all three heights equal
  std::size_t rim_vertices = 0;    ///< vertices on the rim: outer, of holes, of dropped triangles
  std::size_t rim_edges = 0;
  /// Vertices on the convex hull of all vertices that are in a triangle, those within its sides included.
  std::size_t hull_vertices = 0;
  double z_min = 0;  ///< lowest and highest vertex of a triangle, in the TIN's own unit
  double z_max = 0;
};

/// Measures a TIN. The figures do not depend on the number of threads, nor on the order of vertices or
/// triangles: a triangle's figures start at its lexicographically smallest corner, and sums carry twice the
/// precision of a double. Complexity: linear, plus r log r for r rim vertices; runs on all threads.
TinStatistics measure(const Tin& tin, const MetricScale& scale = {});

/// Its angle histogram alone.
std::array<std::size_t, 6> measure_angles(const Tin& tin, const MetricScale& scale = {});

}  // namespace thalweg
