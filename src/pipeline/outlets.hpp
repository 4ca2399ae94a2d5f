#pragma once

/// Points where water leaves, as the user gives them.

#include "pipeline/plane.hpp"
#include "terrain/triangle_grid.hpp"

#include <thalweg/base/progress.hpp>
#include <thalweg/io/source.hpp>
#include <thalweg/mesh/tin.hpp>

#include <vector>

namespace thalweg {

/// All points of the sources in `crs`, which is also that of a source that declares none. Throws: as
/// read_survey.
std::vector<Point2> read_places(const std::vector<SourceSpec>& sources, const CrsInfo& crs,
                                Progress& progress);

/// The nearest corner of the triangle that holds a place. Throws: Error{OutsideHull}.
VertexId outlet_at(Point2 written, const Tin& tin, const TriangleGrid& grid, const Plane& plane);

}  // namespace thalweg
