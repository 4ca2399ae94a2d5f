// The first-order quadrilaterals.
//
// Based on: Silveira, van Kreveld, Towards a Definition of Higher Order Constrained Delaunay Triangulations,
// 2009, section 6; the test of an edge is ours.
//
// 1. Let uv be an edge of the constrained Delaunay triangulation that does not block, between triangles uvs
//    and vut, with s u t v strictly convex. It is a quadrilateral if triangles sut and tvs have order at most
//    one. Take sut, with the disc D of its circumcircle. v lies in D, and counts under every definition. Is
//    there another vertex?
// 2. Only neighbours of v can be, as far as Pathcon reaches. Let f be the power of a point to the circle of
//    sut minus that to the circle of a Delaunay triangle; f is linear. With triangle uvs across su: f
//    vanishes on the line su, and f(v) < 0, so D beyond su is part of the disc of uvs, where no vertex can be
//    reached. Likewise across ut. With a triangle v x y at v whose x and y lie outside of D: f(v) < 0 < f(x),
//    f(y). Were z beyond xy in D, reached through xy, with f(z) < 0, then segment vz, on which f < 0, would
//    cross the line xy off the segment xy, at a point of D; but D is convex, meets the open segment, and
//    holds neither x nor y. So D beyond xy is part of the disc of v x y, where no vertex can be reached. The
//    signs are those of the perturbed points.
// 3. So: no neighbour of v but u, s, t in D: order 1 under all definitions but Std. A neighbour x in D beyond
//    st that sees u counts from Std to SeesOpp. Anything else is left to ConstrainedOrder, and happens next
//    to edges that block. Without such edges all definitions up to Sees3vtx agree.
// 4. The neighbours across the four sides come first, of these the ones that need no exact arithmetic: they
//    refuse most edges.
// 5. Std: there is a triangulation of order at most 1 only if the constrained Delaunay triangulation is one;
//    then both triangles must pass the Std flood as well.
#include "base/parallel.hpp"
#include "order/quadrilateral_filter.hpp"

#include <thalweg/geometry/predicates.hpp>
#include <thalweg/mesh/rim.hpp>
#include <thalweg/order/constrained_order.hpp>
#include <thalweg/order/quadrilaterals.hpp>

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <array>
#include <atomic>

namespace thalweg {

namespace {

constexpr std::size_t kBlock = 4096;

class QuadrilateralSearch {
 public:
  QuadrilateralSearch(const Tin& tin, const QuadrilateralOptions& options)
      : tin_(tin), definition_(options.definition), order_(tin, options.mode), rim_(rim_halfedges(tin)) {}

  [[nodiscard]] bool is_quadrilateral(const EdgeSurroundings& edge, OrderWorkspace& workspace) const;
  [[nodiscard]] bool delaunay_fits(TriangleId t, OrderWorkspace& workspace) const {
    return order_.at_most(tin_.triangle(t), OrderDefinition::Std, 1, workspace);
  }
  [[nodiscard]] bool unconstrained() const { return order_.unconstrained(); }

 private:
  enum class Verdict { Fits, Unclear, Refused };
  /// One of the new triangles, sut or tvs.
  struct Half {
    Triangle corners;
    VertexId inner;                  ///< the corner that it leaves out
    HalfedgeId side, last;           ///< of the inner vertex: to corners[0], from corners[2]; or the reverse
    std::array<VertexId, 2> beyond;  ///< the vertices across them
    std::array<std::int8_t, 2> inside;
  };
  static bool is_corner(const Half& half, VertexId x) {
    return x == half.corners[0] || x == half.corners[1] || x == half.corners[2];
  }
  [[nodiscard]] Verdict judge_inside(const Half& half) const;
  [[nodiscard]] Verdict judge_unclear(const Half& half) const;
  [[nodiscard]] Verdict judge_others(const Half& half) const;
  [[nodiscard]] Verdict judge(const Half& half, VertexId x) const;
  [[nodiscard]] Verdict weigh(const Triangle& corners, VertexId x) const;
  [[nodiscard]] Verdict weigh_beyond(const Half& half, std::size_t i) const;
  [[nodiscard]] bool fits(const Half& half, Verdict beyond, OrderWorkspace& workspace) const;

