#pragma once

/// What the library needs to know about a coordinate reference system (CRS).

#include <thalweg/geometry/point.hpp>

#include <optional>
#include <string>

namespace thalweg {

/// A CRS as plain values. Coordinates are always x = east or longitude, y = north or latitude, whatever axis
/// order the CRS itself declares.
///
/// Unit of heights: where the CRS has a vertical part (a compound or a three-dimensional CRS), the unit of
/// that part. Else it is not told, and the best guess stands here: the linear unit of a planar CRS (elevation
/// data in feet come with heights in feet), metres for a geographic one; `vertical_unit_told` is false then,
/// so that a caller can say what was assumed. A user who knows better gives a compound CRS, as in
/// "EPSG:2994+5703".
struct CrsInfo {
  std::string wkt;        ///< WKT 2 (2019) in one line; empty if the CRS is unknown
  std::string name;       ///< "WGS 84 / UTM zone 11N"
  std::string authority;  ///< "EPSG:32611" where the definition names it or matches it without doubt, else ""
  bool known = false;
  bool geographic = false;  ///< coordinates are longitude and latitude
  /// Planar: length of the horizontal unit. Geographic: 1, see `degrees_per_unit`.
  double horizontal_metres_per_unit = 1;
  double degrees_per_unit = 1;    ///< geographic: size of the angular unit
  double prime_meridian_deg = 0;  ///< geographic: longitude, east of Greenwich, of the CRS's zero meridian
  double vertical_metres_per_unit = 1;
  bool vertical_unit_told = false;
  double equatorial_radius_m = 6378137;   ///< of the ellipsoid; WGS 84 if the CRS is unknown
  double flattening = 1 / 298.257223563;  ///< 0 for a sphere
};

/// Reads a definition: "EPSG:n", "EPSG:n+m" (horizontal + vertical), an OGC URN or URL, WKT, PROJJSON, a PROJ
/// string, or the name of a file that holds WKT or a PROJ string (.prj). An empty definition is an unknown
/// CRS: planar, metres in all directions. The network is never asked.
///
/// Throws: Error{BadCrs} naming the definition, if it is not understood or a CRS without a plane
/// (earth-centred, vertical).
CrsInfo describe_crs(const std::string& definition);

/// What a metre is to a projected CRS at a place.
struct CrsScale {
  Point2 lonlat_deg;  ///< of the place, from Greenwich
  double east = 1;    ///< lengths in the plane along x, over those on the ellipsoid
  double north = 1;   ///< along y
};

/// The scale of a projected CRS at a place of its plane; none of another CRS, or where PROJ knows no way to
/// longitude and latitude.
std::optional<CrsScale> scale_at(const CrsInfo& crs, Point2 place);

/// Whether two units, in metres, are the same one: definitions tell them with ten digits and more, while the
/// two feet differ in the sixth.
bool is_same_unit(double a, double b);

/// Whether two definitions, of perhaps different dialects, mean the same CRS; false if one is not understood.
bool means_same_crs(const std::string& a, const std::string& b);

}  // namespace thalweg
