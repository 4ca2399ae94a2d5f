#pragma once

/// Vertices for lines where points lie on them.

#include <thalweg/base/progress.hpp>
#include <thalweg/mesh/survey.hpp>

#include <cstddef>

namespace thalweg {

/// Makes each point, and each vertex of a line, that lies exactly on a segment of a line a vertex of that
/// line; a hard line gives it the interpolated height. Coordinates are taken as they are: call it before a
/// survey is projected, because straight lines bend. Returns how many vertices were added. Complexity: about
/// (points + segments) log segments.
std::size_t split_lines_at_points(Survey& survey, Progress& progress);

}  // namespace thalweg
