#pragma once

/// Labels and a bound from a maximum flow.

#include "optimize/labelling.hpp"

#include <thalweg/base/progress.hpp>

#include <vector>

namespace thalweg {

struct RoofDual {
  std::vector<Label> label;  ///< every optimum of the problem has these labels; Open: not known
  std::int64_t bound = 0;    ///< no labelling has less at the first level
};

/// Looks at the first level of costs alone, so that what is fixed may not cut off the best of lower levels:
/// only labels whose change costs something at the first level are kept; and only such that no link is lost
/// that may be needed. Where tables reach the first level it finds nothing. Complexity: a maximum flow with 2
/// n + 2 nodes.
template <std::size_t Criteria>
RoofDual find_roof_dual(const Labelling<Criteria>& problem, const Progress& progress);

}  // namespace thalweg
