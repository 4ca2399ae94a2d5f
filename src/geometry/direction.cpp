// The exact stage, behind the inline filter. Where the differences of coordinates are exact doubles, the two
// products are compared by their rounded values first, for rounding never reverses an order, and where these
// are equal by what rounding took off, which is a double, too. The rest is for rationals.
#include "geometry/exact_difference.hpp"

#include <thalweg/geometry/direction.hpp>

#include <CGAL/Exact_rational.h>

#include <optional>

namespace thalweg::detail {

namespace {

std::optional<double> exact_difference(double a, double b) {
  const double difference = a - b;
  return is_exact_difference(a, b, difference) ? std::optional(difference) : std::nullopt;
}

// None where an error may lie below what doubles hold.
std::optional<int> compare_products(double a, double b, double c, double d) {
  constexpr double kNoUnderflow = 1e-200;
  const double left = a * b, right = c * d;
  if (left != right) return left > right ? 1 : -1;
  const bool zero = (a == 0 || b == 0) && (c == 0 || d == 0);
  if (zero) return 0;
  if (std::abs(left) < kNoUnderflow) return std::nullopt;
  const double left_error = std::fma(a, b, -left), right_error = std::fma(c, d, -right);
  return left_error == right_error ? 0 : left_error > right_error ? 1 : -1;
}

int turn_in_rationals(Direction2 one, Direction2 other) {
  using Number = CGAL::Exact_rational;
  const Number left = (Number(one.to.x) - Number(one.from.x)) * (Number(other.to.y) - Number(other.from.y));
  const Number right = (Number(one.to.y) - Number(one.from.y)) * (Number(other.to.x) - Number(other.from.x));
  return left > right ? 1 : left < right ? -1 : 0;
}

}  // namespace

int turn_exact(Direction2 one, Direction2 other) {
  const auto one_x = exact_difference(one.to.x, one.from.x), one_y = exact_difference(one.to.y, one.from.y);
  const auto other_x = exact_difference(other.to.x, other.from.x);
  const auto other_y = exact_difference(other.to.y, other.from.y);
  if (one_x && one_y && other_x && other_y) {
    if (const auto sign = compare_products(*one_x, *other_y, *one_y, *other_x)) return *sign;
  }
  return turn_in_rationals(one, other);
}

}  // namespace thalweg::detail
