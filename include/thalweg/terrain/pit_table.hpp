#pragma once

/// Pits one by one: where they spill, how deep they are, what they hold.

#include <thalweg/base/progress.hpp>
#include <thalweg/terrain/statistics.hpp>
#include <thalweg/terrain/surface_flow.hpp>

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

namespace thalweg {

/// A pit, interior or lake.
///
/// It fills until its water first comes to ground that is lower than its bottom, or leaves: at the spill
/// vertex, the highest on the lowest way out. Of two pits that meet while they fill, the shallower spills
/// into the other (equal bottoms: the first by (x, y) goes on), so a hollow in a large pit has its own small
/// depth, and the large one is one pit. Every rim vertex and every given outlet is a way out.
struct Pit {
  SinkId sink;
  VertexId vertex;             ///< of its plateau: the first by (x, y)
  std::uint32_t vertices = 1;  ///< of its plateau
  bool lake = false;
  double height = 0;        ///< in the TIN's unit
  double spill_height = 0;  ///< in the TIN's unit
  VertexId spill_vertex;
  VertexId overflow;  ///< where its water goes on: the spill vertex, or a neighbour of it on the other side
  std::optional<std::size_t> spills_into;  ///< index of the pit that it first runs into; none: it leaves
  double fill_height = 0;                  ///< level to which filling all pits raises it, TIN's unit
  double depth_m = 0;                      ///< from bottom to spill height
  double area_m2 = 0;                      ///< of the water when it is full to the spill height, in the plane
  double volume_m3 = 0;                    ///< of that water
  double catchment_area_m2 = 0;            ///< of all ground that drains into it
};

/// Classes of depth, in metres: up to each of these, and more.
constexpr std::array<double, 5> kDepthClassesMetres = {0.01, 0.1, 0.5, 1, 5};

struct PitTable {
  std::vector<Pit> pits;  ///< in the order of the sinks
  std::array<std::size_t, 6> interior_by_depth{};
  /// What filling all interior pits and lakes would add to the terrain: nested pits are counted once.
  double fill_volume_m3 = 0;
};

/// Laws: (1) as many pits as find_pits counts inside of the TIN, without those at given outlets; (2) every
/// depth is positive; (3) fill_height is the least, over all ways along edges to a way out, of the greatest
/// height on the way. Throws: Error{Cancelled}. Complexity: linear, plus
/// n log n in pits that meet, plus the vertices under water in each pit, nested ones again; on all threads.
PitTable tabulate_pits(const SurfaceFlow& flow, const MetricScale& scale, Progress& progress);

/// Where water ends if pits that are not deep are full and spill.
struct Spilling {
  std::vector<VertexId> overflow;  ///< by sink: the vertex at which its water goes on; invalid: it does not
  std::vector<SinkId> end;         ///< by sink: where its water ends at last
};

/// Lets pits, not lakes, of at most `max_depth_m` spill; at a rim vertex what spills leaves. No water runs in
/// a circle: of pits that meet the one that goes on is filled later, so along a chain of pits that spill the
/// last one of each set that they have filled is filled later than that of the one before. Complexity:
/// linear.
Spilling let_spill(const SurfaceFlow& flow, const PitTable& table, double max_depth_m);

}  // namespace thalweg
