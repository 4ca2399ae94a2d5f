// Flips, hulls, and the exact choice for bounds.
//
// Candidates of the faces are all triangles that triangulations of the order have; a triangulation that is
// made of them is of the order. So to keep to them is to keep to the order, to constraint edges (a candidate
// does not cross one) and to convexity (they are counter-clockwise).
//
// Flip. An edge ab between triangles with apexes c and d is flipped to cd if the lower end of cd is lower
// than both a and b and the new triangles are candidates, until no edge can be. The lower end is a neighbour
// of a and b before and after, so no pit comes; the sum over edges of the lower end's height falls, so it
// ends.
//
// Hull. Edges that lead from a pit of the Delaunay triangulation to a vertex that is not higher are tried
// one by one: the Delaunay triangles that the edge crosses give way to its greedy triangulation
// (greedy_triangulation.hpp). It is kept if its triangles are candidates, if pits get fewer, and if none of
// the triangles gave way before: hulls do not overlap. The publication leaves the order open; here those
// that cross least come first, for they leave most room for others.
#include "optimize/objective_value.hpp"

#include <thalweg/base/error.hpp>
#include <thalweg/mesh/edge_kind.hpp>
#include <thalweg/optimize/pit_heuristics.hpp>
#include <thalweg/order/greedy_triangulation.hpp>

#include <algorithm>
#include <numeric>
#include <span>
#include <string>
#include <tuple>
#include <utility>

namespace thalweg {

namespace {

constexpr std::size_t kCheck = 4096;

const OrderTriangle* find_candidate(const FixedFaces& faces, Triangle corners) {
  std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
  const auto at = std::lower_bound(faces.triangles.begin(), faces.triangles.end(), corners,
                                   [](const OrderTriangle& t, const Triangle& c) { return t.corners < c; });
  return at != faces.triangles.end() && at->corners == corners ? &*at : nullptr;
}

std::vector<OrderTriangle> as_candidates(const FixedFaces& faces, std::span<const Triangle> triangles) {
  std::vector<OrderTriangle> found;
  found.reserve(triangles.size());
  for (const Triangle& corners : triangles) found.push_back(*find_candidate(faces, corners));
  std::sort(found.begin(), found.end());
  return found;
}

/// The place of each vertex among all, sorted by coordinates.
std::vector<std::uint32_t> ranks_of(const Tin& tin) {
  std::vector<std::uint32_t> sorted(tin.vertex_count()), rank(tin.vertex_count());
  std::iota(sorted.begin(), sorted.end(), 0U);
  std::sort(sorted.begin(), sorted.end(), [&](std::uint32_t a, std::uint32_t b) {
    return std::pair(tin.points()[a], a) < std::pair(tin.points()[b], b);
  });
  for (std::uint32_t i = 0; i < sorted.size(); ++i) rank[sorted[i]] = i;
  return rank;
}

class Flips {
 public:
  Flips(const Tin& tin, const FixedFaces& faces)
      : tin_(tin),
        faces_(faces),
        rank_(ranks_of(tin)),
        corners_(tin.triangles().begin(), tin.triangles().end()),
        twins_(tin.arrays().twins.begin(), tin.arrays().twins.end()) {}

  std::vector<Triangle> run(const Progress& progress) {
    for (std::size_t i = 0; i < twins_.size(); ++i) {
      const HalfedgeId h{i};
      if (twins_[i].valid() && rank(origin(h)) < rank(target(h))) push(h);
    }
    std::sort(pending_.begin(), pending_.end(), [&](const Pending& p, const Pending& q) {
      return std::pair(rank(p.from), rank(p.to)) > std::pair(rank(q.from), rank(q.to));
    });
    for (std::size_t steps = 0; !pending_.empty(); ++steps) {
      if (steps % kCheck == 0) progress.check();
      const auto [h, from, to] = pending_.back();
      pending_.pop_back();
      if (origin(h) == from && target(h) == to) try_flip(rank(from) < rank(to) ? h : twins_[h.index()]);
    }
    return std::move(corners_);
  }

 private:
  /// An edge to look at, where it was: a flip that moves it puts it here anew.
  struct Pending {
    HalfedgeId h;
    VertexId from, to;
  };

