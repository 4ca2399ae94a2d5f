// Orders of all triangles.
//
// 1. Triangles of the constrained Delaunay triangulation of the TIN's vertices and constraint edges: no path
//    inside its disc joins such a triangle to a vertex there (Lee and Lin, Generalized Delaunay triangulation
//    for planar graphs, 1986). So Pathcon counts none, and the other definitions but Std count no more (Lemma
//    1). Under Std over a convex ground the same holds with the Delaunay triangulation of the vertices alone.
//    Flips find it (delaunay_flips.cpp): a triangle that is never flipped is one of it, order 0.
// 2. Triangles abc and bad that one flip turned into adc and dbc of that triangulation: d lies in the disc of
//    abc, sees c across the quadrilateral, and a and b along its sides, and dab holds no other vertex, so
//    every definition counts it. No other vertex counts unless a neighbour of d lies in the disc too
//    (quadrilaterals.cpp, step 2): order 1.
// 3. What is left is asked for one by one: little in a TIN of low order. So is every triangle where nothing
//    is known beforehand: under Std over a polygon, and where flips take too long. What floods need is the
//    topology of the TIN, not that it is Delaunay.
// 4. Under Std among constraint edges many discs at the hull and at long edges hold much of the terrain.
//    There vertices are counted in rows (vertex_rows.cpp), without a look at each.
#include "base/parallel.hpp"
#include "order/delaunay_flips.hpp"
#include "order/vertex_rows.hpp"

#include <thalweg/order/constrained_order.hpp>
#include <thalweg/order/order_tin.hpp>

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <optional>

namespace thalweg {

namespace {

using detail::DelaunayFlips;
using detail::FlipRule;

constexpr std::size_t kBlock = 4096;
// A TIN of order 1 takes at most a flip for six edges. Four flips an edge cost about as much as asking for
// all triangles.
constexpr std::size_t kMostFlipsAnEdge = 4;

std::vector<HalfedgeId> broken_edges(const Tin& tin, FlipRule rule, Progress& progress) {
  std::vector<std::vector<HalfedgeId>> found(tin.halfedge_count() / kBlock + 1);
  for_each_block(tin.halfedge_count(), kBlock, progress, {0, 0.3}, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const HalfedgeId h{i};
      if (tin.represents_edge(h) && detail::breaks_delaunay(tin, h, rule)) found[begin / kBlock].push_back(h);
    }
  });
  std::vector<HalfedgeId> all;
  for (const auto& part : found) all.insert(all.end(), part.begin(), part.end());
  return all;
}

constexpr std::uint32_t kUnknown = 0xffffffffU;

// The orders that flips tell, and kUnknown elsewhere.
std::vector<std::uint32_t> orders_by_flips(const Tin& tin, FlipRule rule, Progress& progress) {
  std::vector<std::uint32_t> orders(tin.triangle_count(), 0);
  const std::vector<HalfedgeId> broken = broken_edges(tin, rule, progress);
  if (broken.empty()) return orders;
  DelaunayFlips flips(tin, rule, broken);
  if (!flips.run(kMostFlipsAnEdge * tin.edge_count(), progress)) {
    std::fill(orders.begin(), orders.end(), kUnknown);
    return orders;
  }
  for (std::size_t t = 0; t < orders.size(); ++t) {
    if (!flips.kept(TriangleId{t})) orders[t] = kUnknown;
  }
  const std::vector<DelaunayFlips::Flip> single = flips.single_flips();
  for_each_block(single.size(), kBlock, progress, {0.4, 0.6}, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (flips.alone_inside_left(single[i])) orders[single[i].left.index()] = 1;
      if (flips.alone_inside_right(single[i])) orders[single[i].right.index()] = 1;
    }
  });
  return orders;
}

// `plain`: under Std, among constraint edges.
void ask_for_unknown(const Tin& tin, OrderDefinition definition, bool plain, const ConstrainedOrder& order,
                     std::vector<std::uint32_t>& orders, Progress& progress) {
  std::vector<TriangleId> unknown;
  for (std::size_t t = 0; t < orders.size(); ++t) {
    if (orders[t] == kUnknown) unknown.push_back(TriangleId{t});
  }
  std::optional<detail::VertexRows> rows;
  if (plain && !unknown.empty()) rows.emplace(tin);
  tbb::enumerable_thread_specific<OrderWorkspace> workspaces;
  for_each_block(unknown.size(), kBlock / 8, progress, {0.6, 1}, [&](std::size_t begin, std::size_t end) {
    OrderWorkspace& workspace = workspaces.local();
    for (std::size_t i = begin; i < end; ++i) {
      const TriangleId t = unknown[i];
      orders[t.index()] = static_cast<std::uint32_t>(
          rows ? rows->count_in_disc(tin.triangle(t)) : order.order(tin.triangle(t), definition, workspace));
    }
  });
}

}  // namespace

TinOrders find_tin_orders(const Tin& tin, const TinOrderOptions& options, Progress& progress) {
  const ConstrainedOrder order(tin, options.mode);
  const bool plain = options.definition == OrderDefinition::Std && !order.unconstrained();
  TinOrders result;
  if (plain && options.mode == GroundMode::Polygon) {
    result.orders.assign(tin.triangle_count(), kUnknown);
  } else {
    result.orders = orders_by_flips(tin, plain ? FlipRule::FlipAll : FlipRule::KeepConstraints, progress);
  }
  ask_for_unknown(tin, options.definition, plain, order, result.orders, progress);
  for (const std::uint32_t value : result.orders) {
    result.max_order = std::max(result.max_order, value);
    if (value >= result.histogram.size()) result.histogram.resize(value + std::size_t{1}, 0);
    ++result.histogram[value];
  }
  return result;
}

}  // namespace thalweg
