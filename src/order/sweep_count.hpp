#pragma once

/// The order of one triangle whose disc holds much: angular sweeps, and walks of cones in simple polygons.

#include "order/flood.hpp"
#include "order/ground.hpp"
#include "order/polygon_view.hpp"
#include "order/side_view.hpp"
#include "order/sights.hpp"
#include "order/through_sweep.hpp"
#include "order/view_sweep.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace thalweg::detail {

/// Counts for one triangle after the other; scratch memory is reused.
class SweepCount {
 public:
  /// The vertices counted, in no promised order. `reached` is a flood up to edges that block which has ended.
  /// Pre: corners counter-clockwise, a valid triangle that `start` overlaps; the definition is neither Std
  /// nor Pathcon. Complexity, with n the vertices and edges in the disc: n log n for SeesOpp, Sees3vtx and
  /// EmptyQuad; for SeesTriang, SeesVtx and ConfEdge also n log n for each vertex that does not see its
  /// opposite corner, at most. Over simple polygons n, with n the faces that meet the disc, and n log n at
  /// most to cut what a side sees, and under ConfEdge.
  std::span<const VertexId> count(const Ground& ground, const Triangle& corners, TriangleId start,
                                  OrderDefinition definition, const Flood& reached);

 private:
  void view(const Ground& ground, VertexId eye, ViewSweep::HalfPlane half, std::span<const VertexId> points,
            std::span<const HalfedgeId> edges, std::vector<VertexId>& seen);
  void at_side(const Ground& ground, OrderDefinition definition, std::size_t side);
  void add_light(const Ground& ground, OrderDefinition definition, std::size_t side);
  [[nodiscard]] bool conflicts(const Ground& ground, VertexId p, std::size_t side);
  void add_conflicts(const Ground& ground, std::size_t side);
  void keep_empty(const Ground& ground, VertexId u, VertexId v, std::vector<VertexId>& candidates) const;

  Triangle corners_{};
  Flood all_;                                    ///< through every edge
  std::vector<HalfedgeId> edges_;                ///< that block and that the flood met
  std::vector<HalfedgeId> all_edges_;            ///< that block, in the disc
  std::array<std::vector<VertexId>, 3> beyond_;  ///< vertices reached beyond side i
  std::vector<VertexId> all_beyond_;             ///< all vertices inside beyond the side at hand
  std::vector<VertexId> seen_, from_start_, from_end_, from_corner_;
  std::vector<VertexId> in_light_;      ///< over simple polygons: what sees the side at hand
  std::vector<ThroughSweep::Eye> lit_;  ///< what sees the side at hand, under ConfEdge over simple polygons
  std::vector<VertexId> counted_;
  std::span<const VertexId> inside_;
  ViewSweep sweep_;
  Circumdisc disc_;
  PolygonView polygon_view_;
  SideView side_view_;
  SideSight side_sight_;
  ThroughSweep through_sweep_;
};

}  // namespace thalweg::detail
