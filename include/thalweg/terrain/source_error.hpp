#pragma once

/// How far a simplified TIN is from the source points that it left out.

#include <thalweg/base/progress.hpp>
#include <thalweg/mesh/tin.hpp>
#include <thalweg/order/quadrilaterals.hpp>

#include <vector>

namespace thalweg {

/// Source points that are no vertices, each with the triangle of some TIN that holds it.
struct LeftOutPoints {
  std::vector<Point2> xy;
  std::vector<double> z;
  std::vector<TriangleId> triangle;
};

/// Takes from the list each quadrilateral whose other triangulation would be vertically farther than `limit`
/// (in the unit of heights) from one of the points in it. Law: with any diagonals of those that stay, no
/// point is farther off than the limit, or than it is in `tin`; in exact arithmetic. Pre: the points are in
/// triangles of `tin`. Complexity: linear; on all threads.
void bar_diagonals(const Tin& tin, const LeftOutPoints& points, double limit,
                   std::vector<Quadrilateral>& quadrilaterals, const Progress& progress);

/// The same points in the triangles of a TIN that differs by flipped edges, no two of them of one triangle.
/// Complexity: linear.
LeftOutPoints relocated(const LeftOutPoints& points, const Tin& before, const Tin& after);

/// In the unit of heights.
struct SourceError {
  double largest = 0;
  double rms = 0;  ///< over the points and the vertices of the TIN, whose error is 0
};
SourceError measure_error(const Tin& tin, const LeftOutPoints& points);

}  // namespace thalweg
