#pragma once

/// The triangles of a Delaunay triangulation in the making: flat, with neighbours, closed to a sphere.

#include <thalweg/geometry/predicates.hpp>
#include <thalweg/mesh/edge_kind.hpp>

#include <array>
#include <cstdint>
#include <span>

namespace thalweg::detail {

/// A triangle, or outside of a hull edge a ghost: one corner is the vertex at infinity, and the region is
/// what lies beyond the edge. Corners run counter-clockwise; side i lies opposite to corner i.
struct alignas(32) Cell {
  std::array<std::uint32_t, 3> vertex{};
  std::array<std::uint32_t, 3> neighbour{};  ///< for each side: the side of the neighbour, as `side_of`
  std::array<EdgeKind, 3> kind{};            ///< of each side
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
// Two bits a corner: a comparison would become a branch that no processor can foresee.
constexpr std::uint32_t after(std::uint32_t corner) {
  return 0b00'10'01U >> (2 * corner) & 3U;
}
constexpr std::uint32_t before(std::uint32_t corner) {
  return 0b01'00'10U >> (2 * corner) & 3U;
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

/// As `in_conflict`, where its filter does not decide.
bool in_conflict_unsure(const Cell& cell, const Positions& at, Point2 p);

/// Whether p lies inside the circle of a cell under the tie rule; of a ghost: beyond its hull edge.
/// Without a branch on the answer, which no processor can foresee.
inline bool in_conflict(const Cell& cell, const Positions& at, Point2 p) {
  const RoundedDeterminant inside =
      in_circle_rounded(at[cell.vertex[0]], at[cell.vertex[1]], at[cell.vertex[2]], p);
  return inside.sure() ? inside.value > 0 : in_conflict_unsure(cell, at, p);
}

inline void link(std::span<Cell> cells, std::uint32_t side, std::uint32_t other) {
  cells[cell_of(side)].neighbour[corner_of(side)] = other;
  cells[cell_of(other)].neighbour[corner_of(other)] = side;
}

}  // namespace thalweg::detail
