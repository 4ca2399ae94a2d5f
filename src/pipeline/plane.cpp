// The metric plane: a conformal frame about the data where coordinates are angles, else the identity.
#include "pipeline/plane.hpp"

#include <thalweg/geodesy/position_text.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace thalweg {

namespace {

Point2 from_greenwich(const CrsInfo& crs, Point2 written) {
  return {written.x * crs.degrees_per_unit + crs.prime_meridian_deg, written.y * crs.degrees_per_unit};
}

std::vector<Point2> all_from_greenwich(const CrsInfo& crs, std::span<const Point2> written) {
  std::vector<Point2> lonlat(written.begin(), written.end());
  if (crs.degrees_per_unit == 1 && crs.prime_meridian_deg == 0) return lonlat;
  for (Point2& p : lonlat) p = from_greenwich(crs, p);
  return lonlat;
}

}  // namespace

Plane::Plane(const CrsInfo& crs, std::span<const Point2> extent) : crs_(crs) {
  if (!crs.geographic) return;
  frame_ = MetricFrame::for_extent(all_from_greenwich(crs, extent), ellipsoid());
}

Plane::Plane(const CrsInfo& crs, const std::string& proj_string) : crs_(crs) {
  if (!proj_string.empty()) frame_ = MetricFrame::from_proj_string(proj_string, ellipsoid());
}

Point2 Plane::to_plane(Point2 written) const {
  return frame_ ? frame_->to_plane(from_greenwich(crs_, written)) : written;
}

std::vector<Point2> Plane::to_plane(std::span<const Point2> written, const Progress& progress) const {
  if (!frame_) return {written.begin(), written.end()};
  return frame_->to_plane(all_from_greenwich(crs_, written), progress);
}

Point2 Plane::to_written(Point2 plane) const {
  if (!frame_) return plane;
  const Point2 lonlat = frame_->to_geographic(plane);
  if (crs_.degrees_per_unit == 1 && crs_.prime_meridian_deg == 0) return lonlat;
  return {(lonlat.x - crs_.prime_meridian_deg) / crs_.degrees_per_unit, lonlat.y / crs_.degrees_per_unit};
}

Point2 Plane::without_jump(Point2 written) const {
  if (!frame_) return written;
  const double x = from_greenwich(crs_, written).x;
  const double centre = frame_->centre_deg().x;
  if (std::abs(x - centre) <= 180) return written;
  return {written.x - x_period() * std::round((x - centre) / 360), written.y};
}

Point2 Plane::to_lonlat(Point2 written) const {
  return frame_->continuous(from_greenwich(crs_, written));
}

std::vector<Point2> Plane::to_lonlat(std::span<const Point2> written) const {
  std::vector<Point2> lonlat;
  lonlat.reserve(written.size());
  std::transform(written.begin(), written.end(), std::back_inserter(lonlat),
                 [&](Point2 p) { return to_lonlat(p); });
  return lonlat;
}

void note_crs(const CrsInfo& crs, std::span<const Point2> written, std::vector<std::string>& notes) {
  if (!crs.known) {
    notes.emplace_back("the CRS is unknown: coordinates and heights are taken as metres in a plane");
  }
  constexpr double kMuch = 0.02;
  if (written.empty()) return;
  const Box2 box = bounding_box(written);
  const auto scale = scale_at(crs, {(box.x_min + box.x_max) / 2, (box.y_min + box.y_max) / 2});
  if (!scale || std::max(std::abs(scale->east - 1), std::abs(scale->north - 1)) < kMuch) return;
  const bool same = std::abs(scale->east - scale->north) < kMuch;
  notes.push_back(
      fmt::format("in {} lengths are {} times those on the ground here, heights are not: slopes, angles and "
                  "areas are not those of the ground. A build with --t-crs {} has them right",
                  crs.name,
                  same ? fmt::format("{:.2f}", (scale->east + scale->north) / 2)
                       : fmt::format("{:.2f} (along x) and {:.2f} (along y)", scale->east, scale->north),
                  "EPSG:" + std::to_string(utm_or_ups_epsg(scale->lonlat_deg))));
}

}  // namespace thalweg
