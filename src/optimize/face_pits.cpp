// Nodes and links.
//
// Plateaus of fixed edges, and ROOT, are those of plateaus.cpp. A free edge joins the node of its higher end
// to ROOT, or, if it is level, the nodes of its ends. Claim: the pits of a triangulation are the components,
// without ROOT, of the graph of its free edges. Proof. Edges between nodes other than ROOT are level, so a
// component without ROOT is connected and level in the triangulation; none of its vertices has a level
// neighbour elsewhere, a lower one, or is on the rim: it is a pit. In a component with ROOT each node is
// joined by level edges to one whose own edge leads to ROOT: down, or level to a plateau that is drained; so
// it is no pit.
#include "optimize/face_pits.hpp"

#include <thalweg/mesh/edge_kind.hpp>

#include <algorithm>

namespace thalweg {

namespace {

constexpr std::uint32_t kNoNode = 0xffffffffU;

/// Marks with node 0 what is drained by itself: the rim, and vertices in no triangle.
std::vector<std::uint32_t> start_nodes(const Tin& tin) {
  const std::vector<bool> rim = tin.rim_vertices();
  std::vector<std::uint32_t> node(tin.vertex_count(), kNoNode);
  for (std::size_t v = 0; v < rim.size(); ++v) {
    if (rim[v]) node[v] = 0;
  }
  return node;
}

}  // namespace

PlateauNodes find_plateau_nodes(const Tin& tin, const FixedFaces& faces) {
  std::vector<std::uint32_t> node = start_nodes(tin);
  UnionFind level(tin.vertex_count());
  for (const CandidateEdge& edge : faces.edges) {
    if (edge.free) continue;
    const double a = tin.height(edge.a), b = tin.height(edge.b);
    const bool lake = edge.ground.valid() && has(tin.kind(edge.ground), EdgeKind::Lake);
    if (a > b || (a == b && lake)) node[edge.a.index()] = 0;
    if (b > a || (a == b && lake)) node[edge.b.index()] = 0;
    if (a == b) level.unite(edge.a.value(), edge.b.value());
  }
  for (std::uint32_t v = 0; v < node.size(); ++v) {
    if (node[v] == 0) node[level.find(v)] = 0;
  }
  std::uint32_t count = 1;
  for (std::uint32_t v = 0; v < node.size(); ++v) {
    if (level.find(v) == v && node[v] == kNoNode) node[v] = count++;
  }
  for (std::uint32_t v = 0; v < node.size(); ++v) node[v] = node[level.find(v)];
  PlateauNodes nodes;
  nodes.node_count = count;
  nodes.sets = UnionFind(count);
  nodes.link.assign(faces.edges.size(), {0, 0});
  for (std::size_t e = 0; e < faces.edges.size(); ++e) {
    const CandidateEdge& edge = faces.edges[e];
    if (!edge.free) continue;
    const double a = tin.height(edge.a), b = tin.height(edge.b);
    const std::uint32_t of_a = node[edge.a.index()], of_b = node[edge.b.index()];
    if (a == b) {
      nodes.link[e] = {std::max(of_a, of_b), std::min(of_a, of_b)};
    } else {
      nodes.link[e] = {a > b ? of_a : of_b, 0};
    }
  }
  return nodes;
}

std::size_t count_pits(const Tin& tin) {
  std::vector<std::uint32_t> node = start_nodes(tin);
  UnionFind level(tin.vertex_count());
  for (std::size_t i = 0; i < tin.halfedge_count(); ++i) {
    const HalfedgeId h{i};
    const VertexId v = tin.origin(h), w = tin.target(h);
    if (tin.height(w) > tin.height(v)) {
      node[w.index()] = 0;
    } else if (tin.height(w) < tin.height(v) || has(tin.kind(h), EdgeKind::Lake)) {
      node[v.index()] = 0;
    }
    if (tin.height(w) == tin.height(v)) level.unite(v.value(), w.value());
  }
  for (std::uint32_t v = 0; v < node.size(); ++v) {
    if (node[v] == 0) node[level.find(v)] = 0;
  }
  std::size_t pits = 0;
  for (std::uint32_t v = 0; v < node.size(); ++v) pits += level.find(v) == v && node[v] != 0 ? 1 : 0;
  return pits;
}

}  // namespace thalweg