  [[nodiscard]] VertexId origin(HalfedgeId h) const { return corners_[h.index() / 3][h.index() % 3]; }
  [[nodiscard]] VertexId target(HalfedgeId h) const { return origin(Tin::next(h)); }
  [[nodiscard]] VertexId apex(HalfedgeId h) const { return origin(Tin::previous(h)); }
  [[nodiscard]] std::uint32_t rank(VertexId v) const { return rank_[v.index()]; }
  [[nodiscard]] double lower(VertexId a, VertexId b) const {
    return std::min(tin_.height(a), tin_.height(b));
  }

  void push(HalfedgeId h) { pending_.push_back({h, origin(h), target(h)}); }

  void try_flip(HalfedgeId h) {
    const HalfedgeId g = twins_[h.index()];
    const VertexId a = origin(h), b = origin(g), c = apex(h), d = apex(g);
    if (!(lower(c, d) < lower(a, b))) return;
    const Triangle left{a, d, c}, right{d, b, c};
    if (find_candidate(faces_, left) == nullptr || find_candidate(faces_, right) == nullptr) return;
    const HalfedgeId ad = twins_[Tin::next(g).index()], db = twins_[Tin::previous(g).index()];
    const HalfedgeId bc = twins_[Tin::next(h).index()], ca = twins_[Tin::previous(h).index()];
    const TriangleId at_a = Tin::triangle_of(h), at_b = Tin::triangle_of(g);
    corners_[at_a.index()] = left;
    corners_[at_b.index()] = right;
    join(Tin::halfedge(at_a, 1), Tin::halfedge(at_b, 2));
    join(Tin::halfedge(at_a, 0), ad);
    join(Tin::halfedge(at_a, 2), ca);
    join(Tin::halfedge(at_b, 0), db);
    join(Tin::halfedge(at_b, 1), bc);
  }
  void join(HalfedgeId h, HalfedgeId twin) {
    twins_[h.index()] = twin;
    if (!twin.valid()) return;
    twins_[twin.index()] = h;
    push(h);
  }

  const Tin& tin_;
  const FixedFaces& faces_;
  std::vector<std::uint32_t> rank_;
  std::vector<Triangle> corners_;
  std::vector<HalfedgeId> twins_;  ///< for each halfedge, as in a Tin
  std::vector<Pending> pending_;
};

using Edge = std::pair<VertexId, VertexId>;  ///< first < second

/// Edges between two of the triangles, sorted.
std::vector<Edge> inner_edges(std::span<const Triangle> triangles) {
  std::vector<Edge> edges, inner;
  for (const Triangle& t : triangles) {
    for (std::size_t i = 0; i < 3; ++i) edges.push_back(std::minmax(t[i], t[(i + 1) % 3]));
  }
  std::sort(edges.begin(), edges.end());
  for (std::size_t i = 1; i < edges.size(); ++i) {
    if (edges[i - 1] == edges[i]) inner.push_back(edges[i]);
  }
  return inner;
}

class Hulls {
 public:
  Hulls(const Tin& tin, const FixedFaces& faces)
      : tin_(tin),
        faces_(faces),
        neighbours_(tin.vertex_count()),
        drained_(tin.rim_vertices()),
        seen_(tin.vertex_count(), 0),
        gave_way_(tin.triangle_count(), false) {
    for (std::size_t i = 0; i < tin.halfedge_count(); ++i) {
      const HalfedgeId h{i};
      if (!tin.represents_edge(h)) continue;
      const VertexId a = tin.origin(h), b = tin.target(h);
      connect({a, b});
      if (!has(tin.kind(h), EdgeKind::Lake) || tin.height(a) != tin.height(b)) continue;
      drained_[a.index()] = drained_[b.index()] = true;
    }
  }

  std::vector<Triangle> run(const Progress& progress) {
    std::vector<Triangle> triangles;
    for (const GreedyPatch& patch : patches(progress)) {
      progress.check();
      if (insert(patch)) triangles.insert(triangles.end(), patch.triangles.begin(), patch.triangles.end());
    }
    for (std::size_t t = 0; t < gave_way_.size(); ++t) {
      if (!gave_way_[t]) triangles.push_back(tin_.triangle(TriangleId{t}));
    }
    return triangles;
  }

