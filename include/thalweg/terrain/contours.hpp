#pragma once

/// Lines of equal height on a TIN.

#include <thalweg/base/progress.hpp>
#include <thalweg/mesh/tin.hpp>

#include <cstddef>
#include <vector>

namespace thalweg {

/// One contour line. A closed line repeats its first point at the end.
struct ContourLine {
  double height = 0;
  bool closed = false;
  std::vector<Point2> points;
};

struct ContourOptions {
  double interval = 0;  ///< between heights, in the TIN's unit of heights; positive
  double base = 0;      ///< a height that is one of the contours' heights
};

/// The contours at base + n interval, for every whole n within the range of the surface's heights.
///
/// The contour of a height H is the boundary, within the surface, of the ground at or above H: so a plateau
/// at exactly H has its rim for a contour, and a flat floor at exactly H has none. Laws: (1) a line is closed
/// or ends on the rim, but where lines meet in a crest at exactly H; (2) the ground rises to the right of a
/// line's direction, but of a crest, which falls to both sides; (3) no piece of a line is there twice, none
/// has length zero; (4) lines of one height do not cross; (5) the lines, sorted by height, do not depend on
/// the order of vertices or triangles but for where a closed line starts.
/// Throws: Error{Usage} for an interval that is not positive or gives more than a million heights;
/// Error{Cancelled}. Complexity: linear in triangles and in crossings.
std::vector<ContourLine> trace_contours(const Tin& tin, const ContourOptions& options, Progress& progress);

}  // namespace thalweg
