#pragma once

/// Plateaus: which are pits, and how water leaves the others.

#include <thalweg/base/progress.hpp>
#include <thalweg/mesh/tin.hpp>
#include <thalweg/terrain/pits.hpp>

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace thalweg {

constexpr std::uint32_t kNoPit = std::numeric_limits<std::uint32_t>::max();

/// A pit as a plateau: see find_pits.
struct PitSite {
  VertexId vertex;  ///< the vertex of the plateau that comes first by (x, y)
  PitKind kind = PitKind::Interior;
  std::uint32_t vertices = 1;
};

/// What becomes of water at each vertex before slopes are looked at.
///
/// Laws: (1) a vertex is in exactly one of three states: it has a lower neighbour or is an outlet; it is in a
/// pit; or `toward` leads, over a level edge, to a vertex of smaller rank. (2) A plateau that holds a given
/// outlet is no pit.
struct Flats {
  std::vector<std::uint32_t> rank;  ///< level edges to go until a vertex that is lower or an outlet; else 0
  std::vector<VertexId> toward;     ///< of vertices with rank > 0: the next on the way, first by (x, y)
  std::vector<std::uint32_t> pit;   ///< index in `pits`, or kNoPit
  std::vector<PitSite> pits;        ///< boundary pits too; by the smallest vertex id in them
  std::vector<std::uint8_t> on_rim;
};

/// Pre: heights are finite. Complexity: linear; the first pass runs on all threads.
Flats resolve_flats(const Tin& tin, std::span<const VertexId> outlets, const Progress& progress);

}  // namespace thalweg
