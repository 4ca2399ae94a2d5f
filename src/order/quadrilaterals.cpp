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
// 3. So: no neighbour of v but u, s, t in D: order 1 under all definitions but Std.
// 4. A neighbour x in D lies beyond st, for vx does not cross the quadrilateral. If no edge that blocks ends
//    in v, a vertex other than v counts from Std to SeesOpp: turn the line of sight from u to v, which is
//    free, towards x, with its far end on the edge vx. It gets to x, or first meets an end of an edge that
//    blocks, nothing being nearer on it; either lies in D beyond st, and sees u.
// 5. If one ends in v, a neighbour across vs or tv still counts when what joins it to u crosses that side
//    and the side does not block. Else, under SeesOpp, and ConfEdge, which agrees at order 1, it is asked
//    what u sees through st, beside v. Other definitions leave it to ConstrainedOrder. Without edges that
//    block all definitions up to Sees3vtx agree.
// 6. The neighbours across the four sides come first, of these the ones that need no exact arithmetic: they
//    refuse most edges.
// 7. Std: there is a triangulation of order at most 1 only if the constrained Delaunay triangulation is one;
//    then both triangles must pass the Std flood as well.
#include "base/parallel.hpp"
#include "order/corner_views.hpp"
#include "order/ground.hpp"
#include "order/quadrilateral_filter.hpp"

#include <thalweg/base/lazy.hpp>
#include <thalweg/geometry/predicates.hpp>
#include <thalweg/mesh/rim.hpp>
#include <thalweg/order/constrained_order.hpp>
#include <thalweg/order/quadrilaterals.hpp>

#include <tbb/enumerable_thread_specific.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <memory>

namespace thalweg {

namespace {

constexpr std::size_t kBlock = 4096;

/// Memory of a thread.
struct Workspace {
  OrderWorkspace order;
  detail::CornerViews views;
};

class QuadrilateralSearch {
 public:
  QuadrilateralSearch(const Tin& tin, const QuadrilateralOptions& options)
      : tin_(tin), definition_(options.definition), ground_(tin, options.mode), rim_(rim_halfedges(tin)) {}

  [[nodiscard]] bool is_quadrilateral(const EdgeSurroundings& edge, Workspace& workspace) const;
  [[nodiscard]] bool delaunay_fits(TriangleId t, Workspace& workspace) const {
    return order().at_most(tin_.triangle(t), OrderDefinition::Std, 1, workspace.order);
  }
  [[nodiscard]] bool unconstrained() const { return !ground_.any_blocks(); }
  [[nodiscard]] const detail::Ground& ground() const { return ground_; }
  /// Where a neighbour of the inner vertex that is inside refuses an edge.
  [[nodiscard]] Refusing refusing() const {
    if (definition_ == OrderDefinition::EmptyQuad) return Refusing::None;
    if (unconstrained()) return Refusing::All;
    return definition_ == OrderDefinition::Sees3vtx ? Refusing::None : Refusing::Unblocked;
  }

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
  [[nodiscard]] const ConstrainedOrder& order() const {
    return *order_.get([this] {
      // A thread that waits here for its own tasks must not take one of the search, which would ask too.
      return tbb::this_task_arena::isolate(
          [this] { return std::make_unique<ConstrainedOrder>(tin_, ground_.mode()); });
    });
  }
  [[nodiscard]] Verdict judge_beyond(const Half& half) const;
  [[nodiscard]] Verdict judge_others(const Half& half) const;
  [[nodiscard]] Verdict judge(const Half& half, VertexId x) const;
  [[nodiscard]] Verdict weigh(const Half& half) const;
  [[nodiscard]] bool crosses_side(const Half& half, std::size_t i) const;
  [[nodiscard]] bool fits(const Half& half, Verdict beyond, Workspace& workspace) const;
  [[nodiscard]] bool is_order_one(const Half& half, Workspace& workspace) const;

