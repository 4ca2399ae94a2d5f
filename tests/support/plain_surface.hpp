#pragma once

/// What a TIN is worth, by plain code that shares nothing with the library's optimiser.

#include <thalweg/mesh/tin.hpp>
#include <thalweg/order/quadrilaterals.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

namespace thalweg::test {

/// The TIN with the other diagonal in each quadrilateral whose flag is 1, put together anew from its
/// triangles.
inline Tin with_diagonals(const Tin& tin, std::span<const Quadrilateral> quadrilaterals,
                          std::span<const std::uint8_t> flipped) {
  std::vector<bool> covered(tin.triangle_count(), false);
  std::vector<Triangle> triangles;
  for (std::size_t i = 0; i < quadrilaterals.size(); ++i) {
    const auto& [s, u, t, v, diagonal] = quadrilaterals[i];
    covered[Tin::triangle_of(diagonal).index()] = true;
    covered[Tin::triangle_of(tin.twin(diagonal)).index()] = true;
    if (flipped[i] == 1) {
      triangles.insert(triangles.end(), {Triangle{s, u, t}, Triangle{t, v, s}});
    } else {
      triangles.insert(triangles.end(), {Triangle{u, v, s}, Triangle{v, u, t}});
    }
  }
  for (std::size_t i = 0; i < covered.size(); ++i) {
    if (!covered[i]) triangles.push_back(tin.triangle(TriangleId{i}));
  }
  return {{tin.points().begin(), tin.points().end()},
          {tin.heights().begin(), tin.heights().end()},
          std::move(triangles),
          tin.constraint_edges()};
}

/// For each edge the triangles that have it.
inline std::map<std::pair<VertexId, VertexId>, std::vector<Triangle>> triangles_by_edge(const Tin& tin) {
  std::map<std::pair<VertexId, VertexId>, std::vector<Triangle>> edges;
  for (const Triangle& t : tin.triangles()) {
    for (std::size_t i = 0; i < 3; ++i) edges[std::minmax(t[i], t[(i + 1) % 3])].push_back(t);
  }
  return edges;
}

inline double plain_normal_angle_sum(const Tin& tin, double horizontal = 1, double vertical = 1) {
  using Vector = std::array<long double, 3>;
  const auto corner = [&](VertexId v) {
    return Vector{tin.point(v).x * horizontal, tin.point(v).y * horizontal, tin.height(v) * vertical};
  };
  const auto normal = [&](const Triangle& t) {
    const Vector a = corner(t[0]), b = corner(t[1]), c = corner(t[2]);
    Vector n;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
      n[i] = (b[j] - a[j]) * (c[k] - a[k]) - (b[k] - a[k]) * (c[j] - a[j]);
    }
    return n;
  };
  long double sum = 0;
  for (const auto& [edge, triangles] : triangles_by_edge(tin)) {
    if (triangles.size() < 2) continue;
    const Vector m = normal(triangles[0]), n = normal(triangles[1]);
    long double dot = 0, cross_squared = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
      dot += m[i] * n[i];
      cross_squared += (m[j] * n[k] - m[k] * n[j]) * (m[j] * n[k] - m[k] * n[j]);
    }
    sum += std::atan2(std::sqrt(cross_squared), dot);
  }
  return static_cast<double>(sum);
}

/// Pits by the definition: flood each set of equal heights, look for the rim, a lower neighbour or an edge of
/// a lake.
inline std::size_t plain_pits(const Tin& tin) {
  const auto edges = triangles_by_edge(tin);
  std::vector<bool> reached(tin.vertex_count(), false);
  std::size_t pits = 0;
  for (std::size_t start = 0; start < tin.vertex_count(); ++start) {
    if (reached[start]) continue;
    std::vector<VertexId> plateau = {VertexId{start}};
    reached[start] = true;
    bool outlet = true;  // until an edge is seen: vertices in no triangle are no pits
    bool seen = false;
    for (std::size_t i = 0; i < plateau.size(); ++i) {
      for (const auto& [edge, triangles] : edges) {
        if (edge.first != plateau[i] && edge.second != plateau[i]) continue;
        if (!seen) outlet = false;
        seen = true;
        const VertexId across = edge.first == plateau[i] ? edge.second : edge.first;
        const bool level = tin.height(across) == tin.height(plateau[i]);
        HalfedgeId h = tin.find_halfedge(edge.first, edge.second);
        if (!h.valid()) h = tin.find_halfedge(edge.second, edge.first);
        outlet = outlet || triangles.size() < 2 || tin.height(across) < tin.height(plateau[i]) ||
                 (level && has(tin.kind(h), EdgeKind::Lake));
        if (!level || reached[across.index()]) continue;
        reached[across.index()] = true;
        plateau.push_back(across);
      }
    }
    pits += outlet ? 0 : 1;
  }
  return pits;
}

}  // namespace thalweg::test
