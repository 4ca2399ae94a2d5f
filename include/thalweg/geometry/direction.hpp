#pragma once

/// Which way one direction turns from another, exactly.
///
/// Law: the answer is that of exact real arithmetic on the given doubles. Pre: coordinates are finite and
/// less than 1e100 in magnitude.

#include <thalweg/geometry/predicates.hpp>

#include <cmath>

namespace thalweg {

/// A vector that is given by two points.
struct Direction2 {
  Point2 from;
  Point2 to;
};

namespace detail {
int turn_exact(Direction2 one, Direction2 other);
}

/// +1 if `other` turns from `one` counter-clockwise by less than half a turn, -1 if clockwise, 0 if they are
/// parallel. (The filter's bound is that of orientation: two products of two differences.)
inline int turn(Direction2 one, Direction2 other) {
  const double left = (one.to.x - one.from.x) * (other.to.y - other.from.y);
  const double right = (one.to.y - one.from.y) * (other.to.x - other.from.x);
  const int sign = detail::with_doubt(left - right, std::abs(left) + std::abs(right), 3, 16, 1e-280).sign();
  return sign != kUndecided ? sign : detail::turn_exact(one, other);
}

}  // namespace thalweg
