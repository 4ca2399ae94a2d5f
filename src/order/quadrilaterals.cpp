// The first-order quadrilaterals.
//
// Based on: Silveira, van Kreveld, Towards a Definition of Higher Order Constrained Delaunay Triangulations,
// 2009, section 6; the test of an edge is ours.
//
// 1. Let uv be an edge of the constrained Delaunay triangulation that does not block, between triangles uvs
// and vut,
//    with s u t v strictly convex. It is a quadrilateral if triangles sut and tvs have order at most 1. Take
//    sut, with the disc D of its circumcircle. v lies in D, and counts under every definition. Is there
//    another vertex?
// 2. Only neighbours of v can be, as far as Pathcon reaches. Let f be the power of a point to the circle of
// sut minus
//    that to the circle of a Delaunay triangle; f is linear. With triangle uvs across su: f vanishes on the
//    line su, and f(v) < 0, so D beyond su is part of the disc of uvs, where no vertex can be reached.
//    Likewise across ut. With a triangle v x y at v whose x and y lie outside of D: f(v) < 0 < f(x), f(y).
//    Were z beyond xy in D, reached through xy, with f(z) < 0, then segment vz, on which f < 0, would cross
//    the line xy off the segment xy, at a point of D; but D is convex, meets the open segment, and holds
//    neither x nor y. So D beyond xy is part of the disc of v x y, where no vertex can be reached. The signs
//    are those of the perturbed points.
// 3. So: no neighbour of v but u, s, t in D: order 1 under all definitions but Std. A neighbour x in D beyond
// st
//    that sees u counts from Std to SeesOpp. Anything else is left to ConstrainedOrder, and happens next to
//    edges that block. Without such edges all definitions up to Sees3vtx agree.
// 4. The neighbours across the four sides come first: they refuse most edges.
// 5. Std: there is a triangulation of order at most 1 only if the constrained Delaunay triangulation is one;
// then both
//    triangles must pass the Std flood as well.
#include "base/parallel.hpp"

#include <thalweg/geometry/predicates.hpp>
#include <thalweg/order/constrained_order.hpp>
#include <thalweg/order/quadrilaterals.hpp>

#include <tbb/enumerable_thread_specific.h>

#include <atomic>
#include <optional>

namespace thalweg {

namespace {

constexpr std::size_t kBlock = 4096;

class QuadrilateralSearch {
 public:
  QuadrilateralSearch(const Tin& tin, const QuadrilateralOptions& options)
      : tin_(tin), definition_(options.definition), order_(tin, options.mode) {}

  [[nodiscard]] std::optional<Quadrilateral> at(HalfedgeId h, OrderWorkspace& workspace) const;
  [[nodiscard]] bool delaunay_fits(TriangleId t, OrderWorkspace& workspace) const {
    return order_.at_most(tin_.triangle(t), OrderDefinition::Std, 1, workspace);
  }
  [[nodiscard]] bool unconstrained() const { return order_.unconstrained(); }

 private:
  enum class Verdict { Fits, Refused, Unclear };
  [[nodiscard]] Verdict judge(const Triangle& corners, VertexId inner) const;
  [[nodiscard]] bool refused_across(const Triangle& corners, HalfedgeId side) const;
  [[nodiscard]] Verdict weigh(const Triangle& corners, VertexId x) const;
  [[nodiscard]] bool inside(const Triangle& corners, VertexId x) const {
    return in_circle_perturbed(tin_.point(corners[0]), tin_.point(corners[1]), tin_.point(corners[2]),
                               tin_.point(x));
  }
  [[nodiscard]] bool fits(const Triangle& corners, VertexId inner, OrderWorkspace& workspace) const;

