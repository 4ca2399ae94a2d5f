#pragma once

/// The drainage network of a flow.

#include <thalweg/base/progress.hpp>
#include <thalweg/terrain/pit_table.hpp>
#include <thalweg/terrain/surface_flow.hpp>

#include <vector>

namespace thalweg {

/// One edge in which water runs, or the way across triangles from where such an edge ends to the next.
struct Reach {
  std::vector<FlowPoint> points;  ///< downstream
  HalfedgeId channel;             ///< invalid: across triangles
  double area = 0;                ///< of all ground upstream of its lower end, square units of the plane
  unsigned strahler = 1;
  SinkId sink;
};

/// The channels inside of the TIN that drain at least `min_area` (square units of the plane), and what
/// connects them, by halfedge, then vertex. What spills from a pit goes on at its overflow; no line is drawn
/// to there.
///
/// Laws: (1) areas grow downstream; (2) the areas at the lowest reaches of a sink are at most that of the
/// sink. Strahler: a reach without one above has order 1; where two of the largest order meet it grows by
/// one. Throws: Error{Cancelled}. Complexity: linear.
std::vector<Reach> find_network(const SurfaceFlow& flow, const Spilling& spilling, double min_area,
                                Progress& progress);

}  // namespace thalweg
