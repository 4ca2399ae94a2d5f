#pragma once

/// Which way a plane in space falls, exactly.
///
/// Law: the answer is that of exact real arithmetic on the given doubles; horizontal and vertical units need
/// not be the same. Pre: coordinates and heights are finite and less than 1e100 in magnitude.

#include <thalweg/geometry/predicates.hpp>

#include <cmath>

namespace thalweg {

namespace detail {
int fall_across_exact(Point2 a, double za, Point2 b, double zb, Point2 c, double zc);
}

/// Positive if the triangle abc falls across its side ab, negative if from it. Error bound: seven roundings a
/// term, one more for the bound itself. Pre: a, b, c are not collinear.
inline RoundedDeterminant fall_across_rounded(Point2 a, double za, Point2 b, double zb, Point2 c, double zc) {
  const double ux = b.x - a.x, uy = b.y - a.y;
  const double vx = c.x - a.x, vy = c.y - a.y;
  const double rise = (zc - za) * (ux * ux + uy * uy);
  const double x = ux * vx, y = uy * vy;
  const double size = std::abs(rise) + std::abs(zb - za) * (std::abs(x) + std::abs(y));
  return detail::with_doubt(rise - (zb - za) * (x + y), size, 10, 0, 1e-205);
}

/// How the triangle abc falls across its side ab: +1 if water on it runs towards ab and over it, -1 if it
/// runs from ab into the triangle, 0 if it runs along ab or the triangle is level. That is the sign of the
/// height of c above the point of line ab at the foot of its perpendicular. Pre: a, b, c are not collinear.
inline int fall_across(Point2 a, double za, Point2 b, double zb, Point2 c, double zc) {
  const int sign = fall_across_rounded(a, za, b, zb, c, zc).sign();
  return sign != kUndecided ? sign : detail::fall_across_exact(a, za, b, zb, c, zc);
}

/// Whether an edge that is not level is a valley of the surface, by how the triangles on both sides fall
/// across it: both drain into it, at least one of them not just along it.
inline bool makes_valley(int left_fall, int right_fall) {
  return left_fall >= 0 && right_fall >= 0 && left_fall + right_fall > 0;
}

}  // namespace thalweg
