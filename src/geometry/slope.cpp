// The exact stage, behind the inline filter. Lattices come here often, so two cases go first that plain
// doubles decide: (1) each of the two products has a factor that is zero; (2) all differences are whole
// numbers below 2^16, and exact: then so are all products and sums, which stay below 2^53. The rest is for
// rationals.
#include "geometry/exact_difference.hpp"

#include <thalweg/geometry/slope.hpp>

#include <CGAL/Exact_rational.h>

#include <cmath>
#include <optional>

namespace thalweg::detail {

namespace {

bool is_small_whole(double x) {
  return std::abs(x) < 0x1p16 && std::trunc(x) == x;
}

std::optional<double> determinant_in_doubles(Point2 a, double za, Point2 b, double zb, Point2 c, double zc) {
  const double ux = b.x - a.x, uy = b.y - a.y, uz = zb - za;
  const double vx = c.x - a.x, vy = c.y - a.y, vz = zc - za;
  const bool perpendicular = (ux == 0 || vx == 0) && (uy == 0 || vy == 0);
  if (vz == 0 && perpendicular) return 0;
  for (const double d : {ux, uy, uz, vx, vy, vz}) {
    if (!is_small_whole(d)) return std::nullopt;
  }
  if (!is_exact_difference(b.x, a.x, ux) || !is_exact_difference(b.y, a.y, uy) ||
      !is_exact_difference(zb, za, uz))
    return std::nullopt;
  if (!is_exact_difference(c.x, a.x, vx) || !is_exact_difference(c.y, a.y, vy) ||
      !is_exact_difference(zc, za, vz))
    return std::nullopt;
  return vz * (ux * ux + uy * uy) - uz * (ux * vx + uy * vy);
}

}  // namespace

int fall_across_exact(Point2 a, double za, Point2 b, double zb, Point2 c, double zc) {
  if (za == zb) return zc > za ? 1 : zc < za ? -1 : 0;
  if (const auto d = determinant_in_doubles(a, za, b, zb, c, zc)) return *d > 0 ? 1 : *d < 0 ? -1 : 0;
  using Number = CGAL::Exact_rational;
  const Number ux = Number(b.x) - Number(a.x), uy = Number(b.y) - Number(a.y);
  const Number vx = Number(c.x) - Number(a.x), vy = Number(c.y) - Number(a.y);
  const Number rise = (Number(zc) - Number(za)) * (ux * ux + uy * uy);
  const Number along = (Number(zb) - Number(za)) * (ux * vx + uy * vy);
  return rise > along ? 1 : rise < along ? -1 : 0;
}

}  // namespace thalweg::detail
