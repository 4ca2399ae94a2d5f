// The greedy triangulation of an edge.
//
// 1. Walk along ab through the ground: the triangles crossed make the hull; their corners left and right of
//    ab make two chains from a to b. A vertex at which an edge hangs into the hull is on its chain twice.
// 2. Below an edge of the hull's half, the apex is the vertex of the chain on the far side whose circle with
//    the edge holds no other one (the last one that lies in the circle of the best so far); it splits the
//    chain in two. (Anglada, An improved incremental algorithm for constructing restricted Delaunay
//    triangulations, 1997.) Chains are kept on a stack of their own, for they can be long.
#include "order/ground.hpp"

#include <thalweg/base/error.hpp>
#include <thalweg/geometry/predicates.hpp>
#include <thalweg/order/greedy_triangulation.hpp>

#include <algorithm>
#include <string>
#include <utility>

namespace thalweg {

namespace {

struct Hull {
  std::vector<TriangleId> crossed;
  std::vector<VertexId> left, right;  // chains from a to b
};

Hull find_hull(const Tin& ground, VertexId a, VertexId b) {
  Hull hull{{}, {a}, {a}};
  const Point2 from = ground.point(a), to = ground.point(b);
  HalfedgeId leaving;
  for (const HalfedgeId h : ground.outgoing(a)) {
    const VertexId right = ground.target(h), left = ground.apex(h);
    if (right == b || left == b) return {};
    if (orientation(from, ground.point(right), to) <= 0 || orientation(from, to, ground.point(left)) <= 0) {
      continue;
    }
    hull.crossed.push_back(Tin::triangle_of(h));
    hull.right.push_back(right);
    hull.left.push_back(left);
    leaving = Tin::next(h);
    break;
  }
  while (leaving.valid()) {
    const HalfedgeId entry = ground.twin(leaving);
    const VertexId apex = ground.apex(entry);
    hull.crossed.push_back(Tin::triangle_of(entry));
    if (apex == b) break;
    const int side = orientation(from, to, ground.point(apex));
    (side > 0 ? hull.left : hull.right).push_back(apex);
    leaving = side > 0 ? Tin::next(entry) : Tin::previous(entry);
  }
  hull.left.push_back(b);
  hull.right.push_back(b);
  return hull;
}

// The chain is walked counter-clockwise around its half, whose base runs from the chain's end to its start.
void fill(const Tin& ground, const std::vector<VertexId>& chain, std::vector<Triangle>& triangles) {
  std::vector<std::pair<std::size_t, std::size_t>> pending{{0, chain.size() - 1}};
  while (!pending.empty()) {
    const auto [first, last] = pending.back();
    pending.pop_back();
    if (last - first < 2) continue;
    const Point2 base_from = ground.point(chain[last]), base_to = ground.point(chain[first]);
    std::size_t apex = last;
    for (std::size_t i = first + 1; i < last; ++i) {
      const Point2 p = ground.point(chain[i]);
      if (orientation(base_from, base_to, p) <= 0) continue;
      if (apex == last || (chain[i] != chain[apex] &&
                           in_circle_perturbed(base_from, base_to, ground.point(chain[apex]), p))) {
        apex = i;
      }
    }
    triangles.push_back({chain[last], chain[first], chain[apex]});
    pending.emplace_back(first, apex);
    pending.emplace_back(apex, last);
  }
}

}  // namespace

GreedyPatch greedy_patch(const Tin& ground, VertexId a, VertexId b) {
  Hull hull = find_hull(ground, a, b);
  GreedyPatch patch{std::move(hull.crossed), {}};
  if (patch.removed.empty()) return patch;
  std::reverse(hull.left.begin(), hull.left.end());
  fill(ground, hull.left, patch.triangles);
  fill(ground, hull.right, patch.triangles);
  return patch;
}

Tin greedy_triangulation(const ConstrainedOrder& order, VertexId a, VertexId b) {
  const Tin& ground = order.ground();
  const auto refuse = [&](const std::string& why) {
    throw Error(ErrorCode::Usage, "the edge from vertex " + std::to_string(a.value()) + " to " +
                                      std::to_string(b.value()) + " " + why);
  };
  if (a == b) refuse("has no length");
  if (!order.sees(a, b)) refuse("is blocked by a constraint edge");
  for (std::size_t v = 0; v < ground.vertex_count(); ++v) {
    if (VertexId{v} != a && VertexId{v} != b &&
        on_segment(ground.point(a), ground.point(b), ground.point(VertexId{v}))) {
      refuse("passes through vertex " + std::to_string(v));
    }
  }
  GreedyPatch patch = greedy_patch(ground, a, b);
  std::vector<bool> removed(ground.triangle_count(), false);
  for (const TriangleId t : patch.removed) removed[t.index()] = true;
  std::vector<Triangle> triangles = std::move(patch.triangles);
  for (std::size_t t = 0; t < removed.size(); ++t) {
    if (!removed[t]) triangles.push_back(ground.triangle(TriangleId{t}));
  }
  const std::vector<ConstraintEdge> constraints = ground.constraint_edges();
  return {{ground.points().begin(), ground.points().end()},
          {ground.heights().begin(), ground.heights().end()},
          std::move(triangles),
          constraints};
}

}  // namespace thalweg
