// Pits, plateaus taken as one.
//
// 1. Over all triangles, in parallel: mark each vertex that has a lower neighbour, a level one, a higher one,
//    and that is on the rim.
// 2. A vertex with higher neighbours alone is a pit by itself. One with level but no lower neighbours may be
//    part of a pit: walk its plateau through level edges; it is a pit if no vertex of it has a lower
//    neighbour. Each plateau is walked once.
#include "base/parallel.hpp"

#include <thalweg/terrain/pits.hpp>

#include <array>
#include <atomic>
#include <span>

namespace thalweg {

namespace {

struct Traits {
  std::vector<std::uint8_t> has_lower;
  std::vector<std::uint8_t> has_level;
  std::vector<std::uint8_t> has_higher;
  std::vector<std::uint8_t> on_rim;
};

// All threads write the same value, so their order does not matter.
void mark(std::vector<std::uint8_t>& marks, VertexId v) {
  std::atomic_ref<std::uint8_t>(marks[v.index()]).store(1, std::memory_order_relaxed);
}

// Both sides of an edge mark the same: that costs less than to ask which one is to do it.
void mark_side(const Tin& tin, HalfedgeId h, VertexId a, VertexId b, Traits& traits) {
  const double z_a = tin.height(a), z_b = tin.height(b);
  if (z_a != z_b) {
    mark(traits.has_lower, z_a > z_b ? a : b);
    mark(traits.has_higher, z_a > z_b ? b : a);
  } else {
    mark(traits.has_level, a);
    mark(traits.has_level, b);
  }
  if (tin.on_rim(h)) {
    mark(traits.on_rim, a);
    mark(traits.on_rim, b);
  }
}

Traits compare_neighbours(const Tin& tin) {
  constexpr std::size_t kBlock = 16384;
  const std::size_t n = tin.vertex_count();
  const std::vector<std::uint8_t> none(n, 0);
  Traits traits{none, none, none, none};
  for_each_block(tin.triangle_count(), kBlock, Progress(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      const auto [a, b, c] = tin.triangle(TriangleId{t});
      mark_side(tin, HalfedgeId{3 * t}, a, b, traits);
      mark_side(tin, HalfedgeId{3 * t + 1}, b, c, traits);
      mark_side(tin, HalfedgeId{3 * t + 2}, c, a, traits);
    }
  });
  return traits;
}

struct Plateau {
  std::vector<VertexId> vertices;
  bool has_lower = false;
  bool on_rim = false;
  bool is_lake = false;
};

// Fills `plateau` with the vertices that level edges connect to `seed`, and marks them as visited.
void walk(const Tin& tin, const Traits& traits, VertexId seed, std::vector<std::uint8_t>& visited,
          Plateau& plateau) {
  plateau.vertices.assign(1, seed);
  plateau.has_lower = plateau.on_rim = plateau.is_lake = false;
  visited[seed.index()] = 1;
  const double height = tin.height(seed);
  for (std::size_t next = 0; next < plateau.vertices.size(); ++next) {
    const VertexId v = plateau.vertices[next];
    plateau.has_lower |= traits.has_lower[v.index()] != 0;
    plateau.on_rim |= traits.on_rim[v.index()] != 0;
    for (const HalfedgeId out : tin.outgoing(v)) {
      const HalfedgeId in = Tin::previous(out);  // on the rim the only halfedge between its ends
      for (const auto& [other, edge] : {std::pair(tin.target(out), out), std::pair(tin.origin(in), in)}) {
        if (tin.height(other) != height) continue;
        plateau.is_lake |= has(tin.kind(edge), EdgeKind::Lake);
        if (visited[other.index()] != 0) continue;
        visited[other.index()] = 1;
        plateau.vertices.push_back(other);
      }
    }
  }
}

}  // namespace

PitSummary find_pits(const Tin& tin) {
  const Traits traits = compare_neighbours(tin);
  PitSummary summary;
  summary.is_pit.assign(tin.vertex_count(), 0);
  const auto count = [&](const Plateau& pit, std::span<const VertexId> vertices) {
    const PitKind kind = pit.on_rim ? PitKind::Boundary : pit.is_lake ? PitKind::Lake : PitKind::Interior;
    ++(pit.on_rim ? summary.boundary : pit.is_lake ? summary.lake : summary.interior);
    for (const VertexId v : vertices) summary.is_pit[v.index()] = static_cast<std::uint8_t>(kind);
  };
  std::vector<std::uint8_t> visited(tin.vertex_count(), 0);
  Plateau plateau;
  for (std::size_t i = 0; i < tin.vertex_count(); ++i) {
    const VertexId v{i};
    if (traits.has_lower[i] != 0 || visited[i] != 0) continue;
    if (traits.has_level[i] != 0) {
      walk(tin, traits, v, visited, plateau);
      if (!plateau.has_lower) count(plateau, plateau.vertices);
    } else if (traits.has_higher[i] != 0) {
      count({.vertices = {}, .on_rim = traits.on_rim[i] != 0}, std::array{v});
    }
  }
  return summary;
}

}  // namespace thalweg
