#pragma once

/// Pits at higher orders as a question of connectivity: which free edges drain which plateaus.

#include "base/union_find.hpp"

#include <thalweg/mesh/tin.hpp>
#include <thalweg/order/fixed_faces.hpp>

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

namespace thalweg {

/// Two nodes that a free edge joins: a plateau, and the one that it touches, or node 0.
using PlateauLink = std::pair<std::uint32_t, std::uint32_t>;  ///< first > second

/// The plateaus that fixed edges leave without outlet; node 0 is all that fixed edges drain.
struct PlateauNodes {
  std::uint32_t node_count = 1;
  UnionFind sets{0};              ///< of nodes
  std::vector<PlateauLink> link;  ///< by candidate edge; (0, 0) where it is fixed or of no use

  /// Lets each link be between sets, or (0, 0) where these are the same.
  void follow_sets() {
    for (PlateauLink& here : link) {
      const std::uint32_t a = sets.find(here.first), b = sets.find(here.second);
      here = a == b ? PlateauLink{0, 0} : PlateauLink{std::max(a, b), std::min(a, b)};
    }
  }
};

/// Complexity: near-linear.
PlateauNodes find_plateau_nodes(const Tin& tin, const FixedFaces& faces);

/// Interior pits of a TIN. Complexity: near-linear.
std::size_t count_pits(const Tin& tin);

}  // namespace thalweg
