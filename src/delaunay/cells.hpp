#pragma once

/// The triangles of a Delaunay triangulation in the making: flat, with neighbours, closed to a sphere.

#include <thalweg/geometry/predicates.hpp>

#include <array>
#include <cstdint>
#include <span>

namespace thalweg::detail {

/// A triangle, or outside of a hull edge a ghost: one corner is the vertex at infinity, and the region is
/// what lies beyond the edge. Corners run counter-clockwise; side i lies opposite to corner i.
struct alignas(32) Cell {
  std::array<std::uint32_t, 3> vertex{};
  std::array<std::uint32_t, 3> neighbour{};  ///< for each side: the side of the neighbour, as `side_of`
  std::uint32_t constrained = 0;             ///< bit i: side i is a constraint edge
  std::uint32_t mark = 0;                    ///< scratch of whoever works on the cells
};

/// Sides are named 4 * cell + corner.
constexpr std::uint32_t side_of(std::uint32_t cell, std::uint32_t corner) {
  return 4 * cell + corner;
}
constexpr std::uint32_t cell_of(std::uint32_t side) {
  return side >> 2U;
}
constexpr std::uint32_t corner_of(std::uint32_t side) {
  return side & 3U;
}
constexpr std::uint32_t after(std::uint32_t corner) {
  return corner == 2 ? 0 : corner + 1;
}
constexpr std::uint32_t before(std::uint32_t corner) {
  return corner == 0 ? 2 : corner - 1;
}

/// Vertices of a triangulation: `positions` ends with the vertex at infinity, whose coordinates are NaN, so
/// that no floating-point filter ever decides about it.
struct Positions {
  std::span<const Point2> positions;
  [[nodiscard]] const Point2& operator[](std::uint32_t v) const { return positions[v]; }
  [[nodiscard]] std::uint32_t infinity() const { return static_cast<std::uint32_t>(positions.size() - 1); }
};

/// Whether p lies beyond the hull edge of a ghost cell, or on the open edge itself.
bool beyond_hull_edge(const Cell& ghost, const Positions& at, Point2 p);

/// Whether p lies inside the circle of a cell under the tie rule; of a ghost: beyond its hull edge.
inline bool in_conflict(const Cell& cell, const Positions& at, Point2 p) {
  const Point2 a = at[cell.vertex[0]];
  const Point2 b = at[cell.vertex[1]];
  const Point2 c = at[cell.vertex[2]];
  if (const int sign = in_circle_filtered(a, b, c, p); sign != kUndecided) return sign > 0;
  const std::uint32_t infinity = at.infinity();
  if (cell.vertex[0] == infinity || cell.vertex[1] == infinity || cell.vertex[2] == infinity) {
    return beyond_hull_edge(cell, at, p);
  }
  return in_circle_perturbed(a, b, c, p);
}

inline void link(std::span<Cell> cells, std::uint32_t side, std::uint32_t other) {
  cells[cell_of(side)].neighbour[corner_of(side)] = other;
  cells[cell_of(other)].neighbour[corner_of(other)] = side;
}

}  // namespace thalweg::detail
