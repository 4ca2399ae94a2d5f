#pragma once

/// Plateaus: which are pits, and how water leaves the others.

#include "base/large_pages.hpp"
#include "terrain/flow_mesh.hpp"

#include <thalweg/base/progress.hpp>
#include <thalweg/terrain/pits.hpp>

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace thalweg {

constexpr std::uint32_t kNoPit = std::numeric_limits<std::uint32_t>::max();

/// In place of a squared slope, at a vertex without a lower neighbour: of the way to one that is level, or,
/// if all are higher, to one of them.
constexpr double kLevel = -1, kRises = -2;

/// Where a vertex sends its water.
struct VertexStep {
  enum class Kind : std::uint8_t {
    Stay,   ///< a pit or a given outlet, or in no triangle
    Leave,  ///< over the rim, at the vertex itself
    Edge,   ///< along `edge` to its other end
    Cross   ///< across a triangle, to `edge`, its side opposite of the vertex
  };
  double squared_slope = -3;  ///< of a vertex without a lower neighbour kLevel or kRises, or no matter
  HalfedgeId edge;            ///< if it stays: any that starts at it; invalid in no triangle
  Kind kind = Kind::Stay;
};

/// A pit as a plateau: see find_pits.
struct PitSite {
  VertexId vertex;  ///< the vertex of the plateau that comes first by (x, y)
  PitKind kind = PitKind::Interior;
  std::uint32_t vertices = 1;
};

/// What becomes of water at vertices that have no lower neighbour.
///
/// Laws: (1) a vertex in a triangle is in exactly one of three states: it has a lower neighbour or is an
/// outlet; it is in a pit; or its step leads, over a level edge, to a vertex of smaller rank. (2) A plateau
/// that holds a given outlet is no pit.
struct Flats {
  LargeVector<std::uint32_t> rank;  ///< level edges to go until a vertex that is lower or an outlet; else 0
  LargeVector<std::uint32_t> pit;   ///< index in `pits`, or kNoPit
  std::vector<PitSite> pits;        ///< boundary pits too; by the vertex in them that the TIN numbers first
  LargeVector<std::uint8_t> on_rim;
};

/// `rim`: halfedges without twin. `steps`: as find_falls found them, outlets Stay; those of vertices on
/// plateaus, each to the next on the way, the first by (x, y), are added. Pre: heights are finite.
/// Complexity: linear.
Flats resolve_flats(const FlowMesh& mesh, std::span<const VertexId> outlets, std::span<const HalfedgeId> rim,
                    std::span<VertexStep> steps, const Progress& progress);

}  // namespace thalweg
