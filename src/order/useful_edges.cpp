// Useful edges.
//
// 1. A triangulation has order at most k exactly if all its triangles have; these, all of them, are what
//    find_order_triangles gives. Candidates and faces: candidates.cpp. In each face the smallest order of a
//    triangulation that holds a given triangle: face_search.cpp.
// 2. An edge is useful at the largest of: the smallest order of a triangulation of its face that holds a
//    triangle at it, and for every other face the smallest order of any triangulation of it. All but Std give
//    the constrained Delaunay triangulation order 0, so there the others do not matter.
// 3. A face with too many fronts: the greedy triangulation of the edge is one that holds it, so it is useful
//    at that order. Under Pathcon, and Std without constraint edges (Corollary 1), under ConfEdge and SeesOpp
//    (Lemma 4) at none below. Else: each side of the edge needs a triangle, so the larger of the smallest
//    orders there is a bound from below; if they differ, the order is not known.
#include "base/parallel.hpp"
#include "order/candidates.hpp"
#include "order/face_search.hpp"

#include <thalweg/order/greedy_triangulation.hpp>
#include <thalweg/order/useful_edges.hpp>

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>

namespace thalweg {

namespace {

using detail::Candidates;
using detail::FaceOrders;

constexpr std::uint32_t kUnreachable = FaceOrders::kUnreachable;
constexpr std::uint32_t kUnknown = kUnreachable - 1;

class UsefulSearch {
 public:
  UsefulSearch(const ConstrainedOrder& order, const UsefulEdgeOptions& options, Progress& progress)
      : order_(order), options_(options), progress_(progress) {}

  std::vector<UsefulEdge> run(std::vector<OrderTriangle> triangles);

 private:
  [[nodiscard]] bool greedy_decides() const;
  void search(std::size_t face);
  void ask_greedy(std::size_t face);
  [[nodiscard]] std::uint32_t greedy_order(const CandidateEdge& edge, OrderWorkspace& workspace) const;
  [[nodiscard]] std::uint32_t least_order_everywhere() const;

