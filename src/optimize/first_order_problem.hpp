#pragma once

/// The labelling problem of a TIN and its quadrilaterals.

#include "optimize/labelling.hpp"
#include "optimize/plateaus.hpp"
#include "optimize/sums.hpp"

#include <thalweg/optimize/optimize.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace thalweg {

template <std::size_t Criteria>
struct FirstOrderProblem {
  /// The objectives in order of priority, but those of pits that come first: they are a condition on links.
  /// The level of an extreme is for the number of terms beyond a limit, that of an objective of pits for what
  /// pit_terms.hpp adds; both are empty at first.
  std::vector<Objective> sums;
  bool pits_first = false;   ///< local minima or depth
  bool depth_first = false;  ///< depth is among them; it is a condition stronger than that of local minima

  Labelling<Criteria> labelling;  ///< level i is sums[i]; label 1 flips; without links
  std::array<WideSteps, Criteria> delaunay{};
  std::vector<std::uint32_t> owner;  ///< the quadrilateral of each triangle, or kNone
  std::size_t quadrilaterals = 0;    ///< which are the first variables
  PlateauGraph plateaus;             ///< if pits are counted
  PlateauGraph spills;               ///< if their depth comes first

  /// What the links have to connect. Pre: pits_first.
  [[nodiscard]] const PlateauGraph& connectivity() const { return depth_first ? spills : plateaus; }
  [[nodiscard]] PlateauGraph& connectivity() { return depth_first ? spills : plateaus; }
};

/// Throws: Error{Usage} for a criterion given twice, a unit that is not positive, a width limit out of range;
/// {SizeLimit} from 2^28 edges on.
void check_options(const Tin& tin, const OptimizeOptions& options);

/// How many criteria at the beginning are of pits.
std::size_t count_leading_pits(std::span<const Objective> criteria);

/// Levels of costs that the criteria need: 1, 2 or 4. Throws: Error{Usage} if that is not enough.
std::size_t count_levels(std::span<const Objective> criteria);

/// Pre: `Criteria` is at least count_levels(options.criteria).
/// Throws: as optimize_first_order. Complexity: n log n, on all threads.
template <std::size_t Criteria>
FirstOrderProblem<Criteria> build_problem(const Tin& tin, std::span<const Quadrilateral> quadrilaterals,
                                          const OptimizeOptions& options, Progress& progress);

/// Calls `run` with the number of levels as a type: run(std::integral_constant<std::size_t, n>).
template <class Run>
auto with_levels(std::span<const Objective> criteria, const Run& run) {
  const std::size_t levels = count_levels(criteria);
  if (levels == 1) return run(std::integral_constant<std::size_t, 1>{});
  if (levels == 2) return run(std::integral_constant<std::size_t, 2>{});
  return run(std::integral_constant<std::size_t, 4>{});
}

}  // namespace thalweg
