#pragma once

/// A conformal plane in metres for longitudes and latitudes, and areas on the ellipsoid.

#include <thalweg/base/progress.hpp>
#include <thalweg/geometry/point.hpp>

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace thalweg {

/// An ellipsoid of revolution; WGS 84 unless told otherwise. A flattening of 0 is a sphere.
struct Ellipsoid {
  double equatorial_radius_m = 6378137;
  double flattening = 1 / 298.257223563;
};

/// The conformal projections that a frame chooses from; Mercator is the conic one at the equator.
enum class Projection { TransverseMercator, LambertConformalConic, Mercator, PolarStereographic };

/// The metric plane of a set of geographic positions.
///
/// Positions are (longitude, latitude) in degrees; longitudes may run from -180 to 180 or from 0 to 360 (any
/// value within +-360 is understood), also across the antimeridian: the frame is centred on the smallest arc
/// that holds them all. The plane is in metres, x to the east and y to the north at the centre, its scale 1
/// at the centre (at the pole, at the equator) and not corrected elsewhere.
///
/// Choice, by the spread of scale s (largest over smallest scale within the extent):
/// 1. transverse Mercator if the arc is at most 90 degrees wide and s <= 1.01 (at the equator: 8 degrees to
///    each side);
/// 2. else polar stereographic if all latitudes are beyond 60 degrees and the arc is wider than 180;
/// 3. else the least s of transverse Mercator (arc at most 90 degrees, s <= 1.2), conic (Mercator where its
///    parallel is within 4 degrees of the equator, for there a cone is too steep for double arithmetic) and
///    polar stereographic.
/// The centre is rounded to 0.01 degrees, so that nearly equal data share their plane.
///
/// Laws: (1) `proj_string` reproduces `to_plane` with PROJ to 1e-6 m; (2) `to_geographic` inverts `to_plane`
/// to 1e-6 m; (3) the frame depends on the set of positions only, not on their order.
class MetricFrame {
 public:
  /// Throws: Error{BadCrs} for an ellipsoid that is none; Error{EmptyInput} without positions;
  /// Error{BadCoordinate} for a value that is not finite or out of range, or if no projection keeps s below
  /// 100 (both poles in one extent, say). Complexity: linear, unless the arc is 180 degrees or wider: then a
  /// sort.
  static MetricFrame for_extent(std::span<const Point2> lonlat_deg, Ellipsoid ellipsoid = {});

  /// The frame that `proj_string` describes. Throws: Error{BadCrs} for a string that is none of its.
  static MetricFrame from_proj_string(const std::string& text, Ellipsoid ellipsoid = {});

  /// Throws: Error{BadCoordinate} for a value that is not finite or out of range.
  [[nodiscard]] Point2 to_plane(Point2 lonlat_deg) const;
  /// All positions, on all threads. Throws: as for one, and Error{Cancelled}.
  [[nodiscard]] std::vector<Point2> to_plane(std::span<const Point2> lonlat_deg,
                                             const Progress& progress) const;
  /// Longitude in -180 to 180, or in 0 to 360 if the extent had longitudes beyond 180.
  [[nodiscard]] Point2 to_geographic(Point2 plane) const;
  /// The same position with its longitude within 180 degrees of the centre, so that no edge of the data jumps
  /// at the antimeridian; a longitude that is so already is returned unchanged.
  [[nodiscard]] Point2 continuous(Point2 lonlat_deg) const;

  [[nodiscard]] Projection projection() const;
  [[nodiscard]] Ellipsoid ellipsoid() const;
  /// Longitude and latitude of the plane's centre, degrees (latitude 0 for Mercator, +-90 for polar
  /// stereographic).
  [[nodiscard]] Point2 centre_deg() const;
  /// The plane as a PROJ string, "+proj=tmerc ... +units=m +no_defs +type=crs".
  [[nodiscard]] std::string proj_string() const;

 private:
  struct Plane;
  explicit MetricFrame(std::shared_ptr<const Plane> plane) : plane_(std::move(plane)) {}
  std::shared_ptr<const Plane> plane_;
};

}  // namespace thalweg
