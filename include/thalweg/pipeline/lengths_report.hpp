#pragma once

/// What a report says of the rim and of constraint edges.

#include <array>

namespace thalweg {

/// Lengths of edges in metres.
struct ReportLengths {
  double rim_m = 0;  ///< holes and dropped triangles included
  /// Constraint edges of kind breakline, ridge, valley, boundary, hole, lake; one of several kinds counts in
  /// each.
  std::array<double, 6> constraint_m{};
};

}  // namespace thalweg
