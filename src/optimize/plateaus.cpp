// Pits and connectivity.
//
// A plateau is a maximal set of vertices of equal height connected by fixed edges, that is, by all edges but
// the diagonals of quadrilaterals. It belongs to ROOT (node 0) if it is no pit whatever the diagonals: one of
// its vertices is on the rim, one of its fixed edges is a lake's, or a fixed edge leads to a lower vertex.
//
// Each quadrilateral offers at most one helpful diagonal. Let m be a lowest corner, m' the corner across, n
// and n' the others; all four sides are fixed.
// (a) nn' never helps. If n is higher than m, n is in ROOT; if it is as high, it is in m's plateau. So nn'
//     joins ROOT to ROOT, or m's plateau to itself, or leads from m's plateau to n' in ROOT, which is higher.
//     A lower neighbour gained by a vertex in ROOT is of no use.
// (b) mm' gives the plateau of m' a lower neighbour if m' is higher, and unites the plateaus of m and m' if
//     not. It helps only if m' is not in ROOT, in the first case, and if the plateaus differ and are not both
//     in ROOT, in the second. With two adjacent lowest corners m and n, (a) holds for both diagonals: m' is
//     beside n, so in ROOT if higher, in the same plateau if not. With two opposite lowest corners mm' is one
//     and the same.
//
// Draw an edge between ROOT and the plateau of m' in the first case, between the plateaus of m and m' in the
// second. Claim: the pits of a triangulation are the components, without ROOT, of the graph of its helpful
// diagonals. Proof. Edges between two nodes other than ROOT are level, so a component without ROOT lies
// within one plateau of the triangulation; by (a) no other diagonal unites plateaus that are not in ROOT, so
// two components without ROOT are two plateaus, unless a plateau of ROOT connects them, and then the last
// step before it is a level mm' to ROOT, which is an edge of the graph. A component without ROOT has no
// vertex on the rim and no lower fixed neighbour; a lower neighbour across a diagonal is an mm' of the first
// case, an edge to ROOT. So it is a pit. In a component with ROOT every plateau is connected by level edges
// to one that has a lower neighbour, or touches one of ROOT at its own height, and is no pit.
//
// So the fewest pits are those with all helpful diagonals at once, and a choice of diagonals attains them if
// and only if its helpful ones connect whatever all of them connect.
#include "optimize/plateaus.hpp"

#include "base/parallel.hpp"
#include "base/union_find.hpp"

#include <thalweg/base/assert.hpp>

#include <algorithm>
#include <atomic>
#include <utility>

namespace thalweg {

namespace {

constexpr std::size_t kBlock = 4096;

using VertexPair = std::pair<std::uint32_t, std::uint32_t>;

class Finder {
 public:
  Finder(const Tin& tin, std::span<const Quadrilateral> quadrilaterals, std::span<const std::uint32_t> owner)
      : tin_(tin), quadrilaterals_(quadrilaterals), owner_(owner) {}

  PlateauGraph find(const Progress& progress) {
    look_around(progress);
    number_nodes();
    PlateauGraph graph;
    graph.node_count = node_count_;
    graph.link.resize(quadrilaterals_.size());
    for_each_block(quadrilaterals_.size(), kBlock, progress, [&](std::size_t begin, std::size_t end) {
      for (std::size_t q = begin; q < end; ++q) graph.link[q] = link_of(quadrilaterals_[q]);
    });
    return graph;
  }

 private:
  /// Marks a vertex that is in ROOT by itself; several threads may do so.
  void drain(VertexId v) { std::atomic_ref(node_[v.index()]).store(0, std::memory_order_relaxed); }

  /// What the sides of triangles say of the corners that they start at; what they say of their ends their
  /// twins do. Whether one goes down is as good as random, so there is no branch: if it does not, a vertex
  /// that was drained before is drained again.
  void look_at(std::size_t begin, std::size_t end, std::vector<VertexPair>& level) {
    const TinArrays tin = tin_.arrays();                          // stores do not change these
    auto last = static_cast<std::uint32_t>(tin_.vertex_count());  // none
    for (std::size_t t = begin; t < end; ++t) {
      const std::uint32_t owner = owner_[t];
      const HalfedgeId diagonal = owner == kNone ? HalfedgeId{} : quadrilaterals_[owner].diagonal;
      for (std::size_t i = 0; i < 3; ++i) {
        const HalfedgeId h{3 * t + i}, twin = tin.twins[h.index()];
        const VertexId a = tin.triangles[t][i], b = tin.triangles[t][i == 2 ? 0 : i + 1];
        if (!twin.valid()) [[unlikely]] {
          drain(a);
          drain(b);
          continue;
        }
        const double at_a = tin.heights[a.index()], at_b = tin.heights[b.index()];
        const bool fixed = (h != diagonal) & (twin != diagonal);
        const std::uint32_t falls =
            static_cast<std::uint32_t>(fixed) & static_cast<std::uint32_t>(at_a > at_b);
        last ^= (last ^ a.value()) & (0 - falls);
        drain(VertexId{last});
        if (at_a == at_b && fixed) [[unlikely]]
          look_at_level(h, level);
      }
    }
  }

