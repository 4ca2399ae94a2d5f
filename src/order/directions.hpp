#pragma once

/// Directions in the plane, compared and turned in rounded arithmetic.

#include <cmath>

namespace thalweg::detail {

struct Direction {
  double x = 0, y = 0;
  bool operator==(const Direction&) const = default;
};

inline double diamond_angle(double x, double y) {
  const double share = x / (std::abs(x) + std::abs(y));
  return y >= 0 ? 1 - share : 3 + share;
}

// From one direction counter-clockwise to another, in [0, 4).
inline double turn_between(double from, double to) {
  const double turn = to - from;
  return turn < 0 ? turn + 4 : turn;
}

inline double normal(double angle) {
  if (angle < 0) return angle + 4;
  return angle >= 4 ? angle - 4 : angle;
}

inline double dot(Direction a, Direction b) {
  return a.x * b.x + a.y * b.y;
}
inline double length(Direction a) {
  return std::sqrt(dot(a, a));
}
inline Direction turned(Direction a, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * a.x - s * a.y, s * a.x + c * a.y};
}
inline Direction scaled(Direction a, double factor) {
  return {a.x * factor, a.y * factor};
}

}  // namespace thalweg::detail
