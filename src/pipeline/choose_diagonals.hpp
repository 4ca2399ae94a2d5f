#pragma once

/// From the ground to the chosen triangulation.

#include "pipeline/surface.hpp"

#include <thalweg/optimize/optimize.hpp>
#include <thalweg/terrain/condition.hpp>

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace thalweg {

/// The optimised TIN and what it came from.
struct Labelled {
  Tin delaunay;
  std::vector<Triangle> of_order_1;  ///< its triangles that have that order, sorted; others have 0
  std::vector<Quadrilateral> quadrilaterals;
  std::unique_ptr<const Reference> reference;
  OptimizeOptions options;
  OptimizeResult result;
  /// Edges of `delaunay` that give way to `new_diagonals`; once they have done so, these, in `tin`.
  std::vector<HalfedgeId> flips;
  Tin tin;  ///< above order 1; else it follows from the flips
  std::vector<std::array<VertexId, 2>> new_diagonals;
  std::optional<ReportHigherOrder> higher_order;
  std::vector<std::uint16_t> orders;  ///< by triangle, above order 1; else they follow from the new diagonals
  std::size_t barred = 0;             ///< quadrilaterals whose other diagonal is too far from points left out
  std::vector<HeightChange> changes;  ///< of conditioning: `delaunay` and `tin` have the new heights
  std::optional<ConditionReport> conditioned;
};

/// Finds what may be chosen from, conditions heights if asked to, and optimises. Takes the ground out of the
/// terrain. Throws: Error.
Labelled choose_diagonals(Terrain& terrain, const RunContext& run, PhaseSeconds& seconds, Progress& progress);

}  // namespace thalweg
