#pragma once

/// Objectives that are sums over triangles and interior edges, as costs of labels.

#include "optimize/labelling.hpp"
#include "optimize/term_scan.hpp"

#include <thalweg/base/progress.hpp>
#include <thalweg/optimize/criterion.hpp>

namespace thalweg {

/// Sums of many terms in steps: beyond 64 bits.
__extension__ using WideSteps = __int128;

/// Adds the objective to one level of unary costs and weights, maximised ones with their sign turned. Returns
/// the level's value on the given TIN. Pre: the labelling has its rows.
/// Throws: Error{SizeLimit} if sums of the level could overflow. Complexity: linear, on all threads.
template <std::size_t Criteria>
WideSteps add_objective(const TermScan& scan, const Objective& objective, std::size_t level,
                        Labelling<Criteria>& labelling, const Progress& progress);

}  // namespace thalweg
