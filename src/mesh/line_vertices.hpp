#pragma once

/// Lines of a survey as segments, and more vertices for them.

#include <thalweg/geometry/point.hpp>
#include <thalweg/mesh/survey.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace thalweg {

/// All positions of a survey, points first.
std::vector<Point2> positions_of(const Survey& survey);

/// A segment of a line from its lexicographically smaller end to the other.
struct LineSegment {
  std::uint32_t line = 0;
  std::uint32_t vertex = 0;  ///< its first in the line's direction
  Point2 low, high;
  bool reversed = false;  ///< the line goes from `high` to `low`
  [[nodiscard]] std::size_t low_vertex() const { return vertex + (reversed ? 1U : 0U); }
  [[nodiscard]] std::size_t high_vertex() const { return vertex + (reversed ? 0U : 1U); }
};

/// Those of all lines, in order; not those whose ends are one place.
std::vector<LineSegment> line_segments(const Survey& survey);

/// A vertex to come, on a segment of `line_segments`.
struct LineVertex {
  std::uint32_t segment = 0;
  double along = 0;  ///< the part of the way from `low`
  Point2 xy;
  Point2 written;         ///< its source's coordinates, where they are not xy
  bool of_point = false;  ///< a point of the survey lies there
  double z = 0;           ///< of a hard line
  auto operator<=>(const LineVertex&) const = default;
};

/// What the segment's line says of the height there; 0 if it is not hard.
double height_on(const Survey& survey, const LineSegment& segment, double along);

/// Inserts the vertices into lines and, unless that is empty, into their source's coordinates; returns how
/// many. On a segment a place counts once, and what is of no point not at all where another is no more than
/// `apart` from it. Pre: `segments` are those of the survey.
std::size_t insert_line_vertices(Survey& survey, std::span<std::vector<Point2>> written_lines,
                                 std::span<const LineSegment> segments, std::vector<LineVertex> vertices,
                                 double apart);

/// The part of the way from `low` to `high` at which p is beside the segment.
inline double part_along(const LineSegment& segment, Point2 p) {
  const double dx = segment.high.x - segment.low.x, dy = segment.high.y - segment.low.y;
  return ((p.x - segment.low.x) * dx + (p.y - segment.low.y) * dy) / (dx * dx + dy * dy);
}

}  // namespace thalweg
