// Separation inside a disc by parity.
//
// 1. Obstacles: the parts of constraint edges in the open disc D, and all that is not D. As a graph: a node
//    for each constraint end strictly in D, one node for the circle and all beyond; an arc for each
//    constraint edge that enters D, from each of its ends that is strictly in D, else from the circle. (A
//    chord is a loop.)
// 2. Two points of D off the obstacles are separated if and only if some cycle of that graph has one of them
//    inside (Jordan, Janiszewski), that is, if a curve in D between them that meets arcs only by crossing
//    them crosses this cycle an odd number of times. (A cycle through the circle's node is closed along the
//    circle, which the curve does not meet.) All cycles are crossed evenly if and only if the nodes can be
//    coloured with two colours such that exactly the arcs crossed an odd number of times join different
//    colours.
// 3. The curve: straight from a point x of t's interior, chosen so that no constraint end but p lies on the
//    line through x and p, to right before p; then round p, over one constraint edge of p after the other, to
//    each of the wedges between them. p is joined if it is joined by one of its wedges. Where p lies on the
//    circle, only edges that enter D bound wedges; turning both ways from x reaches all of them without
//    leaving D.
#include <support/oracle/path_by_parity.hpp>

#include <algorithm>
#include <numeric>
#include <vector>

namespace thalweg::oracle {

namespace {

struct Arc {
  std::size_t from, to;  // nodes
  bool odd;              // crossed an odd number of times by the curve
};

// Disjoint sets of nodes, each with its colour relative to its root.
class Colouring {
 public:
  explicit Colouring(std::size_t nodes) : parent_(nodes), differs_(nodes, false) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  }
  // Demands that the colours differ or agree; false if that contradicts what was demanded before.
  bool demand(const Arc& arc) {
    const auto [from_root, from_differs] = find(arc.from);
    const auto [to_root, to_differs] = find(arc.to);
    const bool differs = (from_differs != to_differs) != arc.odd;
    if (from_root == to_root) return !differs;
    parent_[from_root] = to_root;
    differs_[from_root] = differs;
    return true;
  }

 private:
  [[nodiscard]] std::pair<std::size_t, bool> find(std::size_t node) const {
    bool differs = false;
    for (; parent_[node] != node; node = parent_[node]) differs = differs != differs_[node];
    return {node, differs};
  }
  std::vector<std::size_t> parent_;
  std::vector<bool> differs_;
};

bool all_cycles_even(std::size_t nodes, const std::vector<Arc>& arcs) {
  Colouring colouring(nodes);
  return std::all_of(arcs.begin(), arcs.end(), [&](const Arc& arc) { return colouring.demand(arc); });
}

// A point of t's interior such that no constraint end but p is on the line through it and p. The points tried
// lie on a conic, which each of the lines to avoid meets at most twice, so one is found.
Spot generic_start(const Scene& scene, Corners t, int p) {
  const Site u = scene.at(t[0]), v = scene.at(t[1]), w = scene.at(t[2]);
  for (Wide j = 1;; ++j) {
    const Spot x{u.x + j * v.x + j * j * w.x, u.y + j * v.y + j * j * w.y, 1 + j + j * j};
    const auto on_line = [&](int end) {
      return end != p && turn_sign(x, spot_of(scene.at(p)), spot_of(scene.at(end))) == 0;
    };
    if (std::none_of(scene.constraints.begin(), scene.constraints.end(),
                     [&](const Edge& e) { return on_line(e.first) || on_line(e.second); })) {
      return x;
    }
  }
}

// The arcs of p on one side of the line from p to x (side +1: left), nearest to x first.
std::vector<std::size_t> arcs_round(const Scene& scene, int p, const Spot& x, int side,
                                    const std::vector<std::pair<int, std::size_t>>& own) {
  std::vector<std::pair<int, std::size_t>> found;
  for (const auto& arc : own) {
    if (turn_sign(spot_of(scene.at(p)), x, spot_of(scene.at(arc.first))) == side) found.push_back(arc);
  }
  std::sort(found.begin(), found.end(), [&](const auto& a, const auto& b) {
    return side * turn(scene.at(p), scene.at(a.first), scene.at(b.first)) > 0;
  });
  std::vector<std::size_t> order;
  for (const auto& arc : found) order.push_back(arc.second);
  return order;
}

}  // namespace

bool path_joins(const Scene& scene, Corners t, int p) {
  const Site u = scene.at(t[0]), v = scene.at(t[1]), w = scene.at(t[2]);
  const Spot x = generic_start(scene, t, p);
  const Spot end = spot_of(scene.at(p));
  const std::size_t circle = scene.sites.size();
  const auto node = [&](int vertex) {
    return power(u, v, w, scene.at(vertex)) < 0 ? static_cast<std::size_t>(vertex) : circle;
  };
  std::vector<Arc> arcs;
  std::vector<std::pair<int, std::size_t>> own;  // far end and arc of each constraint edge of p
  for (const auto& [a, b] : scene.constraints) {
    if (!enters_open_disc(u, v, w, scene.at(a), scene.at(b))) continue;
    const bool at_p = a == p || b == p;
    if (at_p) own.emplace_back(a == p ? b : a, arcs.size());
    const bool crossed = !at_p && segments_meet(x, end, spot_of(scene.at(a)), spot_of(scene.at(b)));
    arcs.push_back({node(a), node(b), crossed});
  }
  if (all_cycles_even(circle + 1, arcs)) return true;
  for (const int side : {1, -1}) {
    std::vector<Arc> turned = arcs;
    for (const std::size_t arc : arcs_round(scene, p, x, side, own)) {
      turned[arc].odd = true;
      if (all_cycles_even(circle + 1, turned)) return true;
    }
  }
  return false;
}

}  // namespace thalweg::oracle
