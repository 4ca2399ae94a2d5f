// The exact stage of the predicates, behind the inline filters.
//
// 1. Orientation and in-circle: differences of coordinates that are near each other are exact doubles. Where
//    all are, and where they are integers of at most 61 bits once scaled by one power of two (lattices, and
//    points close together at large offsets), the determinant is computed in integers of 128 and 256 bits.
//    Everything else, and the side of a plane: CGAL's filtered kernel on the same doubles.
// 2. The tie rule: sort the four points; the largest that is one of a, b, c, and whose replacement by d
//    leaves a proper triangle, decides by that triangle's orientation; if d comes first, it is outside.
//    Points are handed on by reference: a copy of what was just stored in parts waits for all of them.
// 3. Segment against open disc: the condition is written without division as signs of polynomials in
//    coordinates relative to a, evaluated in intervals first and in rationals where those do not decide.
#include "geometry/exact_difference.hpp"

#include <thalweg/geometry/predicates.hpp>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Exact_rational.h>
#include <CGAL/Interval_nt.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <optional>

namespace thalweg {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

Kernel::Point_2 to_cgal(Point2 p) {
  return {p.x, p.y};
}

// Both ends outside the open disc: it is met if and only if the centre projects into the open segment and is
// nearer to the line than the radius. Relative to a, D * centre = (U, V) with D = 2 cross(b - a, c - a) > 0.
template <class Number>
auto passes_through_disc(Point2 a, Point2 b, Point2 c, Point2 p, Point2 q) {
  const Number ax(a.x), ay(a.y);
  const Number bx = Number(b.x) - ax, by = Number(b.y) - ay;
  const Number cx = Number(c.x) - ax, cy = Number(c.y) - ay;
  const Number px = Number(p.x) - ax, py = Number(p.y) - ay;
  const Number dx = Number(q.x) - Number(p.x), dy = Number(q.y) - Number(p.y);
  const Number denominator = Number(2) * (bx * cy - by * cx);
  const Number b_lift = bx * bx + by * by;
  const Number c_lift = cx * cx + cy * cy;
  const Number u = cy * b_lift - by * c_lift;
  const Number v = bx * c_lift - cx * b_lift;
  const Number from_p_x = u - denominator * px, from_p_y = v - denominator * py;
  const Number along = from_p_x * dx + from_p_y * dy;
  const Number length_squared = dx * dx + dy * dy;
  const Number beyond = denominator * length_squared - along;
  const Number across = dx * from_p_y - dy * from_p_x;
  const Number clearance = (u * u + v * v) * length_squared - across * across;
  return (along > Number(0)) & (beyond > Number(0)) & (clearance > Number(0));
}

std::optional<bool> passes_through_disc_filtered(Point2 a, Point2 b, Point2 c, Point2 p, Point2 q) {
  using Interval = CGAL::Interval_nt<false>;
  const Interval::Protector protector;
  const CGAL::Uncertain<bool> answer = passes_through_disc<Interval>(a, b, c, p, q);
  if (CGAL::is_certain(answer)) return CGAL::get_certain(answer);
  return std::nullopt;
}

/// Differences of points as integers in one common unit, if they are such exactly. The largest has kBits.
constexpr int kBits = 61;
template <std::size_t Count>
std::optional<std::array<std::int64_t, Count>> integer_differences(
    const std::array<const Point2*, Count / 2>& points, const Point2& origin) {
  std::array<double, Count> exact;
  double largest = 0;
  for (std::size_t i = 0; i < Count / 2; ++i) {
    exact[2 * i] = points[i]->x - origin.x;
    exact[2 * i + 1] = points[i]->y - origin.y;
    if (!detail::is_exact_difference(points[i]->x, origin.x, exact[2 * i]) ||
        !detail::is_exact_difference(points[i]->y, origin.y, exact[2 * i + 1])) {
      return std::nullopt;
    }
    largest = std::max({largest, std::abs(exact[2 * i]), std::abs(exact[2 * i + 1])});
  }
  // The scale is a power of two that is put together from its bits.
  constexpr int kBias = 1023, kMantissa = 52;
  const int exponent = static_cast<int>(std::bit_cast<std::uint64_t>(largest) >> kMantissa) - kBias;
  if (exponent < -900 || exponent > 900) return std::nullopt;
  const double scale =
      std::bit_cast<double>(static_cast<std::uint64_t>(kBias + kBits - 1 - exponent) << kMantissa);
  std::array<std::int64_t, Count> integers;
  for (std::size_t i = 0; i < Count; ++i) {
    const double scaled = exact[i] * scale;
    integers[i] = static_cast<std::int64_t>(scaled);
    const bool lost = scaled == 0 && exact[i] != 0;  // too small for a double
    if (lost || static_cast<double>(integers[i]) != scaled) return std::nullopt;
  }
  return integers;
}

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpedantic"
using Int128 = __int128;
using Unsigned128 = unsigned __int128;
#pragma GCC diagnostic pop

/// A signed integer of 256 bits, as two's complement.
struct Int256 {
  Unsigned128 high = 0;
  Unsigned128 low = 0;

