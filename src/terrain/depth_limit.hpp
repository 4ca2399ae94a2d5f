#pragma once

/// Limits of depths and changes, as they are written.

#include <algorithm>
#include <cmath>
#include <limits>

namespace thalweg {

/// Whether heights a and b are at most `limit` apart, but for what rounding does to decimals: 1.1 and 1.0 are
/// not more than 0.1 apart, though the difference of the doubles is. Nothing is let off a limit of 0. `unit`:
/// of the heights, in that of the limit.
inline bool apart_at_most(double a, double b, double limit, double unit = 1) {
  const double size = std::max(std::abs(a), std::abs(b));
  const double rounding = limit > 0 ? 2 * std::numeric_limits<double>::epsilon() * size * unit : 0;
  return std::abs(a - b) * unit <= limit + rounding;
}

}  // namespace thalweg
