#pragma once

/// Exact questions about segments, their crossings, and cells.
/// Pre (all): segments are no points; coordinates are within 1e15.

#include <thalweg/geometry/point.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace thalweg {

struct Segment {
  Point2 a;
  Point2 b;
};

/// The spacing of doubles from the magnitude of a coordinate on.
inline double spacing_at(double coordinate) {
  const double magnitude = std::abs(coordinate);
  return std::nextafter(magnitude, std::numeric_limits<double>::infinity()) - magnitude;
}

/// The half-open box about a vertex that stands for it on a grid: centre - half <= p < centre + half in x and
/// in y. Its sides are as wide as the grid, or as the spacing of doubles at the vertex where that is wider.
struct Cell {
  Point2 centre;
  double half_x = 0;
  double half_y = 0;

  Cell(Point2 vertex, double grid)
      : centre(vertex),
        half_x(std::max(grid, spacing_at(vertex.x)) / 2),
        half_y(std::max(grid, spacing_at(vertex.y)) / 2) {}
};

/// True if the closed segment holds a point of the cell.
bool meets_cell(const Segment& s, const Cell& cell);

/// True if, on the way from a to b, the segment enters the first cell before the second; ties go to the
/// smaller centre. Pre: it meets both.
bool enters_before(const Segment& s, const Cell& first, const Cell& second);

/// True if the crossing of two segments lies in the cell. Pre: they cross properly.
bool crosses_in_cell(const Segment& s, const Segment& t, const Cell& cell);

/// The node whose cell holds the crossing: in x, and in y, a multiple of `grid`, or any double where doubles
/// are farther apart than that; halves go up. Pre: they cross properly; `grid` is a power of two.
Point2 round_crossing(const Segment& s, const Segment& t, double grid);

}  // namespace thalweg
