#pragma once

/// Useful edges: those that some triangulation of order at most k holds.

#include <thalweg/base/progress.hpp>
#include <thalweg/order/order_triangles.hpp>

#include <cstdint>
#include <optional>
#include <vector>

namespace thalweg {

struct UsefulEdge {
  VertexId a;
  VertexId b;                          ///< a < b
  std::optional<std::uint32_t> order;  ///< the smallest at which it is useful; none: not known
  auto operator<=>(const UsefulEdge&) const = default;
};

struct UsefulEdgeOptions {
  OrderDefinition definition = OrderDefinition::SeesOpp;
  std::size_t max_order = 1;
  /// As in OrderTriangleOptions.
  std::size_t exhaustive_limit = 5000;
  /// Work allowed on each face of the ground that no fixed edge divides, in edges of fronts: a count, so the
  /// answer is the same everywhere. Beyond it the greedy triangulation decides as far as it can.
  std::size_t work_limit = 500'000;
};

/// All edges that are useful at an order of at most `max_order` (the paper's Definition 2), sorted by ends;
/// edges of the constrained Delaunay triangulation have order 0 under all definitions but Std. An edge
/// without an order is one of which neither was shown.
///
/// Exact under every definition while faces stay within `work_limit`: the triangulations of order at most k
/// are those that the valid triangles of order at most k make, and these are all known. Beyond it exact under
/// Pathcon, ConfEdge and SeesOpp, and without constraint edges under Std ... Sees3vtx (Corollary 1, Lemma 4).
/// Under Std constraint edges may leave no triangulation of order at most `max_order` at all: then no edge is
/// useful, not even one of the Delaunay triangulation, and the list is empty.
/// Throws: as find_order_triangles; Error{SizeLimit} if too many edges cross each other. Complexity: as
/// find_order_triangles, and the fronts of each face. Deterministic, parallel.
std::vector<UsefulEdge> find_useful_edges(const ConstrainedOrder& ground, const UsefulEdgeOptions& options,
                                          Progress& progress);
/// The same from the triangles that find_order_triangles gives for `max_order`.
std::vector<UsefulEdge> find_useful_edges(const ConstrainedOrder& ground,
                                          std::vector<OrderTriangle> triangles,
                                          const UsefulEdgeOptions& options, Progress& progress);

}  // namespace thalweg
