#pragma once

/// Full pits of a TIN by plain code.

#include "support/plain_surface.hpp"

#include <thalweg/mesh/tin.hpp>

#include <algorithm>
#include <limits>
#include <set>
#include <utility>
#include <vector>

namespace thalweg::test {

/// How high water stands on each vertex if all pits are full; its own height where none does, or where it
/// is in no triangle. Lowered edge by edge from nothing, until nothing changes.
inline std::vector<double> fill_levels(const Tin& tin) {
  constexpr double kDry = std::numeric_limits<double>::infinity();
  std::set<std::pair<VertexId, VertexId>> lakes;
  for (const ConstraintEdge& edge : tin.constraint_edges()) {
    if (has(edge.kind, EdgeKind::Lake)) lakes.insert(std::minmax(edge.a, edge.b));
  }
  const auto edges = triangles_by_edge(tin);
  std::vector<double> level(tin.vertex_count(), kDry);
  const auto lower = [&](VertexId v, double from) {
    const double now = std::max(from, tin.height(v));
    const bool changes = now < level[v.index()];
    if (changes) level[v.index()] = now;
    return changes;
  };
  for (bool changed = true; changed;) {
    changed = false;
    for (const auto& [edge, triangles] : edges) {
      const auto [a, b] = edge;
      const bool lake = lakes.contains(edge) && tin.height(a) == tin.height(b);
      const double outside = triangles.size() < 2 || lake ? -kDry : kDry;
      changed |= lower(a, std::min(outside, level[b.index()]));
      changed |= lower(b, std::min(outside, level[a.index()]));
    }
  }
  for (std::size_t v = 0; v < level.size(); ++v) {
    if (level[v] == kDry) level[v] = tin.height(VertexId{v});
  }
  return level;
}

}  // namespace thalweg::test
