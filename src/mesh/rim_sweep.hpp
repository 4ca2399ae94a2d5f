#pragma once

/// Whether triangles overlap, told from their rim alone.

#include <thalweg/base/id.hpp>
#include <thalweg/geometry/point.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace thalweg {

/// An edge with the surface on one side, to the left of the way from `from` to `to`.
struct RimEdge {
  VertexId from;
  VertexId to;
  bool operator==(const RimEdge&) const = default;
};

/// What a sweep over the rim found.
struct RimFinding {
  enum class Kind : std::uint8_t {
    SamePosition,     ///< vertices a.from and b.from share a position
    VertexOnEdge,     ///< vertex b.from lies within edge a
    VertexOnSurface,  ///< vertex b.from, which is in no triangle, lies on the surface; edge a is the next one
                      ///< above
    EdgesCross,       ///< edges a and b cross
    EdgeOnSurface  ///< edge a lies on triangles that are not its own; edge b is the next one above or below
  };
  Kind kind = Kind::SamePosition;
  RimEdge a;
  RimEdge b;
  bool operator==(const RimFinding&) const = default;
};

/// Sweeps the rim. Empty if and only if no two triangles overlap, no rim vertex lies on another's rim edge,
/// the given isolated vertices lie off the surface, and all these vertices have positions of their own. Pre:
/// all triangles of the surface are counter-clockwise and no two lie on the same side of an edge; positions
/// finite. Complexity: r log r for r edges and isolated vertices.
std::vector<RimFinding> sweep_rim(std::span<const Point2> xy, std::span<const RimEdge> rim,
                                  std::span<const VertexId> isolated);

}  // namespace thalweg
