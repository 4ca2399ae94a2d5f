// Lists of orders, and the census.
//
// The census finds the triangles of the largest order once for each definition, and the smallest useful order
// of each edge from them; counts for smaller orders follow by summing up. Where a definition has no method
// for so many vertices, it is left out, and the reason is said.
#include "pipeline/order_lists.hpp"

#include <thalweg/base/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <vector>

namespace thalweg {

namespace {

// A census is about growth: what tries all pairs is not worth more than a few hundred vertices there.
constexpr std::size_t kExhaustiveLimit = 300;

/// One row of the list: corners from the smallest id, and which of st, uv is the diagonal in the ground.
struct QuadrilateralRow {
  std::array<std::uint32_t, 4> corners{};
  bool delaunay_is_st = false;
  auto operator<=>(const QuadrilateralRow&) const = default;
};

QuadrilateralRow row_of(const Quadrilateral& q) {
  QuadrilateralRow row{{q.s.value(), q.u.value(), q.t.value(), q.v.value()}, false};
  while (row.corners[0] != *std::min_element(row.corners.begin(), row.corners.end())) {
    std::rotate(row.corners.begin(), row.corners.begin() + 1, row.corners.end());
    row.delaunay_is_st = !row.delaunay_is_st;
  }
  return row;
}

}  // namespace

std::string triangle_list(std::span<const OrderTriangle> triangles) {
  std::vector<OrderTriangle> rows(triangles.begin(), triangles.end());
  for (OrderTriangle& row : rows) std::sort(row.corners.begin(), row.corners.end());
  std::sort(rows.begin(), rows.end());
  std::string text = "a,b,c,order\n";
  for (const OrderTriangle& row : rows) {
    fmt::format_to(std::back_inserter(text), "{},{},{},{}\n", row.corners[0].value(), row.corners[1].value(),
                   row.corners[2].value(), row.order);
  }
  return text;
}

std::string edge_list(std::span<const UsefulEdge> edges) {
  std::string text = "a,b,order\n";
  for (const UsefulEdge& edge : edges) {
    fmt::format_to(std::back_inserter(text), "{},{},{}\n", edge.a.value(), edge.b.value(),
                   edge.order ? std::to_string(*edge.order) : "unknown");
  }
  return text;
}

std::string quadrilateral_list(std::span<const Quadrilateral> quadrilaterals) {
  std::vector<QuadrilateralRow> rows;
  rows.reserve(quadrilaterals.size());
  std::transform(quadrilaterals.begin(), quadrilaterals.end(), std::back_inserter(rows), row_of);
  std::sort(rows.begin(), rows.end());
  std::string text = "s,u,t,v,delaunay\n";
  for (const QuadrilateralRow& row : rows) {
    fmt::format_to(std::back_inserter(text), "{},{},{},{},{}\n", row.corners[0], row.corners[1],
                   row.corners[2], row.corners[3], row.delaunay_is_st ? "st" : "uv");
  }
  return text;
}

std::string conflict_list(std::span<const EdgeConflict> conflicts) {
  std::string text = "a,b,c,d,crossing\n";
  for (const EdgeConflict& pair : conflicts) {
    fmt::format_to(std::back_inserter(text), "{},{},{},{},{}\n", pair.a.value(), pair.b.value(),
                   pair.c.value(), pair.d.value(), pair.crossing ? 1 : 0);
  }
  return text;
}

void take_census(const ConstrainedOrder& orders, OrderResult& result, Progress& progress) {
  const std::size_t count = result.max_order + 1;
  for (const OrderDefinition definition : kOrderDefinitions) {
    const std::string name(definition_name(definition));
    progress.start_phase("triangles under " + name);
    std::vector<CensusRow> rows(count);
    for (std::size_t k = 0; k < count; ++k) rows[k] = {.definition = definition, .order = k};
    try {
      std::vector<OrderTriangle> triangles = find_order_triangles(
          orders,
          {.definition = definition, .max_order = result.max_order, .exhaustive_limit = kExhaustiveLimit},
          progress);
      for (const OrderTriangle& t : triangles) ++rows[t.order].triangles;
      progress.start_phase("useful edges under " + name);
      for (const UsefulEdge& edge :
           find_useful_edges(orders, std::move(triangles),
                             {.definition = definition, .max_order = result.max_order}, progress)) {
        ++(edge.order ? rows[*edge.order].edges : rows.back().unknown_edges);
      }
    } catch (const Error& error) {
      if (error.code() != ErrorCode::SizeLimit) throw;
      result.not_taken.push_back(name + ": " + error.what());
      continue;
    }
    for (std::size_t k = 1; k < count; ++k) {
      rows[k].triangles += rows[k - 1].triangles;
      rows[k].edges += rows[k - 1].edges;
    }
    result.census.insert(result.census.end(), rows.begin(), rows.end());
  }
}

}  // namespace thalweg
