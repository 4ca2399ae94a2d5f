#pragma once

/// The circumcircle of one triangle and its open disc, set up once for many questions.

#include <thalweg/geometry/predicates.hpp>

namespace thalweg::detail {

/// A value in double arithmetic, and the sum of the magnitudes of its terms, which bounds its error.
struct Estimate {
  double value = 0;
  double magnitude = 0;
};

class Circumdisc {
 public:
  Circumdisc() = default;
  /// Pre: a, b, c counter-clockwise.
  Circumdisc(Point2 a, Point2 b, Point2 c);

  /// +1 inside, 0 on the circle, -1 outside; exact, never perturbed.
  [[nodiscard]] int side(Point2 p) const { return in_circle(a_, b_, c_, p); }
  /// Whether a point on the circle belongs to the disc by the tie rule. Pre: side(p) == 0, p is no corner.
  [[nodiscard]] bool wins_tie(Point2 p) const { return break_cocircular_tie(a_, b_, c_, p) > 0; }
  /// Whether a point, no corner, is inside or belongs to the disc by the tie rule.
  [[nodiscard]] bool holds(Point2 p) const {
    const int where = side(p);
    return where > 0 || (where == 0 && wins_tie(p));
  }
  /// Whether segment pq meets the open disc. Pre: neither p nor q is strictly inside. Exact.
  [[nodiscard]] bool passes(Point2 p, Point2 q) const;
  /// A box that holds the closed disc; the whole plane where arithmetic does not bound it.
  [[nodiscard]] Box2 box() const;

 private:
  Point2 a_, b_, c_;
  Estimate twice_area_;  ///< doubled cross product of b - a and c - a: the common denominator
  Estimate u_, v_;       ///< the centre relative to a, times the denominator
  Estimate radius_;      ///< the squared radius, times the squared denominator
};

}  // namespace thalweg::detail
