#pragma once

/// From the coordinates of the sources to the metric plane of triangulation and back.

#include <thalweg/base/progress.hpp>
#include <thalweg/geodesy/metric_frame.hpp>
#include <thalweg/io/crs.hpp>
#include <thalweg/mesh/survey.hpp>
#include <thalweg/terrain/statistics.hpp>

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace thalweg {

/// The plane in which everything is decided: a geographic CRS gets a conformal metric one, any other CRS is
/// its own plane. Units: metres per unit as told by the CRS.
class Plane {
 public:
  /// Pre: `extent` holds all coordinates of the run. Throws: Error{BadCoordinate} for positions that are no
  /// longitude and latitude.
  Plane(const CrsInfo& crs, std::span<const Point2> extent);

  /// The plane that a report names; an empty string is the CRS's own. Throws: Error{BadCrs}.
  Plane(const CrsInfo& crs, const std::string& proj_string);

  [[nodiscard]] bool projected() const { return frame_.has_value(); }
  [[nodiscard]] double metres_per_unit() const { return projected() ? 1 : crs_.horizontal_metres_per_unit; }
  [[nodiscard]] double vertical_metres_per_unit() const { return crs_.vertical_metres_per_unit; }
  [[nodiscard]] MetricScale scale() const { return {metres_per_unit(), vertical_metres_per_unit()}; }
  /// The plane as a PROJ string; empty if it is the CRS's own.
  [[nodiscard]] std::string proj_string() const { return frame_ ? frame_->proj_string() : std::string(); }
  [[nodiscard]] Ellipsoid ellipsoid() const { return {crs_.equatorial_radius_m, crs_.flattening}; }
  /// True if the plane's straight lines may pass beyond a pole, which those of Mercator's never do.
  [[nodiscard]] bool about_pole() const { return frame_ && frame_->projection() != Projection::Mercator; }
  /// Size of a full turn in written coordinates; 0 for a planar CRS.
  [[nodiscard]] double x_period() const { return projected() ? 360 / crs_.degrees_per_unit : 0; }

  [[nodiscard]] Point2 to_plane(Point2 written) const;
  /// All positions, on all threads.
  [[nodiscard]] std::vector<Point2> to_plane(std::span<const Point2> written, const Progress& progress) const;
  [[nodiscard]] Point2 to_written(Point2 plane) const;
  /// Written coordinates whose x is within half a turn of the data's centre, so that lines do not jump at the
  /// antimeridian. Most are so already, and stay as they are.
  [[nodiscard]] Point2 without_jump(Point2 written) const;
  /// Longitude and latitude in degrees from Greenwich, without a jump at the antimeridian. Pre: projected().
  [[nodiscard]] Point2 to_lonlat(Point2 written) const;
  [[nodiscard]] std::vector<Point2> to_lonlat(std::span<const Point2> written) const;

 private:
  CrsInfo crs_;
  std::optional<MetricFrame> frame_;
};

/// Notes that the CRS is unknown, or its lengths far from those on the ground, if so.
void note_crs(const CrsInfo& crs, std::span<const Point2> written, std::vector<std::string>& notes);

}  // namespace thalweg
