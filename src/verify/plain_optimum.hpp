#pragma once

/// Is what is called optimal the optimum? Proved again by a plain solver, where the problem is narrow enough.

#include "verify/plain_terms.hpp"

#include <thalweg/base/progress.hpp>
#include <thalweg/verify/verify.hpp>

#include <span>
#include <vector>

namespace thalweg::verify {

/// One line for each criterion: its bound, given that the criteria before it are at their claimed values.
std::vector<Finding> check_bounds(const PlainProblem& problem, std::span<const CriterionClaim> claims,
                                  Progress& progress);

}  // namespace thalweg::verify