  const Tin& tin_;
  OrderDefinition definition_;
  ConstrainedOrder order_;
  std::vector<HalfedgeId> rim_;
};

// A neighbour x of the inner vertex lies inside: is that enough to refuse triangle s u t?
QuadrilateralSearch::Verdict QuadrilateralSearch::weigh(const Triangle& corners, VertexId x) const {
  if (definition_ == OrderDefinition::EmptyQuad) return Verdict::Unclear;
  if (order_.unconstrained()) return Verdict::Refused;
  if (definition_ == OrderDefinition::Sees3vtx) return Verdict::Unclear;
  const bool beyond_st = orientation(tin_.point(corners[2]), tin_.point(corners[0]), tin_.point(x)) < 0;
  return beyond_st && order_.sees(x, corners[1]) ? Verdict::Refused : Verdict::Unclear;
}

// The same for the vertex across a side at the inner vertex. Where what joins it to the opposite corner
// crosses that side, nothing else can be in the way: from there on it runs within the quadrilateral.
QuadrilateralSearch::Verdict QuadrilateralSearch::weigh_beyond(const Half& half, std::size_t i) const {
  const auto& [a, b, c] = half.corners;
  const VertexId x = half.beyond[i];
  if (definition_ <= OrderDefinition::SeesOpp && !order_.unconstrained()) {
    const Point2 from = tin_.point(x), to = tin_.point(b);
    const int of_outer = orientation(from, to, tin_.point(i == 0 ? a : c));
    const int of_inner = orientation(from, to, tin_.point(half.inner));
    const bool beyond_st = orientation(tin_.point(c), tin_.point(a), from) < 0;
    if (beyond_st && of_outer * of_inner < 0) {
      return tin_.constrained(i == 0 ? half.side : half.last) ? Verdict::Unclear : Verdict::Refused;
    }
  }
  return weigh(half.corners, x);
}

// The vertices across the two sides at the inner vertex, as far as the filter found them inside.
QuadrilateralSearch::Verdict QuadrilateralSearch::judge_inside(const Half& half) const {
  Verdict worst = Verdict::Fits;
  for (std::size_t i = 0; i < 2 && worst != Verdict::Refused; ++i) {
    if (half.inside[i] != kInside || is_corner(half, half.beyond[i])) continue;
    worst = std::max(worst, weigh_beyond(half, i));
  }
  return worst;
}

// The same vertices, as far as the filter says nothing of them.
QuadrilateralSearch::Verdict QuadrilateralSearch::judge_unclear(const Half& half) const {
  Verdict worst = Verdict::Fits;
  for (std::size_t i = 0; i < 2 && worst != Verdict::Refused; ++i) {
    if (half.inside[i] == kUnclear) worst = std::max(worst, judge(half, half.beyond[i]));
  }
  return worst;
}

QuadrilateralSearch::Verdict QuadrilateralSearch::judge(const Half& half, VertexId x) const {
  const auto& [a, b, c] = half.corners;
  if (is_corner(half, x) ||
      !in_circle_perturbed(tin_.point(a), tin_.point(b), tin_.point(c), tin_.point(x))) {
    return Verdict::Fits;
  }
  return weigh(half.corners, x);
}

// The other neighbours of the inner vertex: from the triangle across one side, turn by turn, to that across
// the other. On the rim, where there are gaps, those of all fans are asked.
QuadrilateralSearch::Verdict QuadrilateralSearch::judge_others(const Half& half) const {
  Verdict worst = Verdict::Fits;
  const auto refuses = [&](VertexId x) {
    if (x != half.beyond[0] && x != half.beyond[1]) worst = std::max(worst, judge(half, x));
    return worst == Verdict::Refused;
  };
  const HalfedgeId end = tin_.twin(half.last);
  HalfedgeId outer = tin_.twin(half.side);
  while (outer.valid()) {
    const HalfedgeId spoke = Tin::next(outer);
    if (spoke == end) return worst;
    if (refuses(tin_.target(spoke))) return worst;
    outer = tin_.twin(spoke);
  }
  auto first = std::ranges::lower_bound(rim_, half.inner, {}, [&](HalfedgeId h) { return tin_.origin(h); });
  for (; first != rim_.end() && tin_.origin(*first) == half.inner; ++first) {
    if (refuses(tin_.target(*first))) return worst;
    HalfedgeId spoke = *first;
    do {
      if (refuses(tin_.apex(spoke))) return worst;
      spoke = tin_.twin(Tin::previous(spoke));
    } while (spoke.valid());
  }
  return worst;
}

bool QuadrilateralSearch::fits(const Half& half, Verdict beyond, OrderWorkspace& workspace) const {
  const Verdict verdict = std::max(beyond, judge_others(half));
  if (verdict == Verdict::Refused) return false;
  const bool decided =
      verdict == Verdict::Fits && (definition_ != OrderDefinition::Std || order_.unconstrained());
  return decided || order_.at_most(half.corners, definition_, 1, workspace);
}

bool QuadrilateralSearch::is_quadrilateral(const EdgeSurroundings& edge, OrderWorkspace& workspace) const {
  const auto& [s, u, t, v, h] = edge.quadrilateral;
  const auto& [vs, tv, ut, su] = edge.sides;
  const auto& beyond = edge.beyond;
  const Half at_u{{s, u, t}, v, vs, tv, {beyond[0], beyond[1]}, {edge.inside[0], edge.inside[1]}};
  const Half at_v{{t, v, s}, u, ut, su, {beyond[2], beyond[3]}, {edge.inside[2], edge.inside[3]}};
  std::array<Verdict, 2> verdict{};
  for (const auto judge_some : {&QuadrilateralSearch::judge_inside, &QuadrilateralSearch::judge_unclear}) {
    for (std::size_t i = 0; i < 2; ++i) {
      verdict[i] = std::max(verdict[i], (this->*judge_some)(i == 0 ? at_u : at_v));
      if (verdict[i] == Verdict::Refused) return false;
    }
  }
  return fits(at_u, verdict[0], workspace) && fits(at_v, verdict[1], workspace);
}

// The quadrilaterals of a range of halfedges.
void find_among(const QuadrilateralSearch& search, const Tin& tin, std::size_t begin, std::size_t end,
                OrderWorkspace& workspace, std::vector<Quadrilateral>& found) {
  QuadrilateralFilter filter(tin);
  std::array<HalfedgeId, QuadrilateralFilter::kMost> edges;
  for (std::size_t h = begin; h < end;) {
    std::size_t count = 0;
    for (; h < end && count < edges.size(); ++h) {
      const HalfedgeId twin = tin.twin(HalfedgeId{h});
      if (twin.valid() && HalfedgeId{h} < twin && !tin.constrained(HalfedgeId{h}))
        edges[count++] = HalfedgeId{h};
    }
    for (const EdgeSurroundings& edge : filter.look(std::span(edges).first(count))) {
      if (search.is_quadrilateral(edge, workspace)) found.push_back(edge.quadrilateral);
    }
  }
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
    find_among(search, ground, begin, end, workspaces.local(), found[begin / kBlock]);
  });
  std::vector<Quadrilateral> all;
  std::size_t total = 0;
  for (const auto& part : found) total += part.size();
  all.reserve(total);
  for (const auto& part : found) all.insert(all.end(), part.begin(), part.end());
  return all;
}

}  // namespace thalweg
