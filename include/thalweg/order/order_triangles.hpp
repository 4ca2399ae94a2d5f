#pragma once

/// All valid triangles of order at most k.

#include <thalweg/base/progress.hpp>
#include <thalweg/mesh/tin.hpp>
#include <thalweg/order/constrained_order.hpp>

#include <cstdint>
#include <vector>

namespace thalweg {

struct OrderTriangle {
  Triangle corners;  ///< counter-clockwise from the smallest id
  std::uint32_t order = 0;
  auto operator<=>(const OrderTriangle&) const = default;
};

struct OrderTriangleOptions {
  OrderDefinition definition = OrderDefinition::SeesOpp;
  std::size_t max_order = 1;
  /// Where no local search is proved complete, at most that many vertices are searched.
  std::size_t exhaustive_limit = 5000;
};

/// All valid triangles of order at most `max_order`, whether or not a triangulation of that order holds them;
/// sorted.
///
/// Under Std ... SeesOpp, and Sees3vtx without constraint edges, a local search, proved complete, whose cost
/// goes with what it finds and with what the vertices see near by. Under Sees3vtx with constraint edges, and
/// under EmptyQuad, nothing bounds where such triangles lie: a short constraint edge close to one end of a
/// side hides it from all that lies beyond, and a vertex close to a side lies in most other triangles on it,
/// so that one of order 1 may be as long as the terrain, its disc full. Every pair of vertices that see each
/// other is tried. Throws: Error{SizeLimit} if these have more vertices than `exhaustive_limit`; {Cancelled}.
/// Reports the fraction done of the caller's phase. Parallel; deterministic.
std::vector<OrderTriangle> find_order_triangles(const ConstrainedOrder& ground,
                                                const OrderTriangleOptions& options, Progress& progress);

/// Whether find_order_triangles takes this ground: false where it would throw SizeLimit.
bool can_list_order_triangles(const ConstrainedOrder& ground, const OrderTriangleOptions& options);

}  // namespace thalweg
