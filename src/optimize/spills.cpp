// Depths of pits, height by height.
//
// An edge is there from the height of its higher end on: an *edge of height t*. Sets of vertices that edges
// of height up to t connect are the pools that water would form if it stood at t everywhere. ROOT is what
// water leaves by: the rim, and edges of lakes, from their own height on. A pit's spill is the height at
// which its set first meets ROOT or a set with a lower bottom; so the sum of depths is the sum over all
// unions of two sets of the height of the union less that of the higher bottom (Kruskal's rule: at each
// height the number of sets without ROOT is integrated).
//
// Each quadrilateral has at most one diagonal that matters. Let m be a lowest corner, m' the corner across, n
// and n' the others; all four sides are fixed. (a) nn' is of height max(n, n'), and there mn and mn' are too:
// it connects nothing that fixed edges of no greater height do not. (b) mm' is of height m', and may connect
// m' to m before n and n' are reached. If corners of both diagonals are lowest, both are as nn'.
//
// So no labelling connects at any height more than all mm' together, and that is the least depth of every
// pit. A labelling attains it exactly if at each height t its links of height t connect what all links of
// height t connect, among the sets that fixed edges up to t and all links below t leave (by induction over
// heights: those below are connected then). These sets are the nodes; they are different ones at each height,
// but for ROOT, which is node 0 at all: an articulation, so the conditions stay apart. A plateau that a link
// can drain is drained at its own height, so pits are fewest too.
//
// And no vertex can have less water on it when all pits are full. The water of a pit passes, spill by spill,
// to lower pits and out. Say that any labelling lets it out at height t or below: then the pit's spill, which
// is as low as it can be, is at most t, and so is, by induction, that of each pit that it comes to next,
// which that labelling and the links together connect with it up to t. Any other vertex leads down to a pit.
//
// Where depth does not come first it is the sum over heights of the number of sets without ROOT, under
// whatever links are chosen: pit_terms.hpp counts those, with the height to the next change as the weight of
// a set. Sets that links join are cut at the same heights (a cluster), so they have equal weights. Clusters
// with many links are left out, so that what is counted may be less than the depth, never more.
#include "optimize/spills.hpp"

#include "base/union_find.hpp"

#include <thalweg/mesh/edge_kind.hpp>

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <limits>
#include <map>
#include <tuple>
#include <utility>

