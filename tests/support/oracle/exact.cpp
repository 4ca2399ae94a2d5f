// Exact predicates in 128-bit integers.
//
// 1. The power of d is the height of its lift above the plane through the lifts of a, b, c; in barycentric
//    coordinates of d that is a combination of four lifts whose coefficients are orientations.
// 2. Symbolic perturbation: where that combination is zero, the coefficient of the largest site decides.
// 3. Along pq, parametrised by s in [0, 1], the power is the quadratic |pq|^2 s^2 + linear + constant, which
//    the powers at the two ends determine; with both ends outside it is negative somewhere if and only if its
//    vertex lies strictly between them and its discriminant is positive.
#include <support/oracle/exact.hpp>

#include <algorithm>
#include <array>
#include <utility>

namespace thalweg::oracle {

namespace {

Wide lift(Site s) {
  return Wide{s.x} * s.x + Wide{s.y} * s.y;
}

// Each site with the coefficient of its lift in power().
std::array<std::pair<Site, std::int64_t>, 4> lift_coefficients(Site a, Site b, Site c, Site d) {
  return {{{d, turn(a, b, c)}, {a, -turn(d, b, c)}, {b, -turn(a, d, c)}, {c, -turn(a, b, d)}}};
}

}  // namespace

int turn_sign(const Spot& a, const Spot& b, const Spot& c) {
  return sign_of(a.x * (b.y * c.w - c.y * b.w) - a.y * (b.x * c.w - c.x * b.w) +
                 a.w * (b.x * c.y - c.x * b.y));
}

bool on_segment(Site a, Site b, Site x) {
  return turn(a, b, x) == 0 && std::min(a, b) <= x && x <= std::max(a, b);
}

bool inside_segment(Site a, Site b, Site x) {
  return on_segment(a, b, x) && x != a && x != b;
}

bool segments_meet(const Spot& a, const Spot& b, const Spot& c, const Spot& d) {
  const int c_side = turn_sign(a, b, c), d_side = turn_sign(a, b, d);
  const int a_side = turn_sign(c, d, a), b_side = turn_sign(c, d, b);
  if (c_side != 0 || d_side != 0) return c_side * d_side <= 0 && a_side * b_side <= 0;
  const auto less = [](const Spot& p, const Spot& q) {
    const int by_x = sign_of(p.x * q.w - q.x * p.w);
    return by_x != 0 ? by_x < 0 : p.y * q.w < q.y * p.w;
  };
  const auto [low, high] = std::minmax(a, b, less);
  const auto [other_low, other_high] = std::minmax(c, d, less);
  return !less(high, other_low) && !less(other_high, low);
}

Wide power(Site a, Site b, Site c, Site d) {
  Wide sum = 0;
  for (const auto& [site, coefficient] : lift_coefficients(a, b, c, d)) sum += lift(site) * coefficient;
  return sum;
}

bool member_of_circle(Site a, Site b, Site c, Site d) {
  const Wide exact = power(a, b, c, d);
  if (exact != 0) return exact < 0;
  auto coefficients = lift_coefficients(a, b, c, d);
  std::sort(coefficients.rbegin(), coefficients.rend());
  for (const auto& [site, coefficient] : coefficients) {
    if (coefficient != 0) return coefficient < 0;
  }
  return false;
}

bool enters_open_disc(Site a, Site b, Site c, Site p, Site q) {
  const Wide at_p = power(a, b, c, p), at_q = power(a, b, c, q);
  if (at_p < 0 || at_q < 0) return true;
  const Wide length = lift({q.x - p.x, q.y - p.y}) * turn(a, b, c);
  const Wide slope = length + at_p - at_q;
  return slope > 0 && slope < 2 * length && slope * slope > 4 * length * at_p;
}

}  // namespace thalweg::oracle
