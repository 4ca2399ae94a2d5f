#pragma once

/// How far a point lies above or below a plane, against a limit, without rounding in the limit's favour.

#include <thalweg/geometry/predicates.hpp>

#include <array>
#include <cmath>
#include <limits>

namespace thalweg {

/// True if the point d is vertically at most `limit` from the plane through a, b, c; heights in the order of
/// the points, in one unit with the limit.
/// Law: where it is true, it is true in exact arithmetic on the given doubles. It may be false for a distance
/// that is less than a unit in the last place of d's height below the limit.
/// Pre: a, b, c counter-clockwise; limit >= 0; as for all predicates.
inline bool within_of_plane(Point2 a, Point2 b, Point2 c, Point2 d, const std::array<double, 4>& heights,
                            double limit) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const double z = heights[3];
  // z - limit rounded up and z + limit rounded down; what rounding took, exactly: Knuth's two-sum.
  double low = z - limit;
  const double low_part = z - low;
  if ((z - (low + low_part)) + (low_part - limit) > 0) low = std::nextafter(low, kInfinity);
  double high = z + limit;
  const double high_part = high - z;
  if ((z - (high - high_part)) + (limit - high_part) < 0) high = std::nextafter(high, -kInfinity);
  return side_of_plane(a, b, c, d, {heights[0], heights[1], heights[2], low}) <= 0 &&
         side_of_plane(a, b, c, d, {heights[0], heights[1], heights[2], high}) >= 0;
}

}  // namespace thalweg
