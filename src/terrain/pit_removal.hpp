#pragma once

/// Pits raised to where they spill or drained by a cut.

#include "terrain/isotonic.hpp"

#include <thalweg/terrain/condition.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace thalweg {

struct PitRemoval {
  std::vector<double> heights;
  std::vector<std::uint8_t> touched;  ///< by vertex: 0, or 1 + the step that changed it last
  std::size_t filled = 0;
  std::size_t breached = 0;
  std::size_t left = 0;
};

struct PitRules {
  bool fill = false;
  bool breach = false;
  double max_change = 0;             ///< against `original`; infinity: none
  std::span<const double> original;  ///< heights from which changes are counted
  std::span<const DownArc> valleys;  ///< arcs between vertices that shall go on to hold
};

/// Removes the interior pits of a TIN as `condition_heights` says. Throws: Error{Cancelled}.
PitRemoval remove_pits(const Tin& tin, std::span<const VertexId> outlets, const PitRules& rules,
                       const Progress& progress);

}  // namespace thalweg
