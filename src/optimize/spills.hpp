#pragma once

/// Depths of pits as a question of connectivity: which diagonals lower which spills.

#include "optimize/pit_terms.hpp"
#include "optimize/plateaus.hpp"
#include "optimize/sums.hpp"

#include <thalweg/base/progress.hpp>
#include <thalweg/mesh/tin.hpp>
#include <thalweg/order/quadrilaterals.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace thalweg {

/// What connects what, height by height: the nodes are sets of vertices up to some height that edges of all
/// labellings up to it connect. A labelling has the least depth of pits if its links connect all that the
/// links together can; then every spill is as low as it can be, pits are fewest, and on every vertex water
/// stands as low as it can when all pits are full.
/// Complexity: sorting edges by height.
PlateauGraph find_spills(const Tin& tin, std::span<const Quadrilateral> quadrilaterals,
                         std::span<const std::uint32_t> owner, const Progress& progress);

/// The sum of the depths of pits, in steps of 2^-32 m, if each quadrilateral has its label; label Open: as if
/// it had both. Heights are rounded once. Throws: Error{SizeLimit} if a height is beyond 2^30 m.
/// Complexity: sorting edges by height.
WideSteps pit_depth_of(const Tin& tin, std::span<const Quadrilateral> quadrilaterals,
                       std::span<const Label> labels, double metres_per_unit, const Progress& progress);

/// The depths as counts: between two heights, so many metres apart, each set that no link leaves costs as
/// many. Together at most the depth, and all of it but where more than 16 links hang together.
struct DepthTerms {
  PitTerms terms;
  WideSteps constant = 0;  ///< steps that no link changes
};
DepthTerms find_depth_terms(const Tin& tin, std::span<const Quadrilateral> quadrilaterals,
                            std::span<const std::uint32_t> owner, double metres_per_unit,
                            std::span<const std::int64_t> tie, const Progress& progress);

}  // namespace thalweg