  void add(const Int256& other) {
    low += other.low;
    high += other.high + (low < other.low ? 1 : 0);
  }
  void negate() {
    low = ~low + 1;
    high = ~high + (low == 0 ? 1 : 0);
  }
  [[nodiscard]] int sign() const {
    if (static_cast<Int128>(high) < 0) return -1;
    return high == 0 && low == 0 ? 0 : 1;
  }
};

Int256 product(Int128 a, Int128 b) {
  const bool negative = (a < 0) != (b < 0);
  const Unsigned128 x = a < 0 ? -static_cast<Unsigned128>(a) : static_cast<Unsigned128>(a);
  const Unsigned128 y = b < 0 ? -static_cast<Unsigned128>(b) : static_cast<Unsigned128>(b);
  const auto low = [](Unsigned128 value) { return static_cast<std::uint64_t>(value); };
  const auto high = [](Unsigned128 value) { return static_cast<std::uint64_t>(value >> 64U); };
  const auto multiply = [](std::uint64_t p, std::uint64_t q) { return static_cast<Unsigned128>(p) * q; };
  const Unsigned128 low_low = multiply(low(x), low(y));
  const Unsigned128 low_high = multiply(low(x), high(y));
  const Unsigned128 high_low = multiply(high(x), low(y));
  const Unsigned128 middle = static_cast<Unsigned128>(high(low_low)) + low(low_high) + low(high_low);
  Int256 result;
  result.low = middle << 64U | low(low_low);
  result.high = multiply(high(x), high(y)) + high(low_high) + high(high_low) + high(middle);
  if (negative) result.negate();
  return result;
}

/// Pre: each is a multiple of two to the power of zeros.
std::array<std::int64_t, 6> shifted(std::array<std::int64_t, 6> values, int zeros) {
  for (std::int64_t& value : values) value >>= zeros;
  return values;
}

std::optional<int> orientation_in_integers(const Point2& a, const Point2& b, const Point2& c) {
  const auto d = integer_differences<4>({&a, &b}, c);
  if (!d) return std::nullopt;
  const auto [ax, ay, bx, by] = *d;
  const Int128 left = Int128{ax} * by;
  const Int128 right = Int128{ay} * bx;
  return left == right ? 0 : left > right ? 1 : -1;
}

// Differences have 61 bits, minors and squares at most 124, the determinant at most 250. On a lattice most of
// these bits are zeros at the end: without them it is often 30 bits, at most 62 and at most 126.
std::optional<int> in_circle_in_integers(const Point2& a, const Point2& b, const Point2& c, const Point2& d) {
  const auto differences = integer_differences<6>({&a, &b, &c}, d);
  if (!differences) return std::nullopt;
  const auto [ax, ay, bx, by, cx, cy] = *differences;
  const int zeros = std::countr_zero(static_cast<std::uint64_t>(ax | ay | bx | by | cx | cy));
  if (zeros >= kBits - 30) {
    const auto [adx, ady, bdx, bdy, cdx, cdy] = shifted(*differences, zeros);
    const Int128 determinant = Int128{adx * adx + ady * ady} * (bdx * cdy - cdx * bdy) +
                               Int128{bdx * bdx + bdy * bdy} * (cdx * ady - adx * cdy) +
                               Int128{cdx * cdx + cdy * cdy} * (adx * bdy - bdx * ady);
    return determinant == 0 ? 0 : determinant > 0 ? 1 : -1;
  }
  const auto lift = [](std::int64_t x, std::int64_t y) { return Int128{x} * x + Int128{y} * y; };
  const auto minor = [](std::int64_t px, std::int64_t py, std::int64_t qx, std::int64_t qy) {
    return Int128{px} * qy - Int128{qx} * py;
  };
  Int256 determinant = product(lift(ax, ay), minor(bx, by, cx, cy));
  determinant.add(product(lift(bx, by), minor(cx, cy, ax, ay)));
  determinant.add(product(lift(cx, cy), minor(ax, ay, bx, by)));
  return determinant.sign();
}

/// In-circle of points that are not the corners of a rectangle.
int in_circle_of_others(const Point2& a, const Point2& b, const Point2& c, const Point2& d) {
  if (const auto sign = in_circle_in_integers(a, b, c, d)) return *sign;
  return static_cast<int>(
      Kernel().side_of_oriented_circle_2_object()(to_cgal(a), to_cgal(b), to_cgal(c), to_cgal(d)));
}

/// If a, b, c and d are the corners of a rectangle along the axes, as in every cell of a raster: the one of
/// a, b, c that is opposite to d; else none.
const Point2* opposite_in_rectangle(const Point2& a, const Point2& b, const Point2& c, const Point2& d) {
  const auto opposite = [&d](const Point2& o, const Point2& p, const Point2& q) {
    return (p.x == d.x && q.y == d.y && p.y == o.y && q.x == o.x) ||
           (q.x == d.x && p.y == d.y && q.y == o.y && p.x == o.x);
  };
  if (opposite(a, b, c)) return &a;
  if (opposite(b, c, a)) return &b;
  if (opposite(c, a, b)) return &c;
  return nullptr;
}

// Some three of the points are collinear, the largest among them: then the next largest decides.
int break_tie_of_collinear(Point2 a, Point2 b, Point2 c, Point2 d) {
  std::array<Point2, 4> order{a, b, c, d};
  std::sort(order.begin(), order.end());
  for (std::size_t i = 3; i > 0; --i) {
    const Point2 largest = order[i];
    if (largest == d) return -1;
    int sign = 0;
    if (largest == c) {
      sign = orientation(a, b, d);
    } else if (largest == b) {
      sign = orientation(a, d, c);
    } else {
      sign = orientation(d, b, c);
    }
    if (sign != 0) return sign;
  }
  return -1;
}

}  // namespace