namespace thalweg {

namespace {

constexpr std::uint32_t kRoot = 0;

std::uint32_t node_of(VertexId v) {
  return v.value() + 1;
}

/// Two vertices, or one and ROOT, that are connected from a height on. Of a diagonal: while its
/// quadrilateral has the label.
struct HeightEdge {
  double height = 0;
  std::uint32_t a = 0, b = 0;
  std::uint32_t quadrilateral = kNone;
  Label label = Label::Zero;
};

void sort_by_height(std::vector<HeightEdge>& edges) {
  tbb::parallel_sort(edges.begin(), edges.end(), [](const HeightEdge& x, const HeightEdge& y) {
    return std::tie(x.height, x.quadrilateral, x.a, x.b) < std::tie(y.height, y.quadrilateral, y.a, y.b);
  });
}

/// By height, then by what is the same under any ids: which of many links are left out depends on the order.
void sort_by_place(const Tin& tin, std::vector<HeightEdge>& edges) {
  const auto place = [&](std::uint32_t node) { return tin.point(VertexId{node - 1}); };
  for (HeightEdge& edge : edges) {
    if (edge.a != kRoot && place(edge.b) < place(edge.a)) std::swap(edge.a, edge.b);
  }
  tbb::parallel_sort(edges.begin(), edges.end(), [&](const HeightEdge& x, const HeightEdge& y) {
    if (x.height != y.height) return x.height < y.height;
    if (x.a == kRoot || y.a == kRoot) return x.a == kRoot && (y.a != kRoot || place(x.b) < place(y.b));
    return std::pair(place(x.a), place(x.b)) < std::pair(place(y.a), place(y.b));
  });
}

HeightEdge edge_between(const Tin& tin, VertexId a, VertexId b) {
  return {std::max(tin.height(a), tin.height(b)), node_of(a), node_of(b)};
}

/// What connects under all labels, sorted.
std::vector<HeightEdge> fixed_edges(const Tin& tin, std::span<const std::uint32_t> owner,
                                    const Progress& progress) {
  std::vector<HeightEdge> edges;
  edges.reserve(tin.edge_count());
  const auto drain = [&](VertexId v) { edges.push_back({tin.height(v), kRoot, node_of(v)}); };
  for (std::size_t i = 0; i < tin.halfedge_count(); ++i) {
    const HalfedgeId h{i}, twin = tin.twin(h);
    if (!tin.represents_edge(h)) continue;
    const VertexId a = tin.origin(h), b = tin.target(h);
    const bool lake = has(tin.kind(h), EdgeKind::Lake) && tin.height(a) == tin.height(b);
    if (!twin.valid() || lake) {
      drain(a);
      drain(b);
    }
    const std::uint32_t q = owner[Tin::triangle_of(h).index()];
    const bool diagonal = twin.valid() && q != kNone && q == owner[Tin::triangle_of(twin).index()];
    if (!diagonal) edges.push_back(edge_between(tin, a, b));
  }
  progress.check();
  sort_by_height(edges);
  return edges;
}

/// The diagonals that matter, sorted.
std::vector<HeightEdge> helpful_diagonals(const Tin& tin, std::span<const Quadrilateral> quadrilaterals) {
  std::vector<HeightEdge> links;
  for (std::uint32_t q = 0; q < quadrilaterals.size(); ++q) {
    const auto& [s, u, t, v, diagonal] = quadrilaterals[q];
    const double kept = std::min(tin.height(u), tin.height(v));
    const double flipped = std::min(tin.height(s), tin.height(t));
    if (kept == flipped) continue;
    links.push_back(kept < flipped ? edge_between(tin, u, v) : edge_between(tin, s, t));
    links.back().quadrilateral = q;
    links.back().label = kept < flipped ? Label::Zero : Label::One;
  }
  sort_by_height(links);
  return links;
}

/// Sets of vertices while the height rises, with their bottoms.
class Pools {
 public:
  Pools(const Tin& tin, double metres_per_unit)
      : sets_(tin.vertex_count() + 1), bottom_(tin.vertex_count() + 1) {
    bottom_[kRoot] = std::numeric_limits<double>::lowest();
    for (std::size_t v = 0; v < tin.vertex_count(); ++v) bottom_[v + 1] = tin.height(VertexId{v});
    metres_per_unit_ = metres_per_unit;
  }
  [[nodiscard]] std::int64_t steps(double height) const { return to_steps(height * metres_per_unit_); }
  std::uint32_t find(std::uint32_t node) { return sets_.find(node); }
  [[nodiscard]] double bottom(std::uint32_t set) const { return bottom_[set]; }
  /// Pre: a and b are different sets. Returns the depth of the one that ends, in steps.
  std::int64_t unite(std::uint32_t a, std::uint32_t b, double height) {
    const auto [older, younger] = std::minmax(bottom_[a], bottom_[b]);
    const std::int64_t depth = height > younger ? steps(height) - steps(younger) : 0;
    const double lowest = older;
    sets_.unite(a, b);
    bottom_[sets_.find(a)] = lowest;
    return depth;
  }