 private:
  /// Of the edges that can remove a pit, in the order in which they are tried.
  std::vector<GreedyPatch> patches(const Progress& progress) {
    const std::vector<std::uint32_t> rank = ranks_of(tin_);
    const std::vector<bool> in_pit = mark_pits();
    std::vector<std::tuple<std::size_t, std::uint32_t, std::uint32_t, GreedyPatch>> found;
    for (std::size_t e = 0; e < faces_.edges.size(); ++e) {
      if (e % kCheck == 0) progress.check();
      const CandidateEdge& edge = faces_.edges[e];
      const double a = tin_.height(edge.a), b = tin_.height(edge.b);
      if (edge.ground.valid()) continue;
      if (!(in_pit[edge.a.index()] && b <= a) && !(in_pit[edge.b.index()] && a <= b)) continue;
      GreedyPatch patch = greedy_patch(tin_, edge.a, edge.b);
      if (std::all_of(patch.triangles.begin(), patch.triangles.end(),
                      [&](const Triangle& t) { return find_candidate(faces_, t) != nullptr; })) {
        const auto [first, second] = std::minmax(rank[edge.a.index()], rank[edge.b.index()]);
        found.emplace_back(patch.removed.size(), first, second, std::move(patch));
      }
    }
    std::sort(found.begin(), found.end(), [](const auto& p, const auto& q) {
      return std::tie(std::get<0>(p), std::get<1>(p), std::get<2>(p)) <
             std::tie(std::get<0>(q), std::get<1>(q), std::get<2>(q));
    });
    std::vector<GreedyPatch> sorted;
    sorted.reserve(found.size());
    for (auto& entry : found) sorted.push_back(std::move(std::get<3>(entry)));
    return sorted;
  }

  bool insert(const GreedyPatch& patch) {
    std::vector<Triangle> removed;
    for (const TriangleId t : patch.removed) {
      if (gave_way_[t.index()]) return false;
      removed.push_back(tin_.triangle(t));
    }
    const std::size_t before = count_pits_at(removed);
    if (before == 0) return false;
    exchange(inner_edges(removed), inner_edges(patch.triangles));
    if (count_pits_at(removed) >= before) {
      exchange(inner_edges(patch.triangles), inner_edges(removed));
      return false;
    }
    for (const TriangleId t : patch.removed) gave_way_[t.index()] = true;
    return true;
  }

  void exchange(const std::vector<Edge>& old, const std::vector<Edge>& fresh) {
    for (const auto& [a, b] : old) {
      std::erase(neighbours_[a.index()], b);
      std::erase(neighbours_[b.index()], a);
    }
    for (const Edge& edge : fresh) connect(edge);
  }
  void connect(const Edge& edge) {
    neighbours_[edge.first.index()].push_back(edge.second);
    neighbours_[edge.second.index()].push_back(edge.first);
  }

  /// Pits among the plateaus that corners of the triangles are on.
  std::size_t count_pits_at(const std::vector<Triangle>& triangles) {
    std::vector<VertexId> plateau;
    std::size_t pits = 0;
    ++round_;
    for (const Triangle& t : triangles) {
      for (const VertexId v : t) pits += is_pit(v, plateau) ? 1 : 0;
    }
    return pits;
  }
  std::vector<bool> mark_pits() {
    std::vector<bool> in_pit(tin_.vertex_count(), false);
    std::vector<VertexId> plateau;
    ++round_;
    for (std::size_t v = 0; v < in_pit.size(); ++v) {
      if (!is_pit(VertexId{v}, plateau)) continue;
      for (const VertexId w : plateau) in_pit[w.index()] = true;
    }
    return in_pit;
  }
  /// Whether the plateau of a vertex is a pit; false where this round has seen it. `plateau`: its vertices.
  bool is_pit(VertexId start, std::vector<VertexId>& plateau) {
    if (seen_[start.index()] == round_) return false;
    seen_[start.index()] = round_;
    plateau.assign(1, start);
    bool pit = true;
    for (std::size_t i = 0; i < plateau.size(); ++i) {
      const VertexId v = plateau[i];
      pit = pit && !drained_[v.index()];
      for (const VertexId w : neighbours_[v.index()]) {
        pit = pit && tin_.height(w) >= tin_.height(v);
        if (tin_.height(w) != tin_.height(v) || seen_[w.index()] == round_) continue;
        seen_[w.index()] = round_;
        plateau.push_back(w);
      }
    }
    return pit;
  }

