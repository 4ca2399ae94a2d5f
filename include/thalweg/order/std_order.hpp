#pragma once

/// The smallest order under Std that a triangulation with constraint edges can have, as an interval.

#include <thalweg/base/progress.hpp>
#include <thalweg/mesh/tin.hpp>
#include <thalweg/order/constrained_order.hpp>

#include <cstdint>
#include <optional>

namespace thalweg {

/// One side of a constraint edge, and a triangle there of which no valid one has a smaller order.
struct StdOrderDemand {
  VertexId a, b;      ///< the constraint edge; the side is left of a -> b
  Triangle triangle;  ///< counter-clockwise, from a
  std::uint32_t order = 0;
};

struct StdOrderInterval {
  std::uint32_t at_least = 0;  ///< no triangulation with the constraint edges has a smaller order
  std::uint32_t at_most = 0;   ///< the order of the constrained Delaunay triangulation
  /// The side that demands most; none if no side demands anything. `at_least` may be larger than its order.
  std::optional<StdOrderDemand> demand;
  TriangleId worst;  ///< the first triangle of the ground whose order is `at_most`
};

/// What is known of the smallest order under Std of a triangulation of the ground's vertices that has all its
/// constraint edges. Every other definition has a triangulation of order 0; under Std two points beside a
/// long constraint edge may leave none of low order.
///
/// Laws (tests): (1) at_least <= the smallest order <= at_most; (2) they are equal if at_most <= 1, and
/// without constraint edges both are 0; (3) each side of each constraint edge is a side of a triangle in
/// every triangulation, so the smallest order of a valid triangle there is a bound from below: `demand` is
/// the largest of these. It is at least 2 if at_most is: for k <= 1 there is a triangulation of order k only
/// if the constrained Delaunay triangulation is one. Pre: the ground is the constrained Delaunay
/// triangulation. Throws: Error{Cancelled}. Complexity: Std orders of the triangles near constraint edges; at
/// each constraint edge that may demand more than those before, the vertices that can share a triangle of
/// lower order with an end. Parallel; deterministic.
StdOrderInterval find_std_order_interval(const ConstrainedOrder& ground, Progress& progress);

}  // namespace thalweg
