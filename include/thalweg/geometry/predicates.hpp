#pragma once

/// Exact predicates on double coordinates, and the one tie rule for cocircular points.
///
/// Laws: (1) every answer is that of exact real arithmetic on the given doubles; (2) `in_circle_perturbed` is
/// the answer for symbolically perturbed, lifted points, so it never ties for four distinct points of which
/// three are not collinear; (3) no answer depends on the machine or on compiler flags that respect IEEE 754.
/// Pre (all): coordinates are finite and less than 1e100 in magnitude.

#include <thalweg/geometry/point.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace thalweg {

namespace detail {
int orientation_exact(Point2 a, Point2 b, Point2 c);
int side_of_plane_exact(Point2 a, Point2 b, Point2 c, Point2 d, const std::array<double, 4>& heights);
int in_circle_exact(Point2 a, Point2 b, Point2 c, Point2 d);
int break_cocircular_tie(Point2 a, Point2 b, Point2 c, Point2 d);
bool in_circle_perturbed_exact(Point2 a, Point2 b, Point2 c, Point2 d);
}  // namespace detail

/// What a filter says when rounding may hide the sign.
inline constexpr int kUndecided = 2;

/// A determinant as rounding leaves it. Its sign is right if it is larger than the doubt, which is infinite
/// where underflow may hide something.
struct RoundedDeterminant {
  double value;
  double doubt;
  /// False where a coordinate is NaN.
  [[nodiscard]] bool sure() const { return std::abs(value) > doubt; }
  [[nodiscard]] int sign() const { return value > doubt ? 1 : -value > doubt ? -1 : kUndecided; }
};

/// Error bounds of all filters: Shewchuk, Adaptive Precision Floating-Point Arithmetic, 1997, section 4
/// (stage A): (a + b epsilon) epsilon times the sum of the sizes of what was added; above `no_underflow` what
/// products lose that are too small for doubles, 2^-1075 each times up to 1e100 a factor, is less than that.
namespace detail {
constexpr RoundedDeterminant with_doubt(double value, double size, double a, double b, double no_underflow) {
  constexpr double kEpsilon = 0x1p-53;
  const double bound = (a + b * kEpsilon) * kEpsilon * size;
  return {value, size > no_underflow ? bound : std::numeric_limits<double>::infinity()};
}
}  // namespace detail

/// Positive if a, b, c turn counter-clockwise.
inline RoundedDeterminant orientation_rounded(Point2 a, Point2 b, Point2 c) {
  const double left = (a.x - c.x) * (b.y - c.y);
  const double right = (a.y - c.y) * (b.x - c.x);
  return detail::with_doubt(left - right, std::abs(left) + std::abs(right), 3, 16, 1e-280);
}

/// +1 if a, b, c turn counter-clockwise, -1 if clockwise, 0 if collinear.
inline int orientation(Point2 a, Point2 b, Point2 c) {
  const int sign = orientation_rounded(a, b, c).sign();
  return sign != kUndecided ? sign : detail::orientation_exact(a, b, c);
}

/// Positive if d lies inside the circle through a, b, c. Pre: a, b, c counter-clockwise.
inline RoundedDeterminant in_circle_rounded(Point2 a, Point2 b, Point2 c, Point2 d) {
  const double adx = a.x - d.x, ady = a.y - d.y;
  const double bdx = b.x - d.x, bdy = b.y - d.y;
  const double cdx = c.x - d.x, cdy = c.y - d.y;
  const double bc = bdx * cdy, cb = cdx * bdy;
  const double ca = cdx * ady, ac = adx * cdy;
  const double ab = adx * bdy, ba = bdx * ady;
  const double a_lift = adx * adx + ady * ady;
  const double b_lift = bdx * bdx + bdy * bdy;
  const double c_lift = cdx * cdx + cdy * cdy;
  const double size = (std::abs(bc) + std::abs(cb)) * a_lift + (std::abs(ca) + std::abs(ac)) * b_lift +
                      (std::abs(ab) + std::abs(ba)) * c_lift;
  return detail::with_doubt(a_lift * (bc - cb) + b_lift * (ca - ac) + c_lift * (ab - ba), size, 10, 96,
                            1e-105);
}