 private:
  UnionFind sets_;  // the smallest element stands for a set: ROOT for its own
  std::vector<double> bottom_;
  double metres_per_unit_ = 1;
};

}  // namespace

PlateauGraph find_spills(const Tin& tin, std::span<const Quadrilateral> quadrilaterals,
                         std::span<const std::uint32_t> owner, const Progress& progress) {
  const std::vector<HeightEdge> fixed = fixed_edges(tin, owner, progress);
  const std::vector<HeightEdge> links = helpful_diagonals(tin, quadrilaterals);
  progress.check();
  PlateauGraph graph;
  graph.link.resize(quadrilaterals.size());
  UnionFind sets(tin.vertex_count() + 1);
  std::vector<std::uint32_t> node(tin.vertex_count() + 1, kNone), touched;
  const auto node_of_set = [&](std::uint32_t set) {
    if (set == kRoot) return kRoot;
    if (node[set] == kNone) {
      node[set] = graph.node_count++;
      touched.push_back(set);
    }
    return node[set];
  };
  auto edge = fixed.begin();
  for (auto link = links.begin(); link != links.end();) {
    const auto end =
        std::find_if(link, links.end(), [&](const HeightEdge& l) { return l.height > link->height; });
    for (; edge != fixed.end() && edge->height <= link->height; ++edge) sets.unite(edge->a, edge->b);
    for (auto at = link; at != end; ++at) {
      const std::uint32_t a = sets.find(at->a), b = sets.find(at->b);
      if (a != b) graph.link[at->quadrilateral] = Link(node_of_set(a), node_of_set(b), at->label);
    }
    for (; link != end; ++link) sets.unite(link->a, link->b);
    for (const std::uint32_t set : touched) node[set] = kNone;
    touched.clear();
  }
  return graph;
}

WideSteps pit_depth_of(const Tin& tin, std::span<const Quadrilateral> quadrilaterals,
                       std::span<const Label> labels, double metres_per_unit, const Progress& progress) {
  const std::vector<std::uint32_t> owner = quadrilaterals_of_triangles(tin, quadrilaterals);
  std::vector<HeightEdge> edges = fixed_edges(tin, owner, progress);
  for (std::size_t q = 0; q < quadrilaterals.size(); ++q) {
    if (labels[q] != Label::One) edges.push_back(edge_between(tin, quadrilaterals[q].u, quadrilaterals[q].v));
    if (labels[q] != Label::Zero)
      edges.push_back(edge_between(tin, quadrilaterals[q].s, quadrilaterals[q].t));
  }
  sort_by_height(edges);
  progress.check();
  Pools pools(tin, metres_per_unit);
  WideSteps depth = 0;
  for (const HeightEdge& edge : edges) {
    const std::uint32_t a = pools.find(edge.a), b = pools.find(edge.b);
    if (a != b) depth += pools.unite(a, b, edge.height);
  }
  return depth;
}

namespace {

/// Sweeps heights upwards; writes down what links join of each cluster when it changes.
class DepthSweep {
 public:
  DepthSweep(const Tin& tin, double metres_per_unit)
      : pools_(tin, metres_per_unit),
        clusters_(tin.vertex_count() + 1),
        since_(tin.vertex_count() + 1, 0),
        until_(tin.vertex_count() + 1, kAlways) {}

  DepthTerms run(const std::vector<HeightEdge>& fixed, const std::vector<HeightEdge>& links,
                 std::span<const std::int64_t> tie) {
    auto link = links.begin();
    for (auto edge = fixed.begin(); edge != fixed.end();) {
      const double height = link == links.end() ? edge->height : std::min(edge->height, link->height);
      for (; edge != fixed.end() && edge->height == height; ++edge) unite(*edge);
      for (; link != links.end() && link->height == height; ++link) activate(*link);
    }
    return {{std::move(found_), std::move(weight_), tie}, constant_};
  }

 private:
  void unite(const HeightEdge& edge) {
    const std::uint32_t a = pools_.find(edge.a), b = pools_.find(edge.b);
    if (a == b) return;
    // A set that begins here changes nothing: it has no link yet.
    if (pools_.bottom(a) < edge.height && pools_.bottom(b) < edge.height) {
      for (const std::uint32_t set : {a, b}) {
        if (set != kRoot) settle(set, edge.height);
      }
    }
    constant_ += counted_depth(a, b, edge.height);
    if (a != kRoot && b != kRoot) unite_clusters(a, b);
    pools_.unite(a, b, edge.height);
  }

  /// The depth of the set that ends where these two meet, as far as it is counted.
  std::int64_t counted_depth(std::uint32_t a, std::uint32_t b, double height) {
    const std::uint32_t younger = pools_.bottom(a) > pools_.bottom(b) ? a : b;
    const std::int64_t from = pools_.steps(pools_.bottom(younger));
    return std::max<std::int64_t>(0, std::min(pools_.steps(height), until_[clusters_.find(younger)]) - from);
  }

