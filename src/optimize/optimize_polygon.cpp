// A polygon's triangulations by dynamic programming over edges.
//
// Based on: Silveira, van Kreveld, Optimal higher order Delaunay triangulations of polygons, 2009. An edge of
// a triangulation parts a simple polygon, and what is best beyond it does not depend on what is on this side,
// but for the terms of the two triangles at the edge.
// 1. Candidates are the triangles of order at most k, each seen from each of its sides: a *view* is one
//    of them and the side that is its base. Its cost is its own term and, for each of the two other
//    sides that is no edge of the polygon, the least cost of a view that has this side as its base from
//    beyond, with the term of the two triangles. Sums and largest values of parts never get worse by a
//    part that gets better.
// 2. A view needs those beyond its other sides, which cut off fewer vertices than its base does: that is
//    the order in which views are taken. One edge of the polygon is the base of the whole.
// 3. Of equal costs the view counts whose apex comes first by (x, y), and the whole stands on the edge
//    at the first vertex: nothing depends on ids. That departs from the paper, which leaves ties open.
#include "optimize/face_terms.hpp"
#include "optimize/sums.hpp"

#include <thalweg/base/error.hpp>
#include <thalweg/optimize/optimize_polygon.hpp>
#include <thalweg/order/constrained_order.hpp>

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <span>
#include <string>
#include <utility>

namespace thalweg {

namespace {

/// The vertices of the rim, counter-clockwise. Throws: Error{Unsupported} if it is not one ring of them all.
std::vector<VertexId> ring_of(const Tin& polygon) {
  const auto refuse = [](const char* what) {
    throw Error(ErrorCode::Unsupported,
                std::string("a polygon to be triangulated at its best must be simple, with no hole and no "
                            "vertex inside: ") +
                    what + "; take optimize_faces, which has no such limit");
  };
  std::vector<VertexId> next(polygon.vertex_count());
  std::size_t edges = 0;
  VertexId start;
  for (std::size_t i = 0; i < polygon.halfedge_count(); ++i) {
    const HalfedgeId h{i};
    if (!polygon.on_rim(h)) continue;
    if (next[polygon.origin(h).index()].valid()) refuse("its rim meets itself");
    next[polygon.origin(h).index()] = polygon.target(h);
    start = polygon.origin(h);
    ++edges;
  }
  std::vector<VertexId> ring;
  if (edges > 0) {
    VertexId at = start;
    do {
      ring.push_back(at);
      at = next[at.index()];
    } while (at != start);
  }
  if (ring.size() < edges) refuse("it has a hole, or more than one part");
  if (ring.size() < polygon.vertex_count() || ring.size() < 3) refuse("a vertex is not on its rim");
  return ring;
}

/// A directed edge with the polygon's part that is wanted on its left.
struct Base {
  std::uint32_t from = 0, to = 0;
};

class PolygonProgram {
 public:
  PolygonProgram(const Tin& polygon, std::vector<OrderTriangle> triangles, const PolygonMeasure& measure,
                 const Progress& progress)
      : polygon_(polygon), triangles_(std::move(triangles)), measure_(measure), progress_(progress) {
    ring_ = ring_of(polygon);
    place_.resize(ring_.size());
    for (std::uint32_t i = 0; i < ring_.size(); ++i) place_[ring_[i].index()] = i;
    sort_views();
    cost_.resize(views_.size());
    for (const OrderTriangle& t : triangles_)
      own_.push_back(measure_.of_triangle ? to_steps(measure_.of_triangle(t.corners)) : 0);
  }

  std::optional<PolygonTriangulation> run() {
    const std::vector<std::uint32_t> turn = by_span();
    for (std::size_t i = 0; i < turn.size(); ++i) {
      if (i % 4096 == 0) progress_.check();
      settle(turn[i]);
    }
    const auto before = [&](VertexId a, VertexId b) { return comes_first(a, b); };
    const VertexId first = *std::min_element(ring_.begin(), ring_.end(), before);
    const VertexId second = ring_[(place_[first.index()] + 1) % ring_.size()];
    const std::optional<std::uint32_t> whole = best_on({first.value(), second.value()}, std::nullopt);
    if (!whole) return std::nullopt;
    return collect(*whole);
  }