  const ConstrainedOrder& order_;
  const UsefulEdgeOptions& options_;
  Progress& progress_;
  Candidates candidates_;
  std::vector<std::uint32_t> of_edge_;  ///< in its face; kUnknown, or kUnreachable: in no triangulation
  std::vector<std::uint32_t> of_face_;  ///< any triangulation of it
  tbb::enumerable_thread_specific<OrderWorkspace> workspaces_;
};

bool UsefulSearch::greedy_decides() const {
  switch (options_.definition) {
    case OrderDefinition::Pathcon:
    case OrderDefinition::ConfEdge:
    case OrderDefinition::SeesOpp:
      return true;
    case OrderDefinition::EmptyQuad:
      return false;
    default:
      return order_.unconstrained();
  }
}

void UsefulSearch::search(std::size_t face) {
  const auto orders = detail::FrontFinder(candidates_).find_orders(face, options_.work_limit);
  if (!orders) return ask_greedy(face);
  of_face_[face] = orders->any;
  const auto triangles = candidates_.faces.row(face);
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    for (const std::uint32_t side : candidates_.sides[triangles[i]]) {
      if (!candidates_.edges[side / 2].free) continue;
      std::uint32_t& least = of_edge_[side / 2];
      least = std::min(least, orders->with_triangle[i]);
    }
  }
}

std::uint32_t UsefulSearch::greedy_order(const CandidateEdge& edge, OrderWorkspace& workspace) const {
  std::uint32_t largest = 0;
  for (const Triangle& t : greedy_patch(order_.ground(), edge.a, edge.b).triangles) {
    const auto order = order_.order_up_to(t, options_.definition, options_.max_order, workspace);
    if (!order) return kUnreachable;
    largest = std::max(largest, static_cast<std::uint32_t>(*order));
  }
  return largest;
}

void UsefulSearch::ask_greedy(std::size_t face) {
  const bool constrained_std = options_.definition == OrderDefinition::Std && !order_.unconstrained();
  of_face_[face] = constrained_std ? kUnknown : 0;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> least;  // (side, order of a triangle on it)
  for (const std::uint32_t t : candidates_.faces.row(face)) {
    for (const std::uint32_t side : candidates_.sides[t]) {
      if (candidates_.edges[side / 2].free) least.emplace_back(side, candidates_.triangles[t].order);
    }
  }
  std::sort(least.begin(), least.end());
  least.erase(std::unique(least.begin(), least.end(),
                          [](const auto& one, const auto& other) { return one.first == other.first; }),
              least.end());
  OrderWorkspace& workspace = workspaces_.local();
  for (std::size_t i = 0; i + 1 < least.size(); ++i) {
    const std::uint32_t e = least[i].first / 2;
    if (least[i + 1].first / 2 != e) continue;
    progress_.check();
    const std::uint32_t bound = std::max(least[i].second, least[i + 1].second);
    const std::uint32_t greedy = greedy_order(candidates_.edges[e], workspace);
    of_edge_[e] = greedy == bound || greedy_decides() ? greedy : kUnknown;
  }
}

std::uint32_t UsefulSearch::least_order_everywhere() const {
  std::uint32_t largest = 0;
  for (const std::uint32_t order : of_face_) largest = std::max(largest, order);
  for (std::size_t t = 0; t < candidates_.triangles.size(); ++t) {
    const auto& sides = candidates_.sides[t];
    const bool fixed = std::none_of(sides.begin(), sides.end(),
                                    [&](std::uint32_t side) { return candidates_.edges[side / 2].free; });
    if (fixed) largest = std::max(largest, candidates_.triangles[t].order);
  }
  return largest;
}

std::vector<UsefulEdge> UsefulSearch::run(std::vector<OrderTriangle> triangles) {
  candidates_ = detail::find_candidates(order_.ground(), std::move(triangles), progress_);
  if (!detail::cover_ground(candidates_, order_.ground())) return {};
  of_edge_.assign(candidates_.edges.size(), kUnreachable);
  of_face_.assign(candidates_.faces.size(), 0);
  for_each_block(candidates_.faces.size(), 64, progress_, {0.5, 1}, [&](std::size_t begin, std::size_t end) {
    for (std::size_t face = begin; face < end; ++face) search(face);
  });
  const std::uint32_t everywhere = least_order_everywhere();
  std::vector<UsefulEdge> useful;
  if (everywhere == kUnreachable) return useful;
  for (std::size_t e = 0; e < of_edge_.size(); ++e) {
    const CandidateEdge& edge = candidates_.edges[e];
    const std::uint32_t order = edge.free ? of_edge_[e] : 0;
    if (order == kUnreachable) continue;
    if (order == kUnknown || everywhere == kUnknown) {
      useful.push_back({edge.a, edge.b, std::nullopt});
    } else {
      useful.push_back({edge.a, edge.b, std::max(order, everywhere)});
    }
  }
  return useful;
}

}  // namespace

std::vector<UsefulEdge> find_useful_edges(const ConstrainedOrder& ground,
                                          std::vector<OrderTriangle> triangles,
                                          const UsefulEdgeOptions& options, Progress& progress) {
  return UsefulSearch(ground, options, progress).run(std::move(triangles));
}

std::vector<UsefulEdge> find_useful_edges(const ConstrainedOrder& ground, const UsefulEdgeOptions& options,
                                          Progress& progress) {
  std::vector<OrderTriangle> triangles = find_order_triangles(ground,
                                                              {.definition = options.definition,
                                                               .max_order = options.max_order,
                                                               .exhaustive_limit = options.exhaustive_limit},
                                                              progress);
  return find_useful_edges(ground, std::move(triangles), options, progress);
}

}  // namespace thalweg
