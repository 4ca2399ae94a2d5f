#pragma once

/// Is what is called optimal the optimum? Proved again by a plain solver, where the problem is narrow enough.

#include "verify/plain_terms.hpp"

#include <thalweg/base/progress.hpp>
#include <thalweg/verify/verify.hpp>

#include <span>
#include <vector>

namespace thalweg::verify {

/// One line for each criterion: its bound, given that the criteria before it are at their claimed values. By
/// the steps of the proof, which is null or fits the problem, where it has any; else by the plain solver.
std::vector<Finding> check_bounds(const PlainProblem& problem, std::span<const CriterionClaim> claims,
                                  const Proof* proof, Progress& progress);

}  // namespace thalweg::verify
