#pragma once

/// A piece of a line that is straight in its source's coordinates, where x may jump by a period.

#include <thalweg/geometry/point.hpp>

#include <algorithm>
#include <cmath>

namespace thalweg {

/// Takes the short way around the period.
class StraightPiece {
 public:
  /// `x_period` as in DensifyOptions.
  StraightPiece(Point2 low, Point2 high, double x_period) : low_(low), high_(high) {
    if (!(x_period > 0 && std::abs(high.x - low.x) > x_period / 2)) return;
    high_.x = low.x + std::remainder(high.x - low.x, x_period);
    period_ = x_period;
    seam_ = std::max(low.x, high.x) <= x_period / 2 ? x_period / 2 : x_period;
  }
  /// At t of the way from `low`, as a source would write it.
  [[nodiscard]] Point2 at(double t) const {
    const Point2 p = {low_.x + t * (high_.x - low_.x), low_.y + t * (high_.y - low_.y)};
    if (period_ == 0) return p;
    if (p.x > seam_) return {p.x - period_, p.y};
    if (p.x < seam_ - period_) return {p.x + period_, p.y};
    return p;
  }
  /// The ends without a jump between them.
  [[nodiscard]] Point2 low() const { return low_; }
  [[nodiscard]] Point2 high() const { return high_; }

 private:
  Point2 low_, high_;
  double period_ = 0;  ///< 0: it does not jump
  double seam_ = 0;
};

/// At t of the way from z_a to z_b: exactly the common height where both are equal, never outside of their
/// range.
inline double height_between(double z_a, double z_b, double t) {
  if (z_a == z_b) return z_a;
  return std::clamp(std::lerp(z_a, z_b, t), std::min(z_a, z_b), std::max(z_a, z_b));
}

}  // namespace thalweg
