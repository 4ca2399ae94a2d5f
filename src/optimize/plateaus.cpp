// Pits and connectivity.
//
// A plateau is a maximal set of vertices of equal height connected by fixed edges, that is, by all edges but
// the diagonals of quadrilaterals. It belongs to ROOT (node 0) if it is no pit whatever the diagonals: one of
// its vertices is on the rim, one of its fixed edges is a lake's, or a fixed edge leads to a lower vertex.
//
// Each quadrilateral offers at most one helpful diagonal. Let m be a lowest corner, m' the corner across, n
// and n' the others; all four sides are fixed. (a) nn' never helps. If n is higher than m, n is in ROOT; if
// it is as high, it is in m's plateau. So nn' joins
//     ROOT to ROOT, or m's plateau to itself, or leads from m's plateau to n' in ROOT, which is higher. A
//     lower neighbour gained by a vertex in ROOT is of no use.
// (b) mm' gives the plateau of m' a lower neighbour if m' is higher, and unites the plateaus of m and m' if
// not. It
//     helps only if m' is not in ROOT, in the first case, and if the plateaus differ and are not both in
//     ROOT, in the second. With two adjacent lowest corners m and n, (a) holds for both diagonals: m' is
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

  /// What an edge says of its ends; that both triangles have one owner means that it is a diagonal.
  void look_at(HalfedgeId h, std::vector<VertexPair>& level) {
    const HalfedgeId twin = tin_.twin(h);
    if (twin.valid() && twin < h) return;
    const VertexId a = tin_.origin(h), b = tin_.target(h);
    if (!twin.valid()) {
      drain(a);
      drain(b);
    } else if (const std::uint32_t q = owner_[Tin::triangle_of(h).index()];
               q != kNone && q == owner_[Tin::triangle_of(twin).index()]) {
      return;
    }
    const double at_a = tin_.height(a), at_b = tin_.height(b);
    if (at_a != at_b) return drain(at_a > at_b ? a : b);
    level.emplace_back(a.value(), b.value());
    if (!has(tin_.kind(h), EdgeKind::Lake)) return;
    drain(a);
    drain(b);
  }

  void look_around(const Progress& progress) {
    const std::size_t count = tin_.halfedge_count();
    const std::vector<std::uint8_t> in_triangle = tin_.vertices_in_triangles();
    node_.resize(tin_.vertex_count());
    std::ranges::transform(in_triangle, node_.begin(), [](std::uint8_t in) { return in != 0 ? kNone : 0; });
    level_.resize((count + kBlock - 1) / kBlock);
    for_each_block(count, kBlock, progress, [&](std::size_t begin, std::size_t end) {
      for (std::size_t h = begin; h < end; ++h) look_at(HalfedgeId{h}, level_[begin / kBlock]);
    });
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
    const double lowest_kept = std::min(tin_.height(quadrilateral.u), tin_.height(quadrilateral.v));
    const double lowest_new = std::min(tin_.height(quadrilateral.s), tin_.height(quadrilateral.t));
    if (lowest_kept == lowest_new) return {};
    const bool kept = lowest_kept < lowest_new;
    VertexId low = kept ? quadrilateral.u : quadrilateral.s, high = kept ? quadrilateral.v : quadrilateral.t;
    const bool level = tin_.height(high) == tin_.height(low);
    if (level ? tin_.point(high) < tin_.point(low) : tin_.height(high) < tin_.height(low))
      std::swap(low, high);
    return {level ? node_[low.index()] : 0, node_[high.index()], kept ? Label::Zero : Label::One};
  }

  const Tin& tin_;
  std::span<const Quadrilateral> quadrilaterals_;
  std::span<const std::uint32_t> owner_;
  std::vector<std::uint32_t> node_;             ///< by vertex
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
    if (!link.exists() || labels[q] == other(link.helpful)) continue;
    components -= nodes.unite(link.a, link.b) ? 1 : 0;
  }
  return components - 1;
}

}  // namespace thalweg
