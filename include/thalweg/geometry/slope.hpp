#pragma once

/// Which way a plane in space falls, exactly.
///
/// Law: the answer is that of exact real arithmetic on the given doubles; horizontal and vertical units need
/// not be the same. Pre: coordinates and heights are finite and less than 1e100 in magnitude.

#include <thalweg/geometry/point.hpp>

#include <cmath>

namespace thalweg {

namespace detail {
int fall_across_exact(Point2 a, double za, Point2 b, double zb, Point2 c, double zc);
}

/// How the triangle abc falls across its side ab: +1 if water on it runs towards ab and over it, -1 if it
/// runs from ab into the triangle, 0 if it runs along ab or the triangle is level. That is the sign of the
/// height of c above the point of line ab at the foot of its perpendicular. Pre: a, b, c are not collinear.
/// Error bound: seven roundings a term, one more for the bound itself.
inline int fall_across(Point2 a, double za, Point2 b, double zb, Point2 c, double zc) {
  constexpr double kBound = 10 * 0x1p-53;
  constexpr double kNoUnderflow = 1e-280;
  const double ux = b.x - a.x, uy = b.y - a.y;
  const double vx = c.x - a.x, vy = c.y - a.y;
  const double rise = (zc - za) * (ux * ux + uy * uy);
  const double x = ux * vx, y = uy * vy;
  const double determinant = rise - (zb - za) * (x + y);
  const double magnitude = std::abs(rise) + std::abs(zb - za) * (std::abs(x) + std::abs(y));
  const double bound = kBound * magnitude;
  if (magnitude > kNoUnderflow) {
    if (determinant > bound) return 1;
    if (-determinant > bound) return -1;
  }
  return detail::fall_across_exact(a, za, b, zb, c, zc);
}

}  // namespace thalweg
