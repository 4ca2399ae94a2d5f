#pragma once

/// Points and boxes of the plane, plain values.

#include <algorithm>
#include <compare>
#include <limits>
#include <span>

namespace thalweg {

/// A position in a plane; which plane and which unit, the owner of the point says.
struct Point2 {
  double x = 0;
  double y = 0;
  /// Lexicographic: x, then y. Pre: no NaN.
  constexpr auto operator<=>(const Point2&) const = default;
};

/// Axis-parallel closed box; empty until something is added.
struct Box2 {
  double x_min = std::numeric_limits<double>::infinity();
  double y_min = std::numeric_limits<double>::infinity();
  double x_max = -std::numeric_limits<double>::infinity();
  double y_max = -std::numeric_limits<double>::infinity();

  constexpr void add(Point2 p) {
    x_min = std::min(x_min, p.x);
    y_min = std::min(y_min, p.y);
    x_max = std::max(x_max, p.x);
    y_max = std::max(y_max, p.y);
  }
  [[nodiscard]] constexpr bool empty() const { return x_min > x_max; }
  [[nodiscard]] constexpr bool contains(Point2 p) const {
    return p.x >= x_min && p.x <= x_max && p.y >= y_min && p.y <= y_max;
  }
  [[nodiscard]] constexpr double width() const { return empty() ? 0 : x_max - x_min; }
  [[nodiscard]] constexpr double height() const { return empty() ? 0 : y_max - y_min; }
};

/// Smallest box that holds all points. Complexity: linear.
constexpr Box2 bounding_box(std::span<const Point2> points) {
  Box2 box;
  for (const Point2 p : points) box.add(p);
  return box;
}

}  // namespace thalweg