 private:
  void sort_views() {
    const auto count = static_cast<std::uint32_t>(3 * triangles_.size());
    first_.assign(ring_.size() + 1, 0);
    for (std::uint32_t view = 0; view < count; ++view) ++first_[base_of(view).from + 1];
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    views_.resize(count);
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    for (std::uint32_t view = 0; view < count; ++view) {
      const Base base = base_of(view);
      views_[next[base.from]++] = {base.to, view};
    }
    for (std::size_t v = 0; v < ring_.size(); ++v) {
      std::sort(views_.begin() + first_[v], views_.begin() + first_[v + 1]);
    }
  }

  /// The views in the order in which they are taken, by counting.
  [[nodiscard]] std::vector<std::uint32_t> by_span() const {
    std::vector<std::uint32_t> next(ring_.size() + 1, 0), turn(views_.size());
    for (std::uint32_t view = 0; view < turn.size(); ++view) ++next[span(base_of(view)) + 1];
    std::partial_sum(next.begin(), next.end(), next.begin());
    for (std::uint32_t view = 0; view < turn.size(); ++view) turn[next[span(base_of(view))]++] = view;
    return turn;
  }

  struct Cost {
    bool possible = false;
    WideSteps value = 0;
    std::array<std::uint32_t, 3> beyond{};  ///< views beyond the triangle's sides
  };
  static constexpr std::uint32_t kNothing = 0xffffffffU;

  [[nodiscard]] const Triangle& corners(std::uint32_t view) const { return triangles_[view / 3].corners; }
  [[nodiscard]] Base base_of(std::uint32_t view) const {
    const Triangle& t = corners(view);
    return {t[view % 3].value(), t[(view + 1) % 3].value()};
  }
  [[nodiscard]] VertexId apex(std::uint32_t view) const { return corners(view)[(view % 3 + 2) % 3]; }
  [[nodiscard]] bool comes_first(VertexId a, VertexId b) const {
    const Point2 p = polygon_.point(a), q = polygon_.point(b);
    return std::pair(p.x, p.y) < std::pair(q.x, q.y);
  }
  /// Edges of the polygon on the left.
  [[nodiscard]] std::size_t span(const Base& base) const {
    const std::size_t n = ring_.size();
    return (place_[base.from] + n - place_[base.to]) % n;
  }
  [[nodiscard]] bool on_ring(const Base& outer) const { return span(outer) == 1; }

  [[nodiscard]] WideSteps nothing() const {
    return measure_.combine == PolygonMeasure::Combine::Sum ? WideSteps{0}
                                                            : std::numeric_limits<std::int64_t>::min();
  }
  [[nodiscard]] WideSteps combined(WideSteps a, WideSteps b) const {
    return measure_.combine == PolygonMeasure::Combine::Sum ? a + b : std::max(a, b);
  }

  /// The best view on a base, with the term of its triangle and the one on the other side, if that counts.
  [[nodiscard]] std::optional<std::uint32_t> best_on(const Base& base,
                                                     std::optional<std::uint32_t> other) const {
    std::optional<std::uint32_t> best;
    WideSteps least = 0;
    const auto row = std::span(views_).subspan(first_[base.from], first_[base.from + 1] - first_[base.from]);
    for (auto at = std::lower_bound(row.begin(), row.end(), std::pair(base.to, std::uint32_t{0}));
         at != row.end() && at->first == base.to; ++at) {
      const std::uint32_t view = at->second;
      if (!cost_[view].possible) continue;
      const WideSteps value = other ? with_neighbour(view, *other) : cost_[view].value;
      if (best && (least < value || (least == value && !comes_first(apex(view), apex(*best))))) continue;
      best = view;
      least = value;
    }
    return best;
  }

  [[nodiscard]] WideSteps with_neighbour(std::uint32_t view, std::uint32_t other) const {
    const WideSteps cost = cost_[view].value;
    if (!measure_.of_neighbours) return cost;
    return combined(cost, to_steps(measure_.of_neighbours(corners(view), corners(other))));
  }

