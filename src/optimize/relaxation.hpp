#pragma once

/// A lower bound for a problem too wide to be solved, from a narrow one in which some variables stand several
/// times.

#include "optimize/bucket_elimination.hpp"
#include "optimize/cuts.hpp"
#include "optimize/labelling.hpp"

#include <thalweg/base/progress.hpp>

#include <cstdint>
#include <vector>

namespace thalweg {

template <std::size_t Criteria>
struct Relaxed {
  Cost<Criteria> bound;      ///< no labelling that connects what can be connected costs less
  std::vector<Label> label;  ///< of the best bound; copies of a variable vote
};

/// `upper` is the cost of a known labelling; `effort` counts table entries, and the first round is always
/// done. Complexity: O(effort). The result does not depend on anything but the arguments.
template <std::size_t Criteria>
Relaxed<Criteria> relax(const Labelling<Criteria>& problem, const Cost<Criteria>& upper,
                        std::uint32_t width_limit, std::uint64_t effort, const Progress& progress);

}  // namespace thalweg
