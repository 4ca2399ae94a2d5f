#pragma once

/// What bounds the ground on which paths run and points see each other.

#include <cstdint>

namespace thalweg {

enum class GroundMode : std::uint8_t {
  Hull,  ///< the convex hull of all vertices; outside of it paths may run, too
  /// The boundary and holes that were given, else the hull: what lies outside is no ground at all, and edges
  /// of the rim hide what is behind them as constraint edges do.
  Polygon
};

}  // namespace thalweg
