// All valid triangles of order at most k.
//
// 1. fan_search.cpp finds, for each fan of ground around a vertex u, the vertices that can share such a
//    triangle with u. Under Std ... SeesVtx a triangle is found from each of its corners: it is taken from
//    the smallest id. Under ConfEdge and SeesOpp it is sure to be found only from the corner of its largest
//    angle; rounding may tie corners, so it may come twice.
// 2. Let v and w, counter-clockwise, be two partners of u with less than half a turn between. Going round
//    from v, those w come into question to which v looks past all partners between, on the side of u: else
//    one of these lies in triangle uvw. This leaves few.
// 3. Under Std ... SeesVtx each vertex that u sees inside the disc of uvw, in this fan and less than half a
//    turn from v and w, counts, and inversion about u tells all these at once: they lie beyond the line
//    through v and w. A disc through u with at most k of them inside has none that is no partner, for the
//    disc that is shrunk towards u until such a vertex lies on its rim holds no more. So where at most k
//    partners are inside, all that u sees in the disc is known, uvw is valid if 2 says so (a vertex in
//    triangle uvw, or an end of an edge that crosses it, is or hides one there that u sees), and where no
//    edge that blocks meets the disc either, its order is known, too: u sees all of it.
// 4. Under ConfEdge and SeesOpp those between v and w count. With no edge that blocks all count, as in 3.
#include "base/parallel.hpp"
#include "base/release.hpp"
#include "delaunay/spatial_order.hpp"
#include "order/blocking_cells.hpp"
#include "order/circumdisc.hpp"
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

/// A partner of u.
struct Partner {
  VertexId vertex;
  Point2 at;
  double x = 0, y = 0;  ///< inverted about u
  double length = 0;    ///< of that, or more
  double turn = 0;
};

struct Scratch {
  FanSearch search;
  OrderWorkspace workspace;
  std::vector<Partner> partners;
  std::vector<Partner> behind;  ///< one that u sees
};

class TriangleSearch {
 public:
  TriangleSearch(const ConstrainedOrder& order, const OrderTriangleOptions& options, FanPruning pruning)
      : order_(order),
        tin_(order.ground()),
        ground_(tin_, order.mode()),
        blocking_(ground_),
        options_(options),
        pruning_(pruning) {}

  void at(VertexId u, Scratch& scratch, std::vector<OrderTriangle>& found) const;

 private:
  /// A fan, and two partners in it that come into question; `next` may count past the last, around.
  struct Pair {
    VertexId u;
    std::span<const Partner> partners;
    std::span<const Partner> behind;
    bool closed = false;
    std::size_t first = 0, next = 0;
    [[nodiscard]] const Partner& v() const { return partners[first]; }
    [[nodiscard]] const Partner& w() const { return partners[next % partners.size()]; }
    [[nodiscard]] Triangle corners() const { return {u, v().vertex, w().vertex}; }
  };
  void from_side(Pair pair, Scratch& scratch, std::vector<OrderTriangle>& found) const;
  [[nodiscard]] bool largest_angle_at(VertexId u, VertexId v, VertexId w) const;
  [[nodiscard]] std::size_t count_inside(const Pair& pair, std::span<const Partner> among) const;
  [[nodiscard]] std::size_t count_between(const Pair& pair) const;
  [[nodiscard]] std::optional<std::size_t> order_of(const Pair& pair, OrderWorkspace& workspace) const;

