#pragma once

/// Least cost of a choice between two labels for each of many variables: dominance, then elimination.

#include "verify/factor_sum.hpp"

#include <thalweg/base/progress.hpp>

#include <optional>
#include <vector>

namespace thalweg::verify {

struct PlainOptimum {
  Cost cost{};
  std::vector<bool> labels;
};

/// The least sum of all factors, and labels that reach it; none if a table would depend on more than
/// `width_limit` variables, or all tables together would take more than 1.6 GB. Throws: Error{Cancelled}.
std::optional<PlainOptimum> minimise(std::size_t variables, std::vector<Factor> factors,
                                     std::size_t width_limit, Progress& progress);

}  // namespace thalweg::verify
