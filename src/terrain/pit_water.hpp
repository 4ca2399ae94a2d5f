#pragma once

/// The water in pits that are full.

#include "terrain/flow_graph.hpp"

#include <thalweg/base/progress.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace thalweg {

/// In the units of the TIN.
struct Water {
  double area = 0;
  double volume = 0;
};

/// Basins by number; that of number 0 is the outside, which holds no water.
struct Basins {
  std::span<const std::uint32_t> of_vertex;
  /// Up to where the pit in it fills; those that it has met before are under the same water. Of the outside:
  /// less than all heights.
  std::span<const double> level;
  std::span<const double> fill_level;     ///< of the last pit into which its pit spills, if not its own
  std::span<const std::uint32_t> met_by;  ///< the basin into which its pit spills
};

/// The water in each. Complexity: linear in triangles and, for each of them, in the pits that it is part of;
/// on all threads.
std::vector<Water> measure_water(const FlowGraph& graph, const Basins& basins, Progress& progress);

}  // namespace thalweg
