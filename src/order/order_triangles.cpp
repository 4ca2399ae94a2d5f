// All valid triangles of order at most k.
//
// 1. fan_search.cpp finds, for each vertex u, the vertices that can share such a triangle with u. Under Std
// ... SeesVtx
//    a triangle is found from each of its corners: it is taken from the smallest id. Under ConfEdge and
//    SeesOpp it is sure to be found only from the corner of its largest angle; rounding may tie corners, so
//    it may come twice.
// 2. Let v and w, counter-clockwise, be two partners of u with less than half a turn between. Going round
// from v, those
//    w come into question to which v looks past all partners between, on the side of u: else one of these
//    lies in triangle uvw. This leaves few; a partner inside the circle between v and w counts under all
//    definitions of step 1, for u sees it, and others may be counted as well; only what passes is tested
//    exactly.
#include "base/parallel.hpp"
#include "order/fan_search.hpp"

#include <thalweg/base/error.hpp>
#include <thalweg/geometry/predicates.hpp>
#include <thalweg/order/order_triangles.hpp>

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace thalweg {

namespace {

using detail::FanPruning;
using detail::FanSearch;

constexpr std::size_t kBlock = 256;

FanPruning pruning_for(OrderDefinition definition, bool unconstrained) {
  switch (definition) {
    case OrderDefinition::Std:
    case OrderDefinition::Pathcon:
    case OrderDefinition::SeesTriang:
    case OrderDefinition::SeesVtx:
      return FanPruning::Visible;
    case OrderDefinition::ConfEdge:
    case OrderDefinition::SeesOpp:
      return unconstrained ? FanPruning::Visible : FanPruning::NearEnds;
    case OrderDefinition::Sees3vtx:
      return unconstrained ? FanPruning::Visible : FanPruning::None;
    case OrderDefinition::EmptyQuad:
      return FanPruning::None;
  }
  return FanPruning::None;
}

double distance_square(Point2 a, Point2 b) {
  return (a.x - b.x) * (a.x - b.x) + (a.y - b.y) * (a.y - b.y);
}

struct Scratch {
  FanSearch search;
  OrderWorkspace workspace;
  std::vector<FanSearch::Partner> partners;
};

class TriangleSearch {
 public:
  TriangleSearch(const ConstrainedOrder& order, const OrderTriangleOptions& options, FanPruning pruning)
      : order_(order),
        tin_(order.ground()),
        ground_(tin_, order.mode()),
        options_(options),
        pruning_(pruning) {}

  void at(VertexId u, Scratch& scratch, std::vector<OrderTriangle>& found) const;

 private:
  void from_side(VertexId u, std::size_t first, Scratch& scratch, std::vector<OrderTriangle>& found) const;
  [[nodiscard]] bool largest_angle_at(VertexId u, VertexId v, VertexId w) const;
  [[nodiscard]] bool too_many(const Triangle& corners, std::span<const FanSearch::Partner> between) const;

  const ConstrainedOrder& order_;
  const Tin& tin_;
  detail::Ground ground_;
  OrderTriangleOptions options_;
  FanPruning pruning_;
};

// Up to rounding: false only if another corner's angle is the larger one for sure.
bool TriangleSearch::largest_angle_at(VertexId u, VertexId v, VertexId w) const {
  constexpr double kSlack = 1e-9;
  const double opposite = distance_square(tin_.point(v), tin_.point(w));
  const double other =
      std::max(distance_square(tin_.point(u), tin_.point(v)), distance_square(tin_.point(u), tin_.point(w)));
  return opposite >= other * (1 - kSlack);
}

// Partners between v and w lie beyond vw or outside of the circle: u sees them.
bool TriangleSearch::too_many(const Triangle& corners, std::span<const FanSearch::Partner> between) const {
  std::size_t inside = 0;
  for (const FanSearch::Partner& partner : between) {
    if (in_circle_perturbed(tin_.point(corners[0]), tin_.point(corners[1]), tin_.point(corners[2]),
                            tin_.point(partner.vertex)) &&
        ++inside > options_.max_order) {
      return true;
    }
  }
  return false;
}

void TriangleSearch::at(VertexId u, Scratch& scratch, std::vector<OrderTriangle>& found) const {
  const auto partners = scratch.search.partners(ground_, u, options_.max_order, pruning_);
  std::vector<FanSearch::Partner>& round = scratch.partners;
  round.assign(partners.begin(), partners.end());
  // Rounded angles that differ by more than their error decide; else the turn, exactly.
  std::sort(round.begin(), round.end(), [&](const auto& a, const auto& b) {
    constexpr double kAngleError = 1e-12;
    if (std::abs(a.angle - b.angle) > kAngleError) return a.angle < b.angle;
    return orientation(tin_.point(u), tin_.point(a.vertex), tin_.point(b.vertex)) > 0;
  });
  const std::size_t count = round.size();
  for (std::size_t i = 0; i < count; ++i) round.push_back(round[i]);
  for (std::size_t i = 0; i < count; ++i) from_side(u, i, scratch, found);
}

void TriangleSearch::from_side(VertexId u, std::size_t first, Scratch& scratch,
                               std::vector<OrderTriangle>& found) const {
  const std::span<const FanSearch::Partner> round = scratch.partners;
  const VertexId v = round[first].vertex;
  const bool from_lowest = pruning_ != FanPruning::NearEnds;
  if (from_lowest && v < u) return;
  VertexId bound;  // the partner so far that v sees nearest to u
  for (std::size_t i = first + 1; i < first + round.size() / 2; ++i) {
    const VertexId w = round[i].vertex;
    if (orientation(tin_.point(u), tin_.point(v), tin_.point(w)) <= 0) break;
    if (bound.valid() && orientation(tin_.point(v), tin_.point(bound), tin_.point(w)) <= 0) continue;
    bound = w;
    if (from_lowest ? w < u : !largest_angle_at(u, v, w)) continue;
    const Triangle corners{u, v, w};
    if (pruning_ != FanPruning::None && too_many(corners, round.subspan(first + 1, i - first - 1))) continue;
    if (!order_.is_valid(corners, scratch.workspace)) continue;
    const auto order =
        order_.order_up_to(corners, options_.definition, options_.max_order, scratch.workspace);
    if (!order) continue;
    OrderTriangle triangle{corners, static_cast<std::uint32_t>(*order)};
    std::rotate(triangle.corners.begin(), std::min_element(triangle.corners.begin(), triangle.corners.end()),
                triangle.corners.end());
    found.push_back(triangle);
  }
}

}  // namespace

bool can_list_order_triangles(const ConstrainedOrder& ground, const OrderTriangleOptions& options) {
  return pruning_for(options.definition, ground.unconstrained()) != FanPruning::None ||
         ground.ground().vertex_count() <= options.exhaustive_limit;
}

std::vector<OrderTriangle> find_order_triangles(const ConstrainedOrder& ground,
                                                const OrderTriangleOptions& options, Progress& progress) {
  const FanPruning pruning = pruning_for(options.definition, ground.unconstrained());
  const std::size_t vertices = ground.ground().vertex_count();
  if (!can_list_order_triangles(ground, options)) {
    throw Error(ErrorCode::SizeLimit,
                "listing all triangles of an order under " +
                    std::string(definition_name(options.definition)) +
                    " tries every pair of vertices that see each other: " + std::to_string(vertices) +
                    " vertices are more than the limit of " + std::to_string(options.exhaustive_limit) +
                    "; take fewer vertices, or one of the definitions from std to sees-opp");
  }
  const TriangleSearch search(ground, options, pruning);
  tbb::enumerable_thread_specific<Scratch> scratches;
  std::vector<std::vector<OrderTriangle>> found(vertices / kBlock + 1);
  for_each_block(vertices, kBlock, progress, {0, 1}, [&](std::size_t begin, std::size_t end) {
    Scratch& scratch = scratches.local();
    for (std::size_t u = begin; u < end; ++u) search.at(VertexId{u}, scratch, found[begin / kBlock]);
  });
  std::vector<OrderTriangle> all;
  for (auto& part : found) {
    all.insert(all.end(), part.begin(), part.end());
    part = {};
  }
  tbb::parallel_sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

}  // namespace thalweg