  void activate(const HeightEdge& link) {
    const std::uint32_t a = pools_.find(link.a), b = pools_.find(link.b);
    if (a == b) return;
    for (const std::uint32_t set : {a, b}) {
      if (set != kRoot) settle(set, link.height);
    }
    if (a != kRoot && b != kRoot) unite_clusters(a, b);
    const std::uint32_t cluster = clusters_.find(a != kRoot ? a : b);
    if (until_[cluster] != kAlways) return;
    std::vector<HeightEdge>& all = active_[cluster];
    all.push_back(link);
    if (all.size() > kMostLinks) give_up(cluster, pools_.steps(link.height));
  }

  /// What so many links join may be joined in too many ways to be written down: from here on its sets are
  /// taken to be drained, which is less than what they cost.
  void give_up(std::uint32_t cluster, std::int64_t now) {
    until_[cluster] = std::min(until_[cluster], now);
    active_.erase(cluster);
  }

  void unite_clusters(std::uint32_t a, std::uint32_t b) {
    a = clusters_.find(a), b = clusters_.find(b);
    if (!clusters_.unite(a, b)) return;
    const std::uint32_t into = clusters_.find(a), from = into == a ? b : a;
    const auto moved = active_.find(from);
    const std::int64_t until = std::min(until_[a], until_[b]);
    if (until != kAlways) {
      until_[into] = until;
      active_.erase(a);
      active_.erase(b);
      return;
    }
    if (moved == active_.end()) return;
    since_[into] = since_[from];  // if both have links, both have just been settled
    std::vector<HeightEdge> links = std::move(moved->second);
    active_.erase(moved);
    std::vector<HeightEdge>& all = active_[into];
    all.insert(all.end(), links.begin(), links.end());
    if (all.size() > kMostLinks) give_up(into, since_[into]);
  }

  /// Writes down the sets of a cluster as they were from its last change up to this height.
  void settle(std::uint32_t set, double height) {
    const std::uint32_t cluster = clusters_.find(set);
    const std::int64_t now = pools_.steps(height), weight = now - since_[cluster];
    since_[cluster] = now;
    const auto found = active_.find(cluster);
    if (found == active_.end()) return;
    std::erase_if(found->second,
                  [&](const HeightEdge& link) { return pools_.find(link.a) == pools_.find(link.b); });
    if (weight == 0) return;
    std::map<std::uint32_t, std::uint32_t> node = {{kRoot, kRoot}};
    const auto node_of_set = [&](std::uint32_t of) {
      const auto [at, fresh] = node.try_emplace(of, static_cast<std::uint32_t>(weight_.size()));
      if (fresh) {
        weight_.push_back(weight);
        constant_ -= weight;
      }
      return at->second;
    };
    for (const HeightEdge& link : found->second) {
      const std::uint32_t a = node_of_set(pools_.find(link.a)), b = node_of_set(pools_.find(link.b));
      found_.push_back({a, b, {link.quadrilateral, link.label}});
    }
    if (found->second.empty()) active_.erase(found);
  }

  static constexpr std::size_t kMostLinks = 16;
  static constexpr std::int64_t kAlways = std::numeric_limits<std::int64_t>::max();

  Pools pools_;
  UnionFind clusters_;               ///< of sets that links, or what has become of sets, join
  std::vector<std::int64_t> since_;  ///< by cluster that has links: its last change, in steps
  std::map<std::uint32_t, std::vector<HeightEdge>> active_;  ///< by cluster
  std::vector<std::int64_t> until_;                          ///< by cluster: when it was given up, in steps
  std::vector<PitLink> found_;
  std::vector<std::int64_t> weight_ = {0};  ///< by node
  WideSteps constant_ = 0;
};

}  // namespace

DepthTerms find_depth_terms(const Tin& tin, std::span<const Quadrilateral> quadrilaterals,
                            std::span<const std::uint32_t> owner, double metres_per_unit,
                            std::span<const std::int64_t> tie, const Progress& progress) {
  std::vector<HeightEdge> fixed = fixed_edges(tin, owner, progress);
  std::vector<HeightEdge> links = helpful_diagonals(tin, quadrilaterals);
  for (std::vector<HeightEdge>* const edges : {&fixed, &links}) sort_by_place(tin, *edges);
  progress.check();
  return DepthSweep(tin, metres_per_unit).run(fixed, links, tie);
}

}  // namespace thalweg
