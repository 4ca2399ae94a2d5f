#pragma once

/// The last levels of every problem: fewest flips, then the tie rule.

#include "optimize/cost.hpp"

#include <thalweg/base/progress.hpp>
#include <thalweg/mesh/tin.hpp>
#include <thalweg/order/quadrilaterals.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace thalweg {

/// What the tie rule charges for the thing of a rank, of which there are `count`; no sum of different ones
/// overflows.
std::int64_t tie_of(std::uint64_t rank, std::size_t count);

/// Adds to each unary cost one flip, and a number that makes the optimum unique.
///
/// The tie rule: quadrilaterals are ranked by their sorted corners (x, then y), which no translation,
/// renumbering or reordering changes; a flip costs tie_of(rank): splitmix64(rank), cut to so many bits that
/// no sum overflows. Two different labellings that agree in everything before agree in that sum by chance
/// only (40 bits at a million quadrilaterals). Returns the ranks. Complexity: n log n, on all threads.
template <std::size_t Criteria>
std::vector<std::uint32_t> add_flips_and_ties(const Tin& tin, std::span<const Quadrilateral> quadrilaterals,
                                              std::vector<Cost<Criteria>>& unary, const Progress& progress);

}  // namespace thalweg
