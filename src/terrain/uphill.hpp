#pragma once

/// How lines of flow run through a triangle that is not level: see flow_graph.cpp.

#include <algorithm>

namespace thalweg {

/// Lines of flow through a triangle, upwards: shares of an Out side in (from, to), along its twin, become
/// shares of an In side in [begin, end], along itself.
struct Uphill {
  double from, to, begin, end;
  [[nodiscard]] double operator()(double share) const {
    return std::clamp(begin + (share - from) * ((end - begin) / (to - from)), begin, end);
  }
  /// The two sides of a corner that is low, beyond which the split side lies ...
  static Uphill before_corner(double at) { return {0, 1, 0, at}; }
  static Uphill after_corner(double at) { return {0, 1, at, 1}; }
  /// ... and those of a split Out side, to the sides after and before it; `top`: where its corner is.
  static Uphill below_top(double top) { return {0, top, 0, 1}; }
  static Uphill above_top(double top) { return {top, 1, 0, 1}; }
};

}  // namespace thalweg
