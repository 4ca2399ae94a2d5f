// A map from edges to the apexes on either side; a queue of edges.
#include "flip_heuristic.hpp"

#include <thalweg/geometry/predicates.hpp>

#include <algorithm>
#include <map>
#include <set>
#include <vector>

namespace thalweg::bench {

namespace {

class Flipper {
 public:
  Flipper(const Tin& tin, const FixedFaces& faces) : tin_(tin), faces_(faces) {
    for (const Triangle& t : tin.triangles()) add(t);
    for (const auto& [edge, apex] : apex_) queue_.insert(std::minmax(edge.first, edge.second));
  }

  Tin run() {
    while (!queue_.empty()) {
      const auto [a, b] = *queue_.begin();
      queue_.erase(queue_.begin());
      flip(a, b);
    }
    std::set<Triangle> triangles;
    for (const auto& [edge, apex] : apex_) triangles.insert(lowest_first({edge.first, edge.second, apex}));
    return {{tin_.points().begin(), tin_.points().end()},
            {tin_.heights().begin(), tin_.heights().end()},
            {triangles.begin(), triangles.end()},
            tin_.constraint_edges()};
  }

 private:
  static Triangle lowest_first(Triangle t) {
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    return t;
  }
  void add(const Triangle& t) {
    for (std::size_t i = 0; i < 3; ++i) apex_[{t[i], t[(i + 1) % 3]}] = t[(i + 2) % 3];
  }
  [[nodiscard]] bool is_candidate(const Triangle& t) const {
    const Triangle sorted = lowest_first(t);
    const auto at =
        std::lower_bound(faces_.triangles.begin(), faces_.triangles.end(), sorted,
                         [](const OrderTriangle& c, const Triangle& corners) { return c.corners < corners; });
    return at != faces_.triangles.end() && at->corners == sorted;
  }
  [[nodiscard]] bool constrained(VertexId a, VertexId b) const {
    const HalfedgeId h = tin_.find_halfedge(a, b), g = tin_.find_halfedge(b, a);
    return (h.valid() && tin_.constrained(h)) || (g.valid() && tin_.constrained(g));
  }

  void flip(VertexId a, VertexId b) {
    const auto left = apex_.find({a, b}), right = apex_.find({b, a});
    if (left == apex_.end() || right == apex_.end() || constrained(a, b)) return;
    const VertexId c = left->second, d = right->second;
    const double kept = std::min(tin_.height(a), tin_.height(b)),
                 fresh = std::min(tin_.height(c), tin_.height(d));
    if (!(fresh < kept)) return;
    if (orientation(tin_.point(c), tin_.point(a), tin_.point(d)) <= 0 ||
        orientation(tin_.point(d), tin_.point(b), tin_.point(c)) <= 0) {
      return;
    }
    const Triangle one{c, a, d}, other{d, b, c};
    if (!is_candidate(one) || !is_candidate(other)) return;
    apex_.erase({a, b});
    apex_.erase({b, a});
    add(one);
    add(other);
    for (const auto& [from, to] :
         {std::pair(a, d), std::pair(d, b), std::pair(b, c), std::pair(c, a), std::pair(c, d)}) {
      queue_.insert(std::minmax(from, to));
    }
  }

  const Tin& tin_;
  const FixedFaces& faces_;
  std::map<std::pair<VertexId, VertexId>, VertexId> apex_;
  std::set<std::pair<VertexId, VertexId>> queue_;
};

}  // namespace

Tin flip_to_lowest(const Tin& delaunay, const FixedFaces& faces) {
  return Flipper(delaunay, faces).run();
}

}  // namespace thalweg::bench
