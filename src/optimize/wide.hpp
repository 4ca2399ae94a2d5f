#pragma once

/// A good labelling and a bound for a problem that is too wide to be solved.

#include "optimize/decomposition.hpp"

namespace thalweg {

/// `known` is empty, or a labelling to start from. `first_level_bound`: a known bound of the first level.
/// Pre: the problem has weights or tables. Complexity: O(effort) table entries, at least a few rounds. The
/// result depends on nothing but the arguments.
template <std::size_t Criteria>
Solution<Criteria> bracket(const Labelling<Criteria>& problem, std::span<const Label> known,
                           std::int64_t first_level_bound, std::uint32_t width_limit, std::uint64_t effort,
                           const Progress& progress);

/// The lowest that a level can be, whatever the labels.
template <std::size_t Criteria>
std::int64_t least_of_level(const Labelling<Criteria>& problem, std::size_t level);

}  // namespace thalweg
