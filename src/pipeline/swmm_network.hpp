#pragma once

/// The drainage network as nodes and conduits.

#include "pipeline/drain_layers.hpp"
#include "pipeline/swmm.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace thalweg {

struct SwmmNode {
  enum class Kind : std::uint8_t { Junction, Outfall, Storage };
  Kind kind = Kind::Junction;
  std::string name;
  FlowPoint at;
  std::optional<std::size_t> pit;  ///< of the table
  double conduits_m = 0;           ///< length of those that end here
};

struct SwmmConduit {
  std::size_t from = 0, to = 0;  ///< nodes
  std::vector<FlowPoint> points;
  double length_m = 0;
  double offset_m = 0;         ///< of its beginning above its node
  double left = 0, right = 0;  ///< slopes of the ground beside it, times length
  double sides_m = 0;          ///< length for which they are known
};

struct SwmmNetwork {
  std::vector<SwmmNode> nodes;
  std::vector<SwmmConduit> conduits;
};

/// As write_swmm says. Linear.
SwmmNetwork find_swmm_network(const LoadedTin& loaded, const SwmmView& view);

}  // namespace thalweg