  const Tin& tin_;
  const FixedFaces& faces_;
  std::vector<std::vector<VertexId>> neighbours_;
  std::vector<bool> drained_;  ///< on the rim, or on a lake's level edge: its plateau is no pit
  std::vector<std::uint32_t> seen_;
  std::uint32_t round_ = 0;
  std::vector<bool> gave_way_;  ///< by triangle
};

std::size_t count_new_edges(const Tin& tin, const Tin& delaunay) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < tin.halfedge_count(); ++i) {
    const HalfedgeId h{i};
    const VertexId a = tin.origin(h), b = tin.target(h);
    const bool old = delaunay.find_halfedge(a, b).valid() || delaunay.find_halfedge(b, a).valid();
    count += tin.represents_edge(h) && !old ? 1 : 0;
  }
  return count;
}

}  // namespace

bool can_remove_pits(const Tin& delaunay, const FixedFaces& faces) {
  const auto triangles = delaunay.triangles();
  return std::all_of(triangles.begin(), triangles.end(),
                     [&](const Triangle& corners) { return find_candidate(faces, corners) != nullptr; });
}

std::vector<OrderTriangle> remove_pits(const Tin& delaunay, const FixedFaces& faces, PitHeuristic heuristic,
                                       const Progress& progress) {
  if (!can_remove_pits(delaunay, faces)) {
    throw Error(ErrorCode::Unsupported,
                "the constrained Delaunay triangulation, from which the heuristics start, has a larger order "
                "under this definition; take a definition that knows of lines, such as pathcon or sees-opp");
  }
  const bool flips = heuristic == PitHeuristic::Flip;
  return as_candidates(faces,
                       flips ? Flips(delaunay, faces).run(progress) : Hulls(delaunay, faces).run(progress));
}

FaceOptimizeResult optimize_faces_by(PitHeuristic heuristic, const Tin& delaunay, const FixedFaces& faces,
                                     const FaceOptimizeOptions& options, Progress& progress) {
  const OptimizeOptions& common = options.common;
  if (common.criteria.empty() || !common.criteria[0].is(Criterion::LocalMinima) || options.order_sum_after) {
    throw Error(
        ErrorCode::Usage,
        "the flip and the hull heuristic are for local-minima as the first criterion, at a given order");
  }
  FaceOptimizeOptions exact = options;
  exact.bounds_alone = true;
  FaceOptimizeResult result = optimize_faces(delaunay, faces, exact, progress);
  result.triangles = remove_pits(delaunay, faces, heuristic, progress);
  std::vector<Triangle> triangles;
  for (const OrderTriangle& t : result.triangles) triangles.push_back(t.corners);
  result.tin = Tin({delaunay.points().begin(), delaunay.points().end()},
                   {delaunay.heights().begin(), delaunay.heights().end()}, std::move(triangles),
                   delaunay.constraint_edges());
  result.new_edges = count_new_edges(result.tin, delaunay);
  const Scale scale{common.horizontal_metres_per_unit, common.vertical_metres_per_unit};
  const std::string name = heuristic == PitHeuristic::Flip ? "flip" : "hull";
  const std::vector<CriterionResult> bounds = result.criteria;
  for (std::size_t i = 0; i < result.criteria.size(); ++i) {
    CriterionResult& line = result.criteria[i];
    line.result = in_units(value_on(result.tin, common.criteria[i], scale, common.reference, progress),
                           common.criteria[i]);
    line.method = i == 0 ? name + " heuristic" : "as the " + name + " heuristic leaves it";
  }
  take_bounds(bounds, result.bounds_alone, result.criteria);
  return result;
}

}  // namespace thalweg