  const Tin& tin_;
  OrderDefinition definition_;
  detail::Ground ground_;
  Lazy<std::unique_ptr<ConstrainedOrder>> order_;  ///< few need it
  std::vector<HalfedgeId> rim_;
};

// A neighbour of the inner vertex lies inside: is that enough to refuse the half?
QuadrilateralSearch::Verdict QuadrilateralSearch::weigh(const Half& half) const {
  switch (refusing()) {
    case Refusing::All:
      return Verdict::Refused;
    case Refusing::Unblocked:
      return ground_.blocks(half.inner) ? Verdict::Unclear : Verdict::Refused;
    case Refusing::None:
      break;
  }
  return Verdict::Unclear;
}

// Whether what joins the vertex across a side at the inner vertex to the opposite corner crosses that side:
// then nothing else can be in the way, for from there on it runs within the quadrilateral.
bool QuadrilateralSearch::crosses_side(const Half& half, std::size_t i) const {
  const Point2 from = tin_.point(half.beyond[i]), to = tin_.point(half.corners[1]);
  return orientation(from, to, tin_.point(half.corners[i == 0 ? 0 : 2])) *
             orientation(from, to, tin_.point(half.inner)) <
         0;
}

// The vertices across the two sides at the inner vertex.
QuadrilateralSearch::Verdict QuadrilateralSearch::judge_beyond(const Half& half) const {
  Verdict worst = Verdict::Fits;
  for (std::size_t i = 0; i < 2 && worst != Verdict::Refused; ++i) {
    if (half.inside[i] == kOutside) continue;
    const Verdict verdict = half.inside[i] == kInside ? weigh(half) : judge(half, half.beyond[i]);
    worst = std::max(worst, verdict);
    if (verdict != Verdict::Unclear || definition_ > OrderDefinition::SeesOpp) continue;
    if (!ground_.blocks(i == 0 ? half.side : half.last) && crosses_side(half, i)) worst = Verdict::Refused;
  }
  return worst;
}

QuadrilateralSearch::Verdict QuadrilateralSearch::judge(const Half& half, VertexId x) const {
  const auto& [a, b, c] = half.corners;
  if (x == a || x == b || x == c ||
      !in_circle_perturbed(tin_.point(a), tin_.point(b), tin_.point(c), tin_.point(x))) {
    return Verdict::Fits;
  }
  return weigh(half);
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

bool QuadrilateralSearch::fits(const Half& half, Verdict beyond, Workspace& workspace) const {
  const Verdict verdict = std::max(beyond, judge_others(half));
  if (verdict == Verdict::Refused) return false;
  const bool decided = verdict == Verdict::Fits && (definition_ != OrderDefinition::Std || unconstrained());
  return decided || is_order_one(half, workspace);
}

bool QuadrilateralSearch::is_order_one(const Half& half, Workspace& workspace) const {
  if (definition_ == OrderDefinition::ConfEdge || definition_ == OrderDefinition::SeesOpp) {
    workspace.views.start_past(ground_, half.corners, half.side, half.last);
    if (workspace.views.next()) return false;
    if (!workspace.views.gave_up()) return true;
  }
  return order().at_most(half.corners, definition_, 1, workspace.order);
}

bool QuadrilateralSearch::is_quadrilateral(const EdgeSurroundings& edge, Workspace& workspace) const {
  const auto& [s, u, t, v, uv] = edge.quadrilateral;
  if (!edge.convex && !(orientation(tin_.point(s), tin_.point(u), tin_.point(t)) > 0 &&
                        orientation(tin_.point(t), tin_.point(v), tin_.point(s)) > 0)) {
    return false;
  }
  const HalfedgeId vu = tin_.twin(uv);
  const auto& beyond = edge.beyond;
  const auto& inside = edge.inside;
  const Half at_u{
      {s, u, t}, v, Tin::next(uv), Tin::previous(vu), {beyond[0], beyond[1]}, {inside[0], inside[1]}};
  const Half at_v{
      {t, v, s}, u, Tin::next(vu), Tin::previous(uv), {beyond[2], beyond[3]}, {inside[2], inside[3]}};
  const Verdict past_u = judge_beyond(at_u);
  if (past_u == Verdict::Refused) return false;
  const Verdict past_v = judge_beyond(at_v);
  if (past_v == Verdict::Refused) return false;
  return fits(at_u, past_u, workspace) && fits(at_v, past_v, workspace);
}

// The quadrilaterals of a range of halfedges.
void find_among(const QuadrilateralSearch& search, std::size_t begin, std::size_t end, Workspace& workspace,
                std::vector<Quadrilateral>& found) {
  QuadrilateralFilter filter(search.ground(), search.refusing());
  constexpr std::size_t kMost = QuadrilateralFilter::kMost;
  for (; begin < end; begin += kMost) {
    for (const EdgeSurroundings& edge : filter.look(begin, std::min(end, begin + kMost))) {
      if (search.is_quadrilateral(edge, workspace)) found.push_back(edge.quadrilateral);
    }
  }
}

}  // namespace

std::vector<Quadrilateral> find_quadrilaterals(const Tin& ground, const QuadrilateralOptions& options,
                                               const Progress& progress) {
  const QuadrilateralSearch search(ground, options);
  tbb::enumerable_thread_specific<Workspace> workspaces;
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
    find_among(search, begin, end, workspaces.local(), found[begin / kBlock]);
  });
  std::vector<Quadrilateral> all;
  std::size_t total = 0;
  for (const auto& part : found) total += part.size();
  all.reserve(total);
  for (const auto& part : found) all.insert(all.end(), part.begin(), part.end());
  return all;
}

}  // namespace thalweg
