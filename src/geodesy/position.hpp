#pragma once

/// The one check of geographic positions.

#include <thalweg/geometry/point.hpp>

#include <cstddef>

namespace thalweg {

/// Throws: Error{BadCoordinate} unless both values are finite, the latitude is within +-90 and the longitude
/// within +-360 degrees. `index` is where the position stands in the caller's array, for the message.
void check_position(Point2 lonlat_deg, std::size_t index);

}  // namespace thalweg
