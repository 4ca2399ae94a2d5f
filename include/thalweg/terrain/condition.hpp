#pragma once

/// Heights changed as little as possible so that water runs: drawn valleys that do not rise, no pits.

#include <thalweg/base/progress.hpp>
#include <thalweg/mesh/tin.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace thalweg {

enum class ConditionStep : std::uint8_t { MonotoneValleys, Fill, Breach };

/// What is least in drawn valleys: the sum of the changes, or of their squares.
enum class ChangeNorm : std::uint8_t { Sum, Squares };

struct ConditionOptions {
  /// Valleys come first, then pits, whatever the order here. With Fill and Breach each pit gets the one that
  /// changes less, unless one of them for all pits changes less together.
  std::vector<ConditionStep> steps;
  ChangeNorm norm = ChangeNorm::Sum;
  /// No height changes by more, in the TIN's unit: what would need more is left as it is.
  std::optional<double> max_change;
};

struct HeightChange {
  VertexId vertex;
  double before = 0;  ///< in the TIN's unit
  double after = 0;
  ConditionStep step = ConditionStep::Fill;  ///< the last that changed it
};

struct ConditionResult {
  std::vector<double> heights;        ///< by vertex, in the TIN's unit
  std::vector<HeightChange> changes;  ///< by vertex; all others have the very heights that they had
  std::size_t filled = 0;             ///< pits
  std::size_t breached = 0;
  std::size_t left = 0;  ///< pits that need more than the largest change
};

/// Conditions the heights of a TIN; triangles stay.
///
/// Valleys: drawn valley edges run downstream as `Consistency` says, and no vertex of one may be lower than
/// the next; all vertices of a lake keep one height; a line whose level ends part while heights change runs
/// as they then do. Sum: the least sum of changes; Squares: the least sum of squares, within rounding (1e-12
/// of the heights' range). Fill: raises a pit to the lowest height at which its plateau drains. Breach:
/// lowers a way along edges to the height of the pit's bottom, until the ground is lower or leaves the TIN;
/// of all such ways the one that changes least. Pits from the highest bottom to the lowest. Water leaves at
/// the rim, at `outlets`, and into lakes; no vertex of a lake is lowered.
///
/// Laws: (1) without a largest change no drawn valley rises after MonotoneValleys, and after Fill or Breach
/// too if asked for together; (2) without one, after Fill or Breach no interior pit is left but at outlets;
/// where lakes or valleys close all ways of a breach that is asked for alone, the pit is left; (3) Fill
/// alone is the flood: the least, over all ways to a way out, of the greatest height; (4) with Fill and
/// Breach the sum of changes is at most that of the flood, and that of Breach alone if that leaves no pit.
/// Throws: Error{Cancelled}. Complexity: n log n, plus for each pit the vertices that it floods or searches;
/// a max-flow for each level at which a pool of a valley is split.
ConditionResult condition_heights(const Tin& tin, std::span<const VertexId> outlets,
                                  const ConditionOptions& options, const Progress& progress);

}  // namespace thalweg