  void settle(std::uint32_t view) {
    Cost cost{.possible = true,
              .value = measure_.of_triangle ? WideSteps{own_[view / 3]} : nothing(),
              .beyond = {kNothing, kNothing, kNothing}};
    for (std::uint32_t more = 1; more < 3; ++more) {
      const std::uint32_t side = view / 3 * 3 + (view + more) % 3;
      const Base inner = base_of(side), outer{inner.to, inner.from};
      if (on_ring(outer)) continue;
      const auto best = best_on(outer, view);
      if (!best) return;
      cost.beyond[side % 3] = *best;
      cost.value = combined(cost.value, with_neighbour(*best, view));
    }
    cost_[view] = cost;
  }

  [[nodiscard]] PolygonTriangulation collect(std::uint32_t whole) const {
    PolygonTriangulation result;
    result.candidates = triangles_.size();
    std::vector<std::uint32_t> open = {whole};
    while (!open.empty()) {
      const std::uint32_t view = open.back();
      open.pop_back();
      result.triangles.push_back(triangles_[view / 3]);
      for (const std::uint32_t beyond : cost_[view].beyond) {
        if (beyond != kNothing) open.push_back(beyond);
      }
    }
    std::sort(result.triangles.begin(), result.triangles.end());
    const WideSteps value = cost_[whole].value;
    const bool none = measure_.combine == PolygonMeasure::Combine::Largest && value == nothing();
    result.value = none ? std::numeric_limits<double>::lowest() : static_cast<double>(value) / kStepsPerUnit;
    return result;
  }

  const Tin& polygon_;
  std::vector<OrderTriangle> triangles_;
  const PolygonMeasure& measure_;
  const Progress& progress_;
  std::vector<VertexId> ring_;        ///< counter-clockwise
  std::vector<std::uint32_t> place_;  ///< by vertex: in the ring
  std::vector<std::uint32_t> first_;  ///< by vertex: its first view
  /// By the vertex at which the base starts: the one at which it ends, and the view; ascending.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> views_;
  std::vector<std::int64_t> own_;  ///< by triangle
  std::vector<Cost> cost_;         ///< by view: 3 * triangle + side
};

}  // namespace

std::optional<PolygonTriangulation> optimize_polygon(const Tin& polygon,
                                                     const PolygonOptimizeOptions& options,
                                                     Progress& progress) {
  const ConstrainedOrder order(polygon, GroundMode::Polygon);
  return PolygonProgram(
             polygon,
             find_order_triangles(order, {.definition = options.definition, .max_order = options.max_order},
                                  progress),
             options.measure, progress)
      .run();
}

PolygonMeasure measure_of(const Tin& polygon, const Objective& objective, const PolygonScale& scale) {
  const TermLevel level = level_of(objective, std::nullopt, nullptr);
  bool triangles = false, edges = false;
  for (const TermLevel::Part& part : level.parts) {
    triangles = triangles || part.declaration->traits.coupling == Coupling::OneTriangle;
    edges = edges || part.declaration->traits.coupling == Coupling::Edge;
    const bool other = part.declaration->traits.coupling > Coupling::Edge;
    if (other || part.declaration->against_reference != nullptr) {
      throw Error(ErrorCode::Unsupported, "criterion " + objective.name() +
                                              " is none of triangles and neighbours alone; take one that is, "
                                              "such as normal-angle-sum or edge-length");
    }
  }
  if (level.parts.empty()) {
    throw Error(ErrorCode::Unsupported,
                "criterion " + objective.name() + " is no sum of terms, nor the worst of them");
  }
  const Scale of{scale.horizontal_metres_per_unit, scale.vertical_metres_per_unit};
  const auto face = [&polygon, of](const Triangle& t) {
    return make_face(corner_of(polygon, t[0]), corner_of(polygon, t[1]), corner_of(polygon, t[2]), of);
  };
  PolygonMeasure measure;
  measure.combine = objective.is_extreme() ? PolygonMeasure::Combine::Largest : PolygonMeasure::Combine::Sum;
  const auto in_units = [](std::int64_t steps) { return static_cast<double>(steps) / kStepsPerUnit; };
  if (triangles) {
    measure.of_triangle = [&polygon, level, of, face, in_units](const Triangle& t) {
      return in_units(level.of(face(t), of, polygon));
    };
  }
  if (edges) {
    measure.of_neighbours = [&polygon, level, of, face, in_units](const Triangle& a, const Triangle& b) {
      return in_units(level.of(face(a), face(b), of, polygon));
    };
  }
  return measure;
}

}  // namespace thalweg
