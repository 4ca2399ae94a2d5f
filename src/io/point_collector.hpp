#pragma once

/// The way of points from a source into the survey.

#include "io/source_reader.hpp"

#include <thalweg/geometry/point.hpp>

#include <array>
#include <cstddef>

namespace thalweg {

/// Takes points in a source's coordinates, transforms them in blocks, drops those outside of the run's box,
/// appends the others to the survey, and counts. Throws (all): Error{BadCoordinate} for points that have no
/// image; Error{SizeLimit}; Error{Cancelled}.
class PointCollector {
 public:
  PointCollector(ReadContext& run, PlaneTransform& transform) : run_(run), transform_(transform) {}

  /// Pre: the values are usable.
  void add(Point2 xy, double z) {
    xy_[pending_] = xy;
    z_[pending_] = z;
    if (++pending_ == kBlock) flush();
  }
  /// Appends what is still in the block.
  void finish() { flush(); }

 private:
  static constexpr std::size_t kBlock = 4096;
  void flush();

  ReadContext& run_;
  PlaneTransform& transform_;
  std::array<Point2, kBlock> xy_{};
  std::array<double, kBlock> z_{};
  std::size_t pending_ = 0;
};

/// Asks whether so many points more are admitted, and reserves room for them. Throws: what `admit` throws.
void expect_points(ReadContext& run, double more);

/// Throws: Error{SizeLimit} if the survey would get more points than a TIN can have with `more` points.
void check_room(const SurveyPoints& points, std::size_t more);

}  // namespace thalweg
