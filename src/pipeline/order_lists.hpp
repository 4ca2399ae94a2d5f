#pragma once

/// What `order` lists, as CSV, and its census.

#include <thalweg/order/conflicts.hpp>
#include <thalweg/order/order_triangles.hpp>
#include <thalweg/order/quadrilaterals.hpp>
#include <thalweg/order/useful_edges.hpp>
#include <thalweg/pipeline/order_points.hpp>

#include <span>
#include <string>

namespace thalweg {

/// Lists: a header line, whole numbers, rows sorted, LF.
std::string triangle_list(std::span<const OrderTriangle> triangles);
std::string edge_list(std::span<const UsefulEdge> edges);
std::string quadrilateral_list(std::span<const Quadrilateral> quadrilaterals);
std::string conflict_list(std::span<const EdgeConflict> conflicts);

/// Fills `census` and `not_taken` of the result for orders up to its `max_order`. Throws: Error{Cancelled}.
void take_census(const ConstrainedOrder& orders, OrderResult& result, Progress& progress);

}  // namespace thalweg
