// The interval of the smallest order under Std.
//
// 1. Above: the constrained Delaunay triangulation's own order.
// 2. Below: the triangle of the ground on a side of a constraint edge has an order; that of the best triangle
//    there is no larger. Sides whose triangle has a smaller order than some side's best cannot be the largest
//    and are passed by; the others, largest first, are searched: fan_search.cpp finds, around one end, every
//    vertex that can be in a triangle with it of an order below the best so far.
// 3. Which sides are passed by depends on the threads, but no side is whose best is the largest, so the
//    first of these is the same every time.
#include "base/parallel.hpp"
#include "order/fan_search.hpp"

#include <thalweg/geometry/predicates.hpp>
#include <thalweg/order/order_tin.hpp>
#include <thalweg/order/std_order.hpp>

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <atomic>
#include <vector>

namespace thalweg {

namespace {

/// A side of a constraint edge: a halfedge of the ground, and the order of the triangle there.
struct Side {
  HalfedgeId h;
  std::uint32_t order = 0;
};

std::vector<Side> sides_of(const Tin& tin, const std::vector<std::uint32_t>& orders) {
  std::vector<Side> sides;
  for (std::size_t i = 0; i < tin.halfedge_count(); ++i) {
    const HalfedgeId h{i};
    const std::uint32_t order = orders[Tin::triangle_of(h).index()];
    if (tin.constrained(h) && order > 0) sides.push_back({h, order});
  }
  std::sort(sides.begin(), sides.end(), [](const Side& one, const Side& other) {
    return one.order != other.order ? one.order > other.order : one.h < other.h;
  });
  return sides;
}

struct Scratch {
  detail::FanSearch search;
  OrderWorkspace workspace;
};

class DemandSearch {
 public:
  explicit DemandSearch(const ConstrainedOrder& order)
      : order_(order), tin_(order.ground()), ground_(tin_, order.mode()) {}

  /// The best triangle on the side, or none if its order is below the largest demand of other sides so far.
  std::optional<StdOrderDemand> at(const Side& side, Scratch& scratch);

 private:
  const ConstrainedOrder& order_;
  const Tin& tin_;
  detail::Ground ground_;
  std::atomic<std::uint32_t> largest_{0};
};

std::optional<StdOrderDemand> DemandSearch::at(const Side& side, Scratch& scratch) {
  if (side.order < largest_) return std::nullopt;
  const VertexId a = tin_.origin(side.h), b = tin_.target(side.h);
  StdOrderDemand best{a, b, {a, b, tin_.apex(side.h)}, side.order};
  scratch.search.start(ground_, a, side.order - 1, detail::FanPruning::Visible);
  while (scratch.search.next_fan()) {
    for (const auto& partner : scratch.search.partners()) {
      const VertexId w = partner.vertex;
      if (orientation(tin_.point(a), tin_.point(b), tin_.point(w)) <= 0) continue;
      const Triangle corners{a, b, w};
      if (!order_.is_valid(corners, scratch.workspace)) continue;
      const auto order = order_.order_up_to(corners, OrderDefinition::Std, best.order - 1, scratch.workspace);
      if (!order) continue;
      best.triangle = corners;
      best.order = static_cast<std::uint32_t>(*order);
      if (best.order < largest_ || best.order == 0) return std::nullopt;
    }
  }
  std::uint32_t seen = largest_;
  while (seen < best.order && !largest_.compare_exchange_weak(seen, best.order)) {
  }
  return best;
}

}  // namespace

StdOrderInterval find_std_order_interval(const ConstrainedOrder& ground, Progress& progress) {
  const Tin& tin = ground.ground();
  const TinOrders orders =
      find_tin_orders(tin, {.definition = OrderDefinition::Std, .mode = ground.mode()}, progress);
  StdOrderInterval interval{.at_least = 0, .at_most = orders.max_order, .demand = {}, .worst = {}};
  if (tin.triangle_count() == 0) return interval;
  const auto worst = std::find(orders.orders.begin(), orders.orders.end(), orders.max_order);
  interval.worst = TriangleId{static_cast<std::size_t>(worst - orders.orders.begin())};

  constexpr std::size_t kBlock = 16;
  const std::vector<Side> sides = sides_of(tin, orders.orders);
  DemandSearch search(ground);
  tbb::enumerable_thread_specific<Scratch> scratches;
  std::vector<std::optional<StdOrderDemand>> demands(sides.size());
  for_each_block(sides.size(), kBlock, progress, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      progress.check();
      demands[i] = search.at(sides[i], scratches.local());
    }
  });
  // Of equal demands that of the first side, by halfedge; sides are by order and then by halfedge.
  std::optional<std::size_t> first;
  for (std::size_t i = 0; i < sides.size(); ++i) {
    if (!demands[i]) continue;
    if (!first || demands[i]->order > demands[*first]->order ||
        (demands[i]->order == demands[*first]->order && sides[i].h < sides[*first].h)) {
      first = i;
    }
  }
  if (first) interval.demand = demands[*first];
  interval.at_least =
      std::max(interval.demand ? interval.demand->order : 0, std::min<std::uint32_t>(interval.at_most, 2));
  return interval;
}

}  // namespace thalweg
