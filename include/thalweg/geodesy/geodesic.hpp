#pragma once

/// Lengths and areas on the ellipsoid.

#include <thalweg/base/id.hpp>
#include <thalweg/geodesy/metric_frame.hpp>

#include <span>
#include <utility>
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

/// Length in metres of the geodesic between the ends of each edge, the same whichever end comes first. Edges
/// index `lonlat_deg` (longitude, latitude, degrees). Throws: Error{BadCoordinate} for a position of an edge
/// that is not finite or out of range. Complexity: linear in the edges.
std::vector<double> geodesic_lengths_m(std::span<const Point2> lonlat_deg,
                                       std::span<const std::pair<VertexId, VertexId>> edges,
                                       Ellipsoid ellipsoid = {});

}  // namespace thalweg