  const Tin& tin_;
  OrderDefinition definition_;
  ConstrainedOrder order_;
};

// A neighbour x of the inner vertex lies inside: is that enough to refuse triangle s u t?
QuadrilateralSearch::Verdict QuadrilateralSearch::weigh(const Triangle& corners, VertexId x) const {
  if (definition_ == OrderDefinition::EmptyQuad) return Verdict::Unclear;
  if (order_.unconstrained()) return Verdict::Refused;
  if (definition_ == OrderDefinition::Sees3vtx) return Verdict::Unclear;
  const bool beyond_st = orientation(tin_.point(corners[2]), tin_.point(corners[0]), tin_.point(x)) < 0;
  return beyond_st && order_.sees(x, corners[1]) ? Verdict::Refused : Verdict::Unclear;
}

// Whether the vertex across a side of the quadrilateral that ends at the inner vertex is enough to refuse.
bool QuadrilateralSearch::refused_across(const Triangle& corners, HalfedgeId side) const {
  const HalfedgeId outer = tin_.twin(side);
  if (!outer.valid()) return false;
  const VertexId x = tin_.apex(outer);
  if (x == corners[0] || x == corners[1] || x == corners[2]) return false;
  return inside(corners, x) && weigh(corners, x) == Verdict::Refused;
}

// Triangle s u t with v inside its circle.
QuadrilateralSearch::Verdict QuadrilateralSearch::judge(const Triangle& corners, VertexId inner) const {
  const auto is_corner = [&](VertexId x) { return x == corners[0] || x == corners[1] || x == corners[2]; };
  bool unclear = false;
  const auto refuses = [&](VertexId x) {
    if (is_corner(x) || !inside(corners, x)) return false;
    const Verdict verdict = weigh(corners, x);
    unclear = unclear || verdict == Verdict::Unclear;
    return verdict == Verdict::Refused;
  };
  for (const HalfedgeId h : tin_.outgoing(inner)) {
    if (refuses(tin_.target(h)) || (tin_.on_rim(Tin::previous(h)) && refuses(tin_.apex(h)))) {
      return Verdict::Refused;
    }
  }
  return unclear ? Verdict::Unclear : Verdict::Fits;
}

bool QuadrilateralSearch::fits(const Triangle& corners, VertexId inner, OrderWorkspace& workspace) const {
  const Verdict verdict = judge(corners, inner);
  if (verdict == Verdict::Refused) return false;
  const bool decided =
      verdict == Verdict::Fits && (definition_ != OrderDefinition::Std || order_.unconstrained());
  return decided || order_.at_most(corners, definition_, 1, workspace);
}

std::optional<Quadrilateral> QuadrilateralSearch::at(HalfedgeId h, OrderWorkspace& workspace) const {
  const HalfedgeId twin = tin_.twin(h);
  if (!twin.valid() || twin < h || tin_.constrained(h)) return std::nullopt;
  const Quadrilateral q{tin_.apex(h), tin_.origin(h), tin_.apex(twin), tin_.origin(twin), h};
  const Point2 s = tin_.point(q.s);
  const Point2 t = tin_.point(q.t);
  if (orientation(s, tin_.point(q.u), t) <= 0 || orientation(t, tin_.point(q.v), s) <= 0) return std::nullopt;
  const Triangle at_u{q.s, q.u, q.t}, at_v{q.t, q.v, q.s};
  if (refused_across(at_u, Tin::next(h)) || refused_across(at_u, Tin::previous(twin)) ||
      refused_across(at_v, Tin::next(twin)) || refused_across(at_v, Tin::previous(h))) {
    return std::nullopt;
  }
  if (!fits(at_u, q.v, workspace) || !fits(at_v, q.u, workspace)) return std::nullopt;
  return q;
}

}  // namespace

std::vector<Quadrilateral> find_quadrilaterals(const Tin& ground, const QuadrilateralOptions& options,
                                               const Progress& progress) {
  const QuadrilateralSearch search(ground, options);
  tbb::enumerable_thread_specific<OrderWorkspace> workspaces;
  if (options.definition == OrderDefinition::Std && !search.unconstrained()) {
    std::atomic<bool> fits{true};
    for_each_block(ground.triangle_count(), kBlock, progress, [&](std::size_t begin, std::size_t end) {
      for (std::size_t t = begin; t < end && fits.load(std::memory_order_relaxed); ++t) {
        if (!search.delaunay_fits(TriangleId{t}, workspaces.local())) fits = false;
      }
    });
    if (!fits) return {};
  }

  std::vector<std::vector<Quadrilateral>> found(ground.halfedge_count() / kBlock + 1);
  for_each_block(ground.halfedge_count(), kBlock, progress, [&](std::size_t begin, std::size_t end) {
    std::vector<Quadrilateral>& here = found[begin / kBlock];
    OrderWorkspace& workspace = workspaces.local();
    for (std::size_t h = begin; h < end; ++h) {
      if (const auto q = search.at(HalfedgeId{h}, workspace)) here.push_back(*q);
    }
  });
  std::vector<Quadrilateral> all;
  std::size_t total = 0;
  for (const auto& part : found) total += part.size();
  all.reserve(total);
  for (const auto& part : found) all.insert(all.end(), part.begin(), part.end());
  return all;
}

}  // namespace thalweg
