#pragma once

/// Objectives that are sums over triangles and interior edges, as costs of labels.

#include "optimize/labelling.hpp"
#include "optimize/term_scan.hpp"

#include <thalweg/base/progress.hpp>
#include <thalweg/optimize/criterion.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace thalweg {

/// Sums of many terms in steps: beyond 64 bits.
__extension__ using WideSteps = __int128;

/// Adds the objective to one level of unary costs and weights, maximised ones with their sign turned. Returns
/// the level's value on the given TIN. Pre: the labelling has its rows.
/// Throws: Error{SizeLimit} if sums of the level could overflow. Complexity: linear, on all threads.
template <std::size_t Criteria>
WideSteps add_objective(const TermScan& scan, const Objective& objective, std::size_t level,
                        Labelling<Criteria>& labelling, const Progress& progress);

/// An objective that is the worst of its terms, in steps, signs turned where it is maximised: less is better.
struct Extreme {
  std::int64_t delaunay = 0;  ///< of the given TIN
  /// What the value may be, ascending; the first is a bound that each term alone gives.
  std::vector<std::int64_t> values;
};
Extreme find_extreme(const TermScan& scan, const Objective& objective, std::span<const std::uint32_t> first,
                     const Progress& progress);

/// Its value under labels. Pre: none is Open.
std::int64_t extreme_of(const TermScan& scan, const Objective& objective,
                        std::span<const std::uint32_t> first, std::span<const Label> label,
                        const Progress& progress);

/// Puts into one level of costs, which is emptied first, the number of terms that are worse than `most`.
/// Returns how many no label changes and how many label 0 everywhere has: the constant of the level.
template <std::size_t Criteria>
std::int64_t count_excess(const TermScan& scan, const Objective& objective, std::int64_t most,
                          std::size_t level, Labelling<Criteria>& labelling, const Progress& progress);

}  // namespace thalweg
