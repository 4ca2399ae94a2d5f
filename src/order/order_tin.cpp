// Orders of all triangles.
//
// 1. An edge is locally Delaunay if it blocks, or lies on the rim, or the apex on its other side is outside
// of
//    the circle of the triangle on this side, by the tie rule. A triangulation all of whose edges are so is
//    the constrained Delaunay triangulation (Lee and Lin, Generalized Delaunay triangulation for planar
//    graphs, 1986): no path inside its disc joins a triangle to a vertex there. So Pathcon counts none, and
//    the other definitions, Std with edges that block aside, count no more (Lemma 1).
// 2. Else each triangle is asked for by itself. What floods need is the topology of the TIN, not that it is
//    Delaunay.
#include "base/parallel.hpp"

#include <thalweg/geometry/predicates.hpp>
#include <thalweg/order/constrained_order.hpp>
#include <thalweg/order/order_tin.hpp>

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <atomic>

namespace thalweg {

namespace {

constexpr std::size_t kBlock = 4096;

bool locally_delaunay(const Tin& tin, HalfedgeId h) {
  const HalfedgeId twin = tin.twin(h);
  if (!twin.valid() || twin < h || tin.constrained(h)) return true;
  return !in_circle_perturbed(tin.point(tin.origin(h)), tin.point(tin.target(h)), tin.point(tin.apex(h)),
                              tin.point(tin.apex(twin)));
}

bool delaunay(const Tin& tin, const Progress& progress) {
  std::atomic<bool> all{true};
  for_each_block(tin.halfedge_count(), kBlock, progress, [&](std::size_t begin, std::size_t end) {
    for (std::size_t h = begin; h < end && all.load(std::memory_order_relaxed); ++h) {
      if (!locally_delaunay(tin, HalfedgeId{h})) all = false;
    }
  });
  return all;
}

}  // namespace

TinOrders find_tin_orders(const Tin& tin, const TinOrderOptions& options, Progress& progress) {
  const ConstrainedOrder order(tin, options.mode);
  TinOrders result{.orders = std::vector<std::uint32_t>(tin.triangle_count(), 0), .histogram = {}};
  const bool counts_paths = options.definition != OrderDefinition::Std || order.unconstrained();
  if (!counts_paths || !delaunay(tin, progress)) {
    tbb::enumerable_thread_specific<OrderWorkspace> workspaces;
    for_each_block(tin.triangle_count(), kBlock / 8, progress, [&](std::size_t begin, std::size_t end) {
      OrderWorkspace& workspace = workspaces.local();
      for (std::size_t t = begin; t < end; ++t) {
        result.orders[t] = static_cast<std::uint32_t>(
            order.order(tin.triangle(TriangleId{t}), options.definition, workspace));
      }
    });
  }
  for (const std::uint32_t value : result.orders) {
    result.max_order = std::max(result.max_order, value);
    if (value >= result.histogram.size()) result.histogram.resize(value + std::size_t{1}, 0);
    ++result.histogram[value];
  }
  return result;
}

}  // namespace thalweg
