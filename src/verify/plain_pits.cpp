// A labelling has the fewest pits exactly if the diagonals that it chooses connect all that all diagonals
// could connect. So for each set of undrained plateaus that some diagonal leaves, one such diagonal is
// chosen.
#include "verify/plain_pits.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <utility>

namespace thalweg::verify {

namespace {

Index find(std::vector<Index>& parent, Index v) {
  while (parent[v] != v) v = parent[v] = parent[parent[v]];
  return v;
}

}  // namespace

PlainPlateaus::PlainPlateaus(const PlainMesh& delaunay, std::span<const PlainQuadrilateral> quadrilaterals) {
  const std::size_t n = delaunay.xy.size();
  std::vector<std::pair<Index, Index>> diagonals;
  for (const PlainQuadrilateral& q : quadrilaterals) diagonals.emplace_back(std::minmax(q.u, q.v));
  std::sort(diagonals.begin(), diagonals.end());
  std::vector<std::pair<Index, Index>> fixed;
  std::vector<bool> drained(n, false);
  for (std::size_t t = 0; t < delaunay.triangles.size(); ++t) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Index a = delaunay.triangles[t][i], b = delaunay.triangles[t][(i + 1) % 3];
      if (delaunay.across[t][i] == kNone) drained[a] = drained[b] = true;
      const std::pair<Index, Index> edge = std::minmax(a, b);
      if (!std::binary_search(diagonals.begin(), diagonals.end(), edge)) fixed.push_back(edge);
    }
  }
  std::vector<Index> parent(n + 1);
  std::iota(parent.begin(), parent.end(), Index{0});
  for (const auto& [a, b] : fixed) {
    if (delaunay.z[a] == delaunay.z[b]) parent[find(parent, a)] = find(parent, b);
    if (delaunay.z[a] > delaunay.z[b]) drained[a] = true;
    if (delaunay.z[b] > delaunay.z[a]) drained[b] = true;
  }
  for (const auto& [edge, kind] : delaunay.constraints) {
    const bool level = delaunay.z[edge.first] == delaunay.z[edge.second];
    if (has(kind, EdgeKind::Lake) && level) drained[edge.first] = drained[edge.second] = true;  // a lake
  }
  drained_ = static_cast<Index>(n);
  for (Index v = 0; v < n; ++v) {
    if (drained[v]) parent[find(parent, v)] = find(parent, drained_);
  }
  is_plateau_.assign(n + 1, false);
  std::vector<bool> used(n, false);
  for (const auto& [a, b] : fixed) used[a] = used[b] = true;
  const Index root = find(parent, drained_);
  const auto node = [&](Index v) { return find(parent, v) == root ? drained_ : find(parent, v); };
  for (Index v = 0; v < n; ++v) {
    if (used[v] && node(v) != drained_) is_plateau_[node(v)] = true;
  }
  std::vector<PlainLink> links;
  for (Index q = 0; q < quadrilaterals.size(); ++q) {
    const auto& [s, u, t, v, left, right] = quadrilaterals[q];
    for (const bool label : {false, true}) {
      Index high = label ? s : u, low = label ? t : v;
      if (delaunay.z[high] < delaunay.z[low]) std::swap(high, low);
      const Index from = node(high), to = delaunay.z[high] == delaunay.z[low] ? node(low) : drained_;
      if (from != to) links.push_back({q, label, from, to});
    }
  }
  links_ = PlainLinks(std::move(links), n + 1);
}

PlainPlateaus::PlainPlateaus(PlainLinks links, Index drained)
    : links_(std::move(links)), drained_(drained), is_plateau_(links_.node_count(), true) {}

std::size_t PlainPlateaus::fewest() const {
  std::vector<Index> parent(is_plateau_.size());
  std::iota(parent.begin(), parent.end(), Index{0});
  for (const PlainLink& link : links_.all()) parent[find(parent, link.a)] = find(parent, link.b);
  std::size_t count = 0;
  std::vector<bool> seen(parent.size(), false);
  seen[find(parent, drained_)] = true;
  for (Index v = 0; v < parent.size(); ++v) {
    if (!is_plateau_[v] || seen[find(parent, v)]) continue;
    seen[find(parent, v)] = true;
    ++count;
  }
  return count;
}

// One clause for each set; a diagonal leaves a set if its ends are in different ones.
std::vector<Factor> PlainPlateaus::clauses(const std::vector<Index>& set_of_node) const {
  constexpr std::size_t kLargest = 14;  // a clause that is left out makes the bound weaker, never wrong
  std::map<Index, std::map<Index, std::array<bool, 2>>> leaving;  // set -> quadrilateral -> labels that leave
  for (const PlainLink& link : links_.all()) {
    const Index a = set_of_node[link.a], b = set_of_node[link.b];
    if (a == b) continue;
    for (const Index set : {a, b}) {
      if (set != set_of_node[drained_]) leaving[set][link.quadrilateral][link.label ? 1 : 0] = true;
    }
  }
  std::vector<Factor> factors;
  for (const auto& [set, labels] : leaving) {
    if (labels.size() > kLargest) continue;
    Factor clause;
    for (const auto& [q, leaves] : labels) clause.scope.push_back(q);
    clause.table.resize(std::size_t{1} << labels.size());
    for (std::size_t i = 0; i < clause.table.size(); ++i) {
      std::size_t place = 0;
      bool satisfied = false;
      for (const auto& [q, leaves] : labels) satisfied |= leaves[i >> place++ & 1U];
      clause.table[i][0] = satisfied ? 0 : 1;
    }
    factors.push_back(std::move(clause));
  }
  return factors;
}

std::vector<Factor> PlainPlateaus::plateau_clauses() const {
  std::vector<Index> own(is_plateau_.size());
  std::iota(own.begin(), own.end(), Index{0});
  return clauses(own);
}

std::vector<Factor> PlainPlateaus::broken_clauses(const std::vector<bool>& labels) const {
  std::vector<Index> parent(is_plateau_.size());
  std::iota(parent.begin(), parent.end(), Index{0});
  for (const PlainLink& link : links_.all()) {
    if (labels[link.quadrilateral] == link.label) parent[find(parent, link.a)] = find(parent, link.b);
  }
  std::vector<Index> set(parent.size());
  for (Index v = 0; v < set.size(); ++v) set[v] = find(parent, v);
  return clauses(set);
}

}  // namespace thalweg::verify
