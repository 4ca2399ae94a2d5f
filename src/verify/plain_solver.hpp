#pragma once

/// Least cost of a choice between two labels for each of many variables: dominance, then elimination.

#include "verify/plain_mesh.hpp"

#include <thalweg/base/progress.hpp>

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace thalweg::verify {

/// Compared lexicographically, added component by component.
using Cost = std::array<std::int64_t, 4>;

/// A cost that depends on few variables.
struct Factor {
  std::vector<Index> scope;  ///< ascending
  std::vector<Cost> table;   ///< bit i of the index is the label of scope[i]
};

struct PlainOptimum {
  Cost cost{};
  std::vector<bool> labels;
};

/// The least sum of all factors, and labels that reach it; none if a table would depend on more than
/// `width_limit` variables. Throws: Error{Cancelled}.
std::optional<PlainOptimum> minimise(std::size_t variables, std::vector<Factor> factors,
                                     std::size_t width_limit, Progress& progress);

}  // namespace thalweg::verify