  const ConstrainedOrder& order_;
  const Tin& tin_;
  detail::Ground ground_;
  detail::BlockingCells blocking_;
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

// Stops at more than the largest order. The bound of the error is far above that of the few roundings, each
// of at most 2^-53 of a product of lengths, that the inverses and the products have undergone.
std::size_t TriangleSearch::count_inside(const Pair& pair, std::span<const Partner> among) const {
  constexpr double kError = 1e-13;
  constexpr double kHalfTurn = 3.14159265358979323846;
  const Partner &v = pair.v(), &w = pair.w();
  const double across_x = w.y - v.y, across_y = v.x - w.x;
  const double level = across_x * v.x + across_y * v.y;
  const double unit = kError * (v.length + w.length);
  std::size_t inside = 0;
  for (const Partner& p : among) {
    const double beyond = across_x * p.x + across_y * p.y - level;
    const double error = unit * (p.length + v.length);
    if (beyond < -error) continue;
    if (!pair.closed && (p.turn <= w.turn - kHalfTurn || p.turn >= v.turn + kHalfTurn)) continue;
    const bool sure = beyond > error;
    if (!sure && (p.vertex == v.vertex || p.vertex == w.vertex)) continue;
    if (!sure && !in_circle_perturbed(tin_.point(pair.u), v.at, w.at, p.at)) continue;
    if (++inside > options_.max_order) break;
  }
  return inside;
}

// Partners between v and w lie beyond vw or outside of the circle: u sees them.
std::size_t TriangleSearch::count_between(const Pair& pair) const {
  std::size_t inside = 0;
  for (std::size_t i = pair.first + 1; i < pair.next; ++i) {
    const Point2 p = pair.partners[i % pair.partners.size()].at;
    if (!in_circle_perturbed(tin_.point(pair.u), pair.v().at, pair.w().at, p)) continue;
    if (++inside > options_.max_order) break;
  }
  return inside;
}

std::optional<std::size_t> TriangleSearch::order_of(const Pair& pair, OrderWorkspace& workspace) const {
  const std::size_t most = options_.max_order;
  const Triangle corners = pair.corners();
  if (pruning_ != FanPruning::None) {
    const bool visible = pruning_ == FanPruning::Visible;
    const std::size_t inside = visible ? count_inside(pair, pair.partners) : count_between(pair);
    if (inside > most) return std::nullopt;
    const detail::Circumdisc disc(tin_.point(pair.u), pair.v().at, pair.w().at);
    if (blocking_.free(disc.box())) {
      const std::size_t all =
          (visible ? inside : count_inside(pair, pair.partners)) + count_inside(pair, pair.behind);
      return all <= most ? std::optional(all) : std::nullopt;
    }
  }
  const bool half = !pair.closed && pair.partners.back().turn < 3;  // less than half a turn
  const bool known = pruning_ == FanPruning::Visible && (pair.closed || half);
  if (!known && !order_.is_valid(corners, workspace)) return std::nullopt;
  return order_.order_up_to(corners, options_.definition, most, workspace);
}

void TriangleSearch::at(VertexId u, Scratch& scratch, std::vector<OrderTriangle>& found) const {
  scratch.search.start(ground_, u, options_.max_order, pruning_);
  while (scratch.search.next_fan()) {
    const auto take = [&](std::span<const FanSearch::Partner> from, std::vector<Partner>& to) {
      to.clear();
      for (const auto& [vertex, inverse] : from) {
        const double length = std::abs(inverse.x) + std::abs(inverse.y);
        to.push_back({vertex, tin_.point(vertex), inverse.x, inverse.y, length, inverse.turn});
      }
    };
    take(scratch.search.partners(), scratch.partners);
    take(scratch.search.behind(), scratch.behind);
    for (std::size_t i = 0; i < scratch.partners.size(); ++i) {
      from_side({u, scratch.partners, scratch.behind, scratch.search.closed(), i, i}, scratch, found);
    }
  }
}

void TriangleSearch::from_side(Pair pair, Scratch& scratch, std::vector<OrderTriangle>& found) const {
  const VertexId u = pair.u, v = pair.v().vertex;
  const bool from_lowest = pruning_ != FanPruning::NearEnds;
  if (from_lowest && v < u) return;
  const Point2 at_u = tin_.point(u), at_v = pair.v().at;
  const std::size_t count = pair.partners.size();
  std::optional<Point2> bound;  // the partner so far that v sees nearest to u
  for (pair.next = pair.first + 1; pair.next < (pair.closed ? pair.first : 0) + count; ++pair.next) {
    const Point2 at_w = pair.w().at;
    if (orientation(at_u, at_v, at_w) <= 0) break;
    if (bound && orientation(at_v, *bound, at_w) <= 0) continue;
    bound = at_w;
    const VertexId w = pair.w().vertex;
    if (from_lowest ? w < u : !largest_angle_at(u, v, w)) continue;
    const auto order = order_of(pair, scratch.workspace);
    if (!order) continue;
    OrderTriangle triangle{pair.corners(), static_cast<std::uint32_t>(*order)};
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
  // Along a curve: what one vertex loads is still in the cache for the next one.
  const std::vector<std::uint32_t> order = hilbert_order(ground.ground().points(), progress);
  tbb::enumerable_thread_specific<Scratch> scratches;
  std::vector<std::vector<OrderTriangle>> found(vertices / kBlock + 1);
  for_each_block(vertices, kBlock, progress, {0, 1}, [&](std::size_t begin, std::size_t end) {
    Scratch& scratch = scratches.local();
    std::vector<OrderTriangle>& here = found[begin / kBlock];
    for (std::size_t i = begin; i < end; ++i) search.at(VertexId{order[i]}, scratch, here);
  });
  std::vector<OrderTriangle> all;
  for (auto& part : found) {
    all.insert(all.end(), part.begin(), part.end());
    release(part);
  }
  tbb::parallel_sort(all.begin(), all.end());
  if (pruning != FanPruning::NearEnds) return all;  // each found once, at its smallest id
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

}  // namespace thalweg
