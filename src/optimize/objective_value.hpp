#pragma once

/// What a TIN is worth in an objective.

#include "optimize/normal_angle.hpp"
#include "optimize/sums.hpp"

#include <thalweg/mesh/tin.hpp>

namespace thalweg {

/// In steps, sign turned where it is maximised; pits are counted. `reference` may be null if nothing is
/// measured against one. Throws: as add_objective. Complexity: linear, on all threads.
WideSteps value_on(const Tin& tin, const Objective& objective, Scale scale, const Reference* reference,
                   const Progress& progress);

/// Such a value, or a bound of it, as reports have it.
double in_units(WideSteps steps, const Objective& objective);

}  // namespace thalweg
