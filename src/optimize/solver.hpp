#pragma once

/// Solves a labelling problem: exactly where it is narrow, else with a bound.

#include "optimize/decomposition.hpp"

namespace thalweg {

struct SolverLimits {
  std::uint32_t width = 18;
  std::uint64_t effort = 0;  ///< table entries for all that is wider, in proportion to the size of pieces
};

/// Arguments and promises as for `decompose`. `known` is empty, or a labelling where pieces that are too wide
/// may start.
template <std::size_t Criteria>
Solution<Criteria> solve(const Labelling<Criteria>& problem, const SolverLimits& limits,
                         const Progress& progress, std::span<const Label> known = {});

}  // namespace thalweg
