#pragma once

/// Positions as people write them: degrees, minutes and seconds, UTM, MGRS.

#include <thalweg/geometry/point.hpp>

#include <span>
#include <string>
#include <string_view>

namespace thalweg {

/// How a position is written.
enum class PositionForm {
  Dms,  ///< longitude, latitude: 11d30'15"E, 47:15:00N, -11.5042; letters of hemispheres may exchange them
  Utm,  ///< zone with hemisphere (32N; no band letter), easting, northing, in metres
  Mgrs  ///< 32TPT7612345678, of which the middle of the square counts
};

/// Longitude and latitude in degrees on WGS 84 of a position in one or several fields of text. Blanks within
/// a field are allowed: between digits of an angle they stand for a colon. UTM in one field is parted by
/// blanks. Throws: Error{BadCoordinate} that says what is wrong with it, for one that is not understood or
/// out of range, and for an MGRS square of 100 km or more.
Point2 parse_position(std::span<const std::string_view> fields, PositionForm form);

/// The EPSG code of the UTM zone on WGS 84 that a position is in, or near a pole of the polar stereographic
/// plane (UPS). Throws: Error{BadCoordinate} for a latitude out of range.
int utm_or_ups_epsg(Point2 lonlat_deg);

}  // namespace thalweg
