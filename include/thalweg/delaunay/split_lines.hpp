#pragma once

/// Vertices for lines where points lie on them or hardly beside them.

#include <thalweg/base/progress.hpp>
#include <thalweg/mesh/densify.hpp>
#include <thalweg/mesh/survey.hpp>

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

namespace thalweg {

/// Makes each point, and each vertex of a line, that lies within a snapping pixel (2^-44 of the power of two
/// above the largest coordinate) of a segment of a line a vertex of that line, unless it is as near to a
/// vertex that the line has. A hard line gives it the interpolated height, or the point's own if the two
/// agree. Coordinates are taken as they are: call it before a survey is projected, because straight lines
/// bend. Segments that jump by more than half of `x_period` (as in DensifyOptions) are left alone. Returns
/// how many vertices were added. Throws: Error{Cancelled}. Complexity: about (points + segments) log
/// segments.
std::size_t split_lines_at_points(Survey& survey, double x_period, Progress& progress);

/// The coordinates of a projected survey in its source.
struct WrittenSurvey {
  std::span<const Point2> points;
  std::span<std::vector<Point2>> lines;  ///< those that are added are added here too
};

/// Adds vertices to the lines of a projected survey until each point, and each vertex of a line, is on the
/// same side of every line in the plane as in its source's coordinates, where lines are straight as well: the
/// foot of what is not, or the place itself where it is within a snapping pixel of the line. Heights as
/// above. Returns how many. `to_plane` as for `densify_lines`, `resolution` as in GroundOptions; pre: no
/// segment bends by more than `options.limit`. Throws: what `to_plane` throws; Error{Cancelled}. Complexity:
/// as above.
std::size_t split_lines_beside_points(Survey& survey, WrittenSurvey written,
                                      const std::function<Point2(Point2)>& to_plane,
                                      const DensifyOptions& options, double resolution, Progress& progress);

}  // namespace thalweg
