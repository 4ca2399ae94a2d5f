#pragma once

/// Pits as a question of connectivity: which diagonals drain which plateaus.

#include "optimize/labelling.hpp"

#include <thalweg/base/progress.hpp>
#include <thalweg/mesh/tin.hpp>
#include <thalweg/order/quadrilaterals.hpp>

#include <span>
#include <vector>

namespace thalweg {

/// The plateaus that fixed edges leave without outlet, and the diagonals that may give them one.
struct PlateauGraph {
  std::vector<Link> link;        ///< by quadrilateral; node 0 is everything that is drained by fixed edges
  std::uint32_t node_count = 1;  ///< plateaus, and node 0
};

/// Complexity: near-linear; all but uniting equal neighbours runs on all threads.
PlateauGraph find_plateaus(const Tin& tin, std::span<const Quadrilateral> quadrilaterals,
                           std::span<const std::uint32_t> owner, const Progress& progress);

/// Number of interior pits if each quadrilateral has its label; label Open: as if it had both.
std::size_t count_pits(const PlateauGraph& graph, std::span<const Label> labels);

}  // namespace thalweg