namespace detail {

int orientation_exact(Point2 a, Point2 b, Point2 c) {
  if ((a.x == b.x && b.x == c.x) || (a.y == b.y && b.y == c.y)) return 0;
  if (const auto sign = orientation_in_integers(a, b, c)) return *sign;
  return static_cast<int>(Kernel().orientation_2_object()(to_cgal(a), to_cgal(b), to_cgal(c)));
}

int in_circle_exact(Point2 a, Point2 b, Point2 c, Point2 d) {
  return opposite_in_rectangle(a, b, c, d) != nullptr ? 0 : in_circle_of_others(a, b, c, d);
}

int side_of_plane_exact(Point2 a, Point2 b, Point2 c, Point2 d, const std::array<double, 4>& heights) {
  const auto in_space = [](Point2 p, double z) { return Kernel::Point_3(p.x, p.y, z); };
  return static_cast<int>(Kernel().orientation_3_object()(in_space(a, heights[0]), in_space(b, heights[1]),
                                                          in_space(c, heights[2]), in_space(d, heights[3])));
}

int break_cocircular_tie(Point2 a, Point2 b, Point2 c, Point2 d) {
  const Point2& largest_of_ab = a < b ? b : a;
  const Point2& largest = largest_of_ab < c ? c : largest_of_ab;
  if (largest < d) return -1;
  const int sign = &largest == &c   ? orientation(a, b, d)
                   : &largest == &b ? orientation(a, d, c)
                                    : orientation(d, b, c);
  return sign != 0 ? sign : break_tie_of_collinear(a, b, c, d);
}

// Of four points on a circle, d is inside exactly if the largest is neither d nor its opposite: replacing one
// of d's neighbours by d keeps the turn, replacing its opposite reverses it. In a rectangle the largest is
// the upper right corner.
bool in_circle_perturbed_exact(Point2 a, Point2 b, Point2 c, Point2 d) {
  if (const Point2* o = opposite_in_rectangle(a, b, c, d)) return (d.x > o->x) != (d.y > o->y);
  const int sign = in_circle_of_others(a, b, c, d);
  return sign != 0 ? sign > 0 : break_cocircular_tie(a, b, c, d) > 0;
}

}  // namespace detail

bool segment_meets_open_disc(Point2 a, Point2 b, Point2 c, Point2 p, Point2 q) {
  if (in_circle(a, b, c, p) > 0 || in_circle(a, b, c, q) > 0) return true;
  if (const auto answer = passes_through_disc_filtered(a, b, c, p, q)) return *answer;
  return passes_through_disc<CGAL::Exact_rational>(a, b, c, p, q);
}

}  // namespace thalweg
