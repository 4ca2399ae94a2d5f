// The exact stage of the predicates, behind the inline filters.
//
// 1. Orientation and in-circle: CGAL's filtered kernel on the same doubles.
// 2. The tie rule: sort the four points; the largest that is one of a, b, c, and whose replacement by d
// leaves
//    a proper triangle, decides by that triangle's orientation; if d comes first, it is outside.
// 3. Segment against open disc: the condition is written without division as signs of polynomials in
//    coordinates relative to a, evaluated in intervals first and in rationals where those do not decide.
#include <thalweg/geometry/predicates.hpp>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Exact_rational.h>
#include <CGAL/Interval_nt.h>

#include <algorithm>
#include <array>
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

}  // namespace

namespace detail {

int orientation_exact(Point2 a, Point2 b, Point2 c) {
  return static_cast<int>(Kernel().orientation_2_object()(to_cgal(a), to_cgal(b), to_cgal(c)));
}

int in_circle_exact(Point2 a, Point2 b, Point2 c, Point2 d) {
  return static_cast<int>(
      Kernel().side_of_oriented_circle_2_object()(to_cgal(a), to_cgal(b), to_cgal(c), to_cgal(d)));
}

int break_cocircular_tie(Point2 a, Point2 b, Point2 c, Point2 d) {
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

}  // namespace detail

bool segment_meets_open_disc(Point2 a, Point2 b, Point2 c, Point2 p, Point2 q) {
  if (in_circle(a, b, c, p) > 0 || in_circle(a, b, c, q) > 0) return true;
  if (const auto answer = passes_through_disc_filtered(a, b, c, p, q)) return *answer;
  return passes_through_disc<CGAL::Exact_rational>(a, b, c, p, q);
}

}  // namespace thalweg
