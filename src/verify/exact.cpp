// Signs of determinants.
//
// 1. In extended precision (64 bits of mantissa), with an error bound that is generous rather than sharp.
// 2. What is too near to zero: coordinates become integers (their common power of two is drawn out), and the
//    determinant is computed in integers without limit (Boost.Multiprecision).
// 3. A turn whose coordinate differences are exact, as on every lattice, needs no integers: two products are
//    compared by their roundings, then by what these leave (fused multiply-add).
#include "verify/exact.hpp"

#include <boost/multiprecision/cpp_int.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

namespace thalweg::verify {

namespace {

using Integer = boost::multiprecision::cpp_int;
using Extended = long double;

constexpr Extended kUnit = std::numeric_limits<Extended>::epsilon();

int sign_of(const Integer& value) {
  return value.sign();
}

// The given coordinates over their common power of two.
template <std::size_t N>
std::array<Integer, N> as_integers(const std::array<double, N>& values) {
  constexpr int kMantissa = 53;
  std::array<int, N> exponents{};
  int lowest = std::numeric_limits<int>::max();
  for (std::size_t i = 0; i < N; ++i) {
    if (values[i] == 0) continue;
    std::frexp(values[i], &exponents[i]);
    lowest = std::min(lowest, exponents[i]);
  }
  std::array<Integer, N> integers;
  for (std::size_t i = 0; i < N; ++i) {
    if (values[i] == 0) continue;
    const double mantissa = std::ldexp(values[i], kMantissa - exponents[i]);
    integers[i] = Integer(static_cast<std::int64_t>(mantissa))
                  << static_cast<unsigned>(exponents[i] - lowest);
  }
  return integers;
}

// Difference of two doubles if it is a double.
bool exact_difference(double a, double b, double& difference) {
  difference = a - b;
  const double b_virtual = a - difference;
  const double a_virtual = difference + b_virtual;
  return (a - a_virtual) + (b_virtual - b) == 0;
}

int compare_products(double a, double b, double c, double d) {
  const double left = a * b, right = c * d;
  if (left != right) return left > right ? 1 : -1;
  const double left_rest = std::fma(a, b, -left), right_rest = std::fma(c, d, -right);
  return left_rest == right_rest ? 0 : left_rest > right_rest ? 1 : -1;
}

int turn_by_integers(Point2 a, Point2 b, Point2 c) {
  const auto v = as_integers<6>({a.x, a.y, b.x, b.y, c.x, c.y});
  return sign_of((v[0] - v[4]) * (v[3] - v[5]) - (v[1] - v[5]) * (v[2] - v[4]));
}

int circle_by_integers(Point2 a, Point2 b, Point2 c, Point2 d) {
  const auto v = as_integers<8>({a.x, a.y, b.x, b.y, c.x, c.y, d.x, d.y});
  const Integer ax = v[0] - v[6], ay = v[1] - v[7], bx = v[2] - v[6], by = v[3] - v[7], cx = v[4] - v[6],
                cy = v[5] - v[7];
  return sign_of((ax * ax + ay * ay) * (bx * cy - cx * by) + (bx * bx + by * by) * (cx * ay - ax * cy) +
                 (cx * cx + cy * cy) * (ax * by - bx * ay));
}

}  // namespace

int turn(Point2 a, Point2 b, Point2 c) {
  constexpr double kNormal = 1e-250;  // products and what their rounding leaves stay normal numbers
  const Extended left = (Extended{a.x} - c.x) * (Extended{b.y} - c.y);
  const Extended right = (Extended{a.y} - c.y) * (Extended{b.x} - c.x);
  const Extended determinant = left - right;
  const Extended bound = 8 * kUnit * (std::abs(left) + std::abs(right));
  if (bound > kNormal && std::abs(determinant) > bound) return determinant > 0 ? 1 : -1;
  // No product of two doubles leaves the range of Extended: a zero is exact, and so is the other's sign.
  if (left == 0 || right == 0) return determinant > 0 ? 1 : determinant < 0 ? -1 : 0;
  double ax = 0, ay = 0, bx = 0, by = 0;
  if (exact_difference(a.x, c.x, ax) && exact_difference(a.y, c.y, ay) && exact_difference(b.x, c.x, bx) &&
      exact_difference(b.y, c.y, by) && bound > kNormal) {
    return compare_products(ax, by, ay, bx);
  }
  return turn_by_integers(a, b, c);
}

int circle_side(Point2 a, Point2 b, Point2 c, Point2 d) {
  constexpr Extended kNormal = 1e-300L;
  const Extended ax = Extended{a.x} - d.x, ay = Extended{a.y} - d.y, bx = Extended{b.x} - d.x,
                 by = Extended{b.y} - d.y, cx = Extended{c.x} - d.x, cy = Extended{c.y} - d.y;
  const Extended a2 = ax * ax + ay * ay, b2 = bx * bx + by * by, c2 = cx * cx + cy * cy;
  const Extended determinant = a2 * (bx * cy - cx * by) + b2 * (cx * ay - ax * cy) + c2 * (ax * by - bx * ay);
  const Extended magnitude = a2 * (std::abs(bx * cy) + std::abs(cx * by)) +
                             b2 * (std::abs(cx * ay) + std::abs(ax * cy)) +
                             c2 * (std::abs(ax * by) + std::abs(bx * ay));
  const Extended bound = 32 * kUnit * magnitude;
  if (bound > kNormal && std::abs(determinant) > bound) return determinant > 0 ? 1 : -1;
  return circle_by_integers(a, b, c, d);
}

bool counts_as_inside(Point2 a, Point2 b, Point2 c, Point2 d) {
  const int side = circle_side(a, b, c, d);
  if (side != 0) return side > 0;
  const Point2 largest = std::max({a, b, c, d});
  if (d == largest) return false;
  if (c == largest) return turn(a, b, d) > 0;
  if (b == largest) return turn(a, d, c) > 0;
  return turn(d, b, c) > 0;
}

bool segments_cross(Point2 a, Point2 b, Point2 c, Point2 d) {
  return turn(a, b, c) * turn(a, b, d) < 0 && turn(c, d, a) * turn(c, d, b) < 0;
}

bool inside_segment(Point2 a, Point2 b, Point2 x) {
  if (x == a || x == b) return false;
  if (x.x < std::min(a.x, b.x) || x.x > std::max(a.x, b.x)) return false;
  if (x.y < std::min(a.y, b.y) || x.y > std::max(a.y, b.y)) return false;
  return turn(a, b, x) == 0;
}

}  // namespace thalweg::verify