  void look_at_level(HalfedgeId h, std::vector<VertexPair>& level) {
    if (!tin_.represents_edge(h)) return;
    const VertexId a = tin_.origin(h), b = tin_.target(h);
    level.emplace_back(a.value(), b.value());
    if (!has(tin_.kind(h), EdgeKind::Lake)) return;
    drain(a);
    drain(b);
  }

  void look_around(const Progress& progress) {
    const std::size_t count = tin_.triangle_count();
    const std::vector<std::uint8_t> in_triangle = tin_.vertices_in_triangles();
    node_.resize(tin_.vertex_count() + 1);
    std::ranges::transform(in_triangle, node_.begin(), [](std::uint8_t in) { return in != 0 ? kNone : 0; });
    level_.resize((count + kBlock - 1) / kBlock);
    for_each_block(count, kBlock, progress,
                   [&](std::size_t begin, std::size_t end) { look_at(begin, end, level_[begin / kBlock]); });
  }

  /// Unites level neighbours; the sets' numbers are those of their first vertices in order.
  void number_nodes() {
    std::vector<std::uint32_t> alone;  // vertices that are not drained by themselves
    for (std::size_t v = 0; v < node_.size(); ++v) {
      if (node_[v] == 0) continue;
      alone.push_back(static_cast<std::uint32_t>(v));
      node_[v] = static_cast<std::uint32_t>(alone.size());
    }
    UnionFind sets(alone.size() + 1);
    for (const std::vector<VertexPair>& pairs : level_) {
      for (const auto& [v, w] : pairs) sets.unite(node_[v], node_[w]);
    }
    std::vector<std::uint32_t> number(alone.size() + 1, 0);
    for (std::uint32_t set = 1; set < number.size(); ++set) {
      if (sets.find(set) == set) number[set] = node_count_++;
    }
    for (const std::uint32_t v : alone) node_[v] = number[sets.find(node_[v])];
  }

  [[nodiscard]] Link link_of(const Quadrilateral& quadrilateral) const {
    const auto& [s, u, t, v, diagonal] = quadrilateral;
    const double lowest_kept = std::min(tin_.height(u), tin_.height(v));
    const double lowest_new = std::min(tin_.height(s), tin_.height(t));
    if (lowest_kept == lowest_new) return {};
    const bool kept = lowest_kept < lowest_new;
    const VertexId a = kept ? u : s, b = kept ? v : t;
    const double at_a = tin_.height(a), at_b = tin_.height(b);
    const Label helpful = kept ? Label::Zero : Label::One;
    if (at_a != at_b) return {0, node_[(at_a < at_b ? b : a).index()], helpful};
    return {node_[a.index()], node_[b.index()], helpful};
  }

  const Tin& tin_;
  std::span<const Quadrilateral> quadrilaterals_;
  std::span<const std::uint32_t> owner_;
  std::vector<std::uint32_t> node_;             ///< by vertex; the last is none
  std::vector<std::vector<VertexPair>> level_;  ///< by block of halfedges
  std::uint32_t node_count_ = 1;
};

}  // namespace

PlateauGraph find_plateaus(const Tin& tin, std::span<const Quadrilateral> quadrilaterals,
                           std::span<const std::uint32_t> owner, const Progress& progress) {
  return Finder(tin, quadrilaterals, owner).find(progress);
}

std::size_t count_pits(const PlateauGraph& graph, std::span<const Label> labels) {
  UnionFind nodes(graph.node_count);
  std::size_t components = graph.node_count;
  for (std::size_t q = 0; q < graph.link.size(); ++q) {
    const Link& link = graph.link[q];
    if (!link.exists() || labels[q] == other(link.helpful())) continue;
    components -= nodes.unite(link.a, link.b) ? 1 : 0;
  }
  return components - 1;
}

}  // namespace thalweg
