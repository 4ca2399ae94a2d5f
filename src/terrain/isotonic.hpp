#pragma once

/// Isotonic regression on a directed graph.

#include <thalweg/terrain/condition.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace thalweg {

/// The value at `above` may not be less than that at `below`.
struct DownArc {
  std::uint32_t above = 0;
  std::uint32_t below = 0;
};

/// The values that obey all arcs and differ least from `values`; the arcs hold exactly. Sum: each result is
/// one of `values`. On a cycle of arcs all are equal. Pre: finite values. Complexity: a max-flow over what is
/// left of a block, for each of its splits.
std::vector<double> regress_isotonic(std::span<const double> values, std::span<const DownArc> arcs,
                                     ChangeNorm norm);

}  // namespace thalweg
