#pragma once

/// Where water cannot leave a TIN along its edges.

#include <thalweg/mesh/tin.hpp>

#include <cstdint>
#include <vector>

namespace thalweg {

/// What a vertex is part of; the values are those of `is_pit` in written layers.
enum class PitKind : std::uint8_t {
  None = 0,
  Interior = 1,  ///< a pit
  Boundary = 2,  ///< a pit but for a vertex on the boundary: an outlet
  Lake = 3       ///< a pit that holds an edge of kind Lake
};

/// The pits of a TIN, counted and marked.
struct PitSummary {
  std::size_t interior = 0;
  std::size_t boundary = 0;
  std::size_t lake = 0;
  std::vector<std::uint8_t> is_pit;  ///< for each vertex: a PitKind
};

/// Finds the pits: a pit is a maximal set of vertices of equal height, connected by edges of the TIN, none of
/// which has a lower neighbour. It is a boundary pit if one of its vertices is on the rim (outer, of a hole,
/// of dropped triangles); else a lake if one of its edges is of kind Lake; else interior. Vertices in no
/// triangle are no pits. Pre: heights are not NaN. Complexity: linear; the first of two passes runs on all
/// threads.
PitSummary find_pits(const Tin& tin);

}  // namespace thalweg