/// As `in_circle`, or kUndecided; a coordinate that is NaN is always undecided.
inline int in_circle_filtered(Point2 a, Point2 b, Point2 c, Point2 d) {
  return in_circle_rounded(a, b, c, d).sign();
}

/// +1 if d lies inside the circle through a, b, c, -1 if outside, 0 if on it.
/// Pre: a, b, c counter-clockwise.
inline int in_circle(Point2 a, Point2 b, Point2 c, Point2 d) {
  const int sign = in_circle_filtered(a, b, c, d);
  return sign != kUndecided ? sign : detail::in_circle_exact(a, b, c, d);
}

/// +1 if d lies above the plane through a, b, c, -1 if below, 0 if on it; heights in the order of the points.
/// Pre: a, b, c counter-clockwise.
inline int side_of_plane(Point2 a, Point2 b, Point2 c, Point2 d, const std::array<double, 4>& heights) {
  const double adx = a.x - d.x, bdx = b.x - d.x, cdx = c.x - d.x;
  const double ady = a.y - d.y, bdy = b.y - d.y, cdy = c.y - d.y;
  const double adz = heights[0] - heights[3], bdz = heights[1] - heights[3], cdz = heights[2] - heights[3];
  if (adz == 0 && bdz == 0 && cdz == 0) return 0;
  const double bc = bdx * cdy, cb = cdx * bdy;
  const double ca = cdx * ady, ac = adx * cdy;
  const double ab = adx * bdy, ba = bdx * ady;
  const double above = -(adz * (bc - cb) + bdz * (ca - ac) + cdz * (ab - ba));
  const double size = (std::abs(bc) + std::abs(cb)) * std::abs(adz) +
                      (std::abs(ca) + std::abs(ac)) * std::abs(bdz) +
                      (std::abs(ab) + std::abs(ba)) * std::abs(cdz);
  const int sign = detail::with_doubt(above, size, 7, 56, 1e-205).sign();
  if (sign != kUndecided) return sign;
  return detail::side_of_plane_exact(a, b, c, d, heights);
}

/// True if d counts as inside the circle through a, b, c under the tie rule: of four cocircular points the
/// lexicographically largest (x, then y) counts as outside the circle of the other three; the sign for any
/// other follows by replacing that largest one by d. (CGAL's rule, so that order 0 is CGAL's triangulation.)
/// Pre: a, b, c counter-clockwise; the four points distinct.
inline bool in_circle_perturbed(Point2 a, Point2 b, Point2 c, Point2 d) {
  const int sign = in_circle_filtered(a, b, c, d);
  return sign != kUndecided ? sign > 0 : detail::in_circle_perturbed_exact(a, b, c, d);
}

/// True if the closed segment pq has a point inside the open disc bounded by the circle through a, b, c; a
/// segment that only touches the circle does not. Never perturbed. Pre: a, b, c counter-clockwise.
bool segment_meets_open_disc(Point2 a, Point2 b, Point2 c, Point2 p, Point2 q);

/// True if p lies on the closed segment ab. Pre: a != b.
inline bool on_segment(Point2 a, Point2 b, Point2 p) {
  if (p.x < std::min(a.x, b.x) || p.x > std::max(a.x, b.x)) return false;
  if (p.y < std::min(a.y, b.y) || p.y > std::max(a.y, b.y)) return false;
  return orientation(a, b, p) == 0;
}

/// True if the open segments ab and cd have exactly one point in common, which is an end of neither.
inline bool cross_properly(Point2 a, Point2 b, Point2 c, Point2 d) {
  return orientation(a, b, c) * orientation(a, b, d) < 0 && orientation(c, d, a) * orientation(c, d, b) < 0;
}

}  // namespace thalweg
