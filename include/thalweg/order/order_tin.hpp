#pragma once

/// The constrained orders of all triangles of a TIN.

#include <thalweg/base/progress.hpp>
#include <thalweg/mesh/ground_mode.hpp>
#include <thalweg/mesh/tin.hpp>
#include <thalweg/order/definition.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace thalweg {

struct TinOrderOptions {
  OrderDefinition definition = OrderDefinition::SeesOpp;
  GroundMode mode = GroundMode::Hull;
};

struct TinOrders {
  std::vector<std::uint32_t> orders;   ///< of each triangle, as in the TIN
  std::vector<std::size_t> histogram;  ///< how many triangles have order 0, 1, ... max_order
  std::uint32_t max_order = 0;
};

/// The order of each triangle with respect to the TIN's own vertices and constraint edges.
///
/// Law (test): equal to ConstrainedOrder::order of every triangle over any triangulation of the same vertices
/// and constraint edges. Pre: `tin` covers the convex hull of its vertices in mode Hull. Throws:
/// Error{Cancelled}. Complexity: linear, the flips to the constrained Delaunay triangulation (under Std: to
/// that without constraint edges), and a ConstrainedOrder::order for each triangle that is neither one of it
/// nor half of a quadrilateral of it that holds no more; for each triangle under Std in mode Polygon, or
/// where there are more than four flips an edge. Under Std with constraint edges each of these costs about
/// the root of the number of vertices at most, however many its disc holds. Reports the fraction done of the
/// caller's phase. Parallel; deterministic.
TinOrders find_tin_orders(const Tin& tin, const TinOrderOptions& options, Progress& progress);

}  // namespace thalweg
