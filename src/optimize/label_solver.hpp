#pragma once

/// Solves a network of variables with many labels: exactly where it is narrow, else with a bound.

#include "optimize/label_network.hpp"
#include "optimize/solver.hpp"

#include <thalweg/base/progress.hpp>

#include <vector>

namespace thalweg {

template <std::size_t Criteria>
struct NetworkSolution {
  std::vector<std::uint32_t> chosen;  ///< labels, counted from each variable's first one
  Cost<Criteria> value;               ///< of the choice
  Cost<Criteria> bound;               ///< no choice costs less
  SolverFigures figures;
};

/// `limits.width`: the largest table has 2^width entries. The result does not depend on the number of
/// threads. Complexity: linear but for wide pieces; runs on all threads.
template <std::size_t Criteria>
NetworkSolution<Criteria> solve(const LabelNetwork<Criteria>& network, const SolverLimits& limits,
                                const Progress& progress);

}  // namespace thalweg
