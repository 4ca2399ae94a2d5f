#pragma once

/// The grounds that drain to the sinks of a flow, as polygons that tile the TIN.

#include <thalweg/base/progress.hpp>
#include <thalweg/terrain/surface_flow.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace thalweg {

/// A closed ring without its first point repeated; ground to its left: outer rings run counter-clockwise.
/// Points are vertices, or lie on edges (then `z` is not filled).
using CatchmentRing = std::vector<FlowPoint>;

struct CatchmentPolygon {
  CatchmentRing outer;
  std::vector<CatchmentRing> holes;
};

struct Catchment {
  std::uint32_t group = 0;
  std::vector<CatchmentPolygon> polygons;
};

/// The ground of each group of sinks. Borders are ridge edges of the surface, the rim, lines of flow up from
/// corners at which water parts, and edges of level triangles: a triangle across which a divide runs is cut,
/// so every point lies in the catchment in which its path ends. `group_of_sink`: for each sink a number; its
/// catchments are united. Laws: (1) the areas sum to that of the TIN; (2) both sides of a border have the
/// same points. Throws: Error{Cancelled}; Error{SizeLimit} from 2^32 points on edges on. Complexity: linear
/// in triangles and in the edges that borders cross; on all threads.
std::vector<Catchment> outline_catchments(const SurfaceFlow& flow,
                                          std::span<const std::uint32_t> group_of_sink, Progress& progress);

}  // namespace thalweg
