#pragma once

/// Heights of the geoid above the ellipsoid.

#include <thalweg/geometry/point.hpp>

#include <memory>
#include <span>
#include <string>

namespace thalweg {

/// A gravity model's geoid, as GeographicLib installs it (egm84-30 to egm2008-1).
///
/// The data lie where GeographicLib looks for them: in the folder that GEOGRAPHICLIB_GEOID_PATH names, else
/// in that of GEOGRAPHICLIB_DATA, else where the package puts them. Not thread-safe.
class Geoid {
 public:
  /// Throws: Error{NotFound} for a model that is not installed, with how to install it; Error{BadFormat} for
  /// broken data.
  explicit Geoid(const std::string& model);
  ~Geoid();
  Geoid(const Geoid&) = delete;
  Geoid& operator=(const Geoid&) = delete;

  struct Range {
    double min_m = 0;
    double max_m = 0;
  };
  /// Adds `sign` times the geoid's height above the WGS 84 ellipsoid, in units of `metres_per_unit`, to the
  /// heights z, by cubic interpolation. Returns the smallest and largest height of the geoid, in metres.
  /// Pre: z is as long as lonlat_deg, positions are finite. Throws: Error{BadCoordinate} for a latitude out
  /// of range; Error{Unreadable}. Complexity: linear.
  Range add_to(std::span<double> z, std::span<const Point2> lonlat_deg, double sign,
               double metres_per_unit) const;

 private:
  struct Model;
  std::unique_ptr<const Model> model_;
};

}  // namespace thalweg
