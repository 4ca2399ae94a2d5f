#pragma once

/// The triangles that triangulations of order at most k are made of.

#include <thalweg/base/progress.hpp>
#include <thalweg/order/constrained_order.hpp>
#include <thalweg/order/order_triangles.hpp>

#include <vector>

namespace thalweg {

/// Of the valid triangles of order at most `max_order` at least those that some triangulation of that order
/// has; sorted. find_fixed_faces makes the same of them as of all.
///
/// Where nothing blocks, a search from edge to edge, outwards from the ground's own: all but EmptyQuad agree
/// there. Else what find_order_triangles gives. Pre: the ground covers the convex hull where nothing blocks.
/// Throws and reports: as find_order_triangles. Parallel; deterministic. Complexity: for each useful edge
/// the faces of the ground that it crosses, and the neighbours of the `max_order` nearest vertices on either
/// side.
std::vector<OrderTriangle> find_useful_triangles(const ConstrainedOrder& ground,
                                                 const OrderTriangleOptions& options, Progress& progress);

}  // namespace thalweg
