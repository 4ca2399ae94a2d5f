#pragma once

/// The labelling problem of a TIN and its quadrilaterals.

#include "optimize/edge_terms.hpp"
#include "optimize/plateaus.hpp"

#include <thalweg/optimize/optimize.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace thalweg {

/// As many as there are criteria that are sums over edges, and at least one.
constexpr std::size_t kSums = 1;

struct FirstOrderProblem {
  std::vector<Criterion> sums;  ///< the criteria that are sums over edges, in order of priority
  bool counts_pits = false;
  std::size_t sums_before_pits = 0;  ///< how many of the sums go before local minima

  Labelling<kSums> labelling;  ///< level i is sums[i]; label 1 flips; without links
  std::array<std::int64_t, kSums> delaunay{};
  std::vector<std::uint32_t> rank;  ///< of quadrilaterals, by coordinates alone
  PlateauGraph plateaus;            ///< if pits are counted
};

/// Throws: as optimize_first_order. Complexity: n log n, on all threads.
FirstOrderProblem build_problem(const Tin& tin, std::span<const Quadrilateral> quadrilaterals,
                                const OptimizeOptions& options, Progress& progress);

}  // namespace thalweg
