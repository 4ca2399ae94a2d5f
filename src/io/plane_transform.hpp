#pragma once

/// From the coordinates of one source to those of the survey.

#include <thalweg/geometry/point.hpp>

#include <ogr_spatialref.h>

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace thalweg {

/// A CRS with the unit in which heights are given with it. An empty reference is the unknown CRS.
struct Frame {
  OGRSpatialReference reference;
  double vertical_metres_per_unit = 1;
  bool vertical_unit_told = false;
};

/// Coordinates, then heights: where both CRSs have a vertical part, PROJ transforms the heights too; else
/// they are brought from one unit to the other, and vertical parts are left aside. An unknown CRS is taken to
/// be the other one. Not thread-safe.
class PlaneTransform {
 public:
  /// Throws: Error{BadCrs} naming `origin`, if no way leads from one to the other.
  PlaneTransform(Frame from, Frame to, std::string origin);

  /// True if coordinates and heights stay as they are, to the last bit.
  [[nodiscard]] bool identity() const { return !transformation_ && height_factor_ == 1; }
  /// True if positions change.
  [[nodiscard]] bool moves() const { return transformation_ != nullptr; }
  /// The way back.
  [[nodiscard]] std::unique_ptr<PlaneTransform> inverse() const {
    return std::make_unique<PlaneTransform>(to_, from_, origin_);
  }
  /// What a user should know about the way taken; empty if nothing.
  [[nodiscard]] const std::vector<std::string>& notes() const { return notes_; }
  /// Transforms in place; `z` is empty or as long as `xy`.
  /// Throws: Error{BadCoordinate} naming a point that has no image.
  void apply(std::span<Point2> xy, std::span<double> z);

 private:
  void note_heights();
  void apply_block(std::span<Point2> xy, std::span<double> z);

  Frame from_;
  Frame to_;
  std::string origin_;
  std::unique_ptr<OGRCoordinateTransformation> transformation_;  // none: coordinates stay
  double height_factor_ = 1;
  std::vector<std::string> notes_;
};

}  // namespace thalweg
