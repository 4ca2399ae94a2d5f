#pragma once

/// Lines that are straight in their source's coordinates, made to follow them in another plane.

#include <thalweg/mesh/survey.hpp>

#include <cstddef>
#include <functional>

namespace thalweg {

struct DensifyOptions {
  /// A piece that bends by more gets intermediate vertices; in the unit of the plane (metres).
  double limit = 0.1;
  /// Period of x in the source's coordinates: 360 for longitudes in degrees, 0 for none. A piece takes the
  /// short way.
  double x_period = 0;
};

/// Adds vertices to the lines of a survey until no piece bends by more than the limit between the source's
/// coordinates and the plane; returns how many. New vertices are evenly spaced on the straight piece in the
/// source's coordinates, z is linear (and exactly the common height where both ends have one; never outside
/// of the ends' range); a piece drawn twice, in either direction, gets the same vertices. `to_plane` maps
/// source coordinates to the plane; it is smooth along each piece. Throws: what `to_plane` throws;
/// Error{BadCoordinate} if a piece would need more than 100 000 vertices.
std::size_t densify_lines(Survey& survey, const std::function<Point2(Point2)>& to_plane,
                          DensifyOptions options = {});

}  // namespace thalweg
