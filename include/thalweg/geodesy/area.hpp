#pragma once

/// Area on the ellipsoid.

#include <thalweg/base/id.hpp>
#include <thalweg/geodesy/metric_frame.hpp>

#include <span>
#include <vector>

namespace thalweg {

/// Area in square metres of what the loops enclose, with geodesics for their edges: counter-clockwise loops
/// count positive, clockwise ones (holes) negative. An edge that is straight in another sense encloses a
/// little more or less: 13 m2 for an edge of 1 km along the parallel of 45 degrees, growing with the length's
/// cube. Loops index `lonlat_deg` (longitude, latitude, degrees); the edge from last to first is implied.
/// Pre: no loop encloses a pole and more than half of the ellipsoid.
/// Throws: Error{BadCoordinate} for a position of a loop that is not finite or out of range.
/// Complexity: linear in the loops.
double geodesic_area_m2(std::span<const Point2> lonlat_deg, std::span<const std::vector<VertexId>> rim_loops,
                        Ellipsoid ellipsoid = {});

}  // namespace thalweg
