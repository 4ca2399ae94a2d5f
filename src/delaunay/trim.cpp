// Losing ground from the rim.
//
// 1. Rounds: the candidates of a round are the triangles that have an unconstrained rim edge which goes. Only
//    the rim and the neighbours of what was dropped in the round before are looked at.
// 2. Within a round candidates are dropped from the longest edge down, ties by the corners' positions, each
//    only if every constraint edge of it keeps its other triangle. That order is one of coordinates, so the
//    outcome does not depend on ids; where no constraint edge is near it plays no part at all.
#include <thalweg/base/error.hpp>
#include <thalweg/delaunay/trim.hpp>
#include <thalweg/geometry/predicates.hpp>

#include <algorithm>
#include <array>
#include <string>
#include <tuple>
#include <utility>

namespace thalweg {

namespace {

double squared_length(const Tin& tin, HalfedgeId h) {
  const Point2 a = tin.point(tin.origin(h));
  const Point2 b = tin.point(tin.target(h));
  return (b.x - a.x) * (b.x - a.x) + (b.y - a.y) * (b.y - a.y);
}

std::array<HalfedgeId, 3> sides(TriangleId t) {
  return {Tin::halfedge(t, 0), Tin::halfedge(t, 1), Tin::halfedge(t, 2)};
}

struct Candidate {
  double longest = 0;
  std::array<Point2, 3> corners;
  TriangleId triangle;
  bool operator<(const Candidate& other) const {
    return std::tie(other.longest, corners) < std::tie(longest, other.corners);
  }
};

Candidate make_candidate(const Tin& tin, TriangleId t) {
  Candidate candidate{.longest = 0, .corners = {}, .triangle = t};
  for (std::size_t i = 0; i < 3; ++i) {
    candidate.longest = std::max(candidate.longest, squared_length(tin, Tin::halfedge(t, i)));
    candidate.corners[i] = tin.point(tin.triangle(t)[i]);
  }
  std::sort(candidate.corners.begin(), candidate.corners.end());
  return candidate;
}

class RimDropper {
 public:
  RimDropper(const Tin& tin, const std::function<bool(HalfedgeId)>& goes)
      : tin_(tin), goes_(goes), keep_(tin.triangle_count(), true) {}

  std::vector<bool> run() {
    std::vector<TriangleId> front;
    for (std::size_t t = 0; t < tin_.triangle_count(); ++t) {
      const auto halfedges = sides(TriangleId{t});
      if (std::any_of(halfedges.begin(), halfedges.end(), [&](HalfedgeId h) { return tin_.on_rim(h); })) {
        front.push_back(TriangleId{t});
      }
    }
    while (!front.empty()) front = drop_round(front);
    return std::move(keep_);
  }

 private:
  [[nodiscard]] bool on_rim_now(HalfedgeId h) const {
    const HalfedgeId other = tin_.twin(h);
    return !other.valid() || !keep_[Tin::triangle_of(other).index()];
  }
  [[nodiscard]] bool may_go(TriangleId t) const {
    const auto halfedges = sides(t);
    return std::none_of(halfedges.begin(), halfedges.end(),
                        [&](HalfedgeId h) { return tin_.constrained(h) && on_rim_now(h); });
  }
  [[nodiscard]] bool wants_to_go(TriangleId t) const {
    const auto halfedges = sides(t);
    return std::any_of(halfedges.begin(), halfedges.end(),
                       [&](HalfedgeId h) { return on_rim_now(h) && !tin_.constrained(h) && goes_(h); });
  }

  // Returns the triangles whose rim edges have changed.
  std::vector<TriangleId> drop_round(const std::vector<TriangleId>& front) {
    std::vector<Candidate> candidates;
    for (const TriangleId t : front) {
      if (keep_[t.index()] && may_go(t) && wants_to_go(t)) candidates.push_back(make_candidate(tin_, t));
    }
    std::sort(candidates.begin(), candidates.end());
    std::vector<TriangleId> changed;
    for (const Candidate& candidate : candidates) {
      if (!may_go(candidate.triangle)) continue;
      keep_[candidate.triangle.index()] = false;
      for (const HalfedgeId h : sides(candidate.triangle)) {
        if (!on_rim_now(h)) changed.push_back(Tin::triangle_of(tin_.twin(h)));
      }
    }
    std::sort(changed.begin(), changed.end());
    changed.erase(std::unique(changed.begin(), changed.end()), changed.end());
    return changed;
  }

  const Tin& tin_;
  const std::function<bool(HalfedgeId)>& goes_;
  std::vector<bool> keep_;
};

}  // namespace

std::vector<bool> drop_rim_triangles(const Tin& tin, const std::function<bool(HalfedgeId)>& goes) {
  return RimDropper(tin, goes).run();
}

std::vector<bool> drop_long_rim_triangles(const Tin& tin, double max_edge) {
  return drop_rim_triangles(tin, [&](HalfedgeId h) { return squared_length(tin, h) > max_edge * max_edge; });
}

std::vector<bool> drop_turned_rim_triangles(const Tin& tin, std::span<const Point2> written) {
  std::vector<bool> turned(tin.triangle_count());
  for (std::size_t t = 0; t < turned.size(); ++t) {
    const Triangle& corners = tin.triangle(TriangleId{t});
    turned[t] = orientation(written[corners[0].index()], written[corners[1].index()],
                            written[corners[2].index()]) <= 0;
  }
  std::vector<bool> keep =
      drop_rim_triangles(tin, [&](HalfedgeId h) { return turned[Tin::triangle_of(h).index()]; });
  for (std::size_t t = 0; t < turned.size(); ++t) {
    if (!turned[t] || !keep[t]) continue;
    const Point2 place = written[tin.triangle(TriangleId{t})[0].index()];
    throw Error(ErrorCode::BadCrs, "a triangle at (" + std::to_string(place.x) + ", " +
                                       std::to_string(place.y) +
                                       ") of the output's coordinates is flat or turned over there, although "
                                       "it is fine in the metric plane; choose a projected output CRS with "
                                       "--t-crs");
  }
  return keep;
}

std::vector<bool> drop_outside_triangles(const Tin& tin, const std::function<bool(TriangleId)>& outside) {
  std::vector<bool> keep(tin.triangle_count());
  for (std::size_t t = 0; t < keep.size(); ++t) keep[t] = !outside(TriangleId{t});
  return keep;
}

std::vector<bool> inside_outline(const Tin& tin, std::span<const std::pair<VertexId, VertexId>> outline) {
  std::vector<bool> wall(tin.halfedge_count(), false);
  std::vector<TriangleId> queue;
  std::vector<bool> inside(tin.triangle_count(), false);
  const auto enter = [&](TriangleId t) {
    if (inside[t.index()]) return;
    inside[t.index()] = true;
    queue.push_back(t);
  };
  for (const auto& [a, b] : outline) {
    const HalfedgeId h = tin.find_halfedge(a, b);
    if (!h.valid()) continue;
    wall[h.index()] = true;
    enter(Tin::triangle_of(h));
  }
  while (!queue.empty()) {
    const TriangleId t = queue.back();
    queue.pop_back();
    for (std::size_t side = 0; side < 3; ++side) {
      const HalfedgeId h = Tin::halfedge(t, side);
      if (!tin.on_rim(h) && !wall[h.index()]) enter(Tin::triangle_of(tin.twin(h)));
    }
  }
  return inside;
}

}  // namespace thalweg
