// From the coordinates of one source to those of the survey.
//
// 1. Unless both CRSs have a vertical part, both are reduced to their horizontal parts, and heights change
//    unit only.
// 2. CRSs that differ in name or axis order only are the same: nothing is transformed, coordinates keep every
//    bit.
// 3. PROJ is first asked for a transformation that knows both datums. Where there is none (a datum is
//    unknown) the one that takes them for the same is used, and a note says so.
// PROJ chooses among transformations for each point by its position alone, so the order of points has no
// influence.
#include "io/plane_transform.hpp"

#include "io/gdal_session.hpp"
#include "io/spatial_reference.hpp"

#include <thalweg/base/error.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <string>
#include <utility>

namespace thalweg {

namespace {

bool has_vertical_part(const OGRSpatialReference& reference) {
  return reference.GetAxesCount() == 3;
}

std::string name_of(const OGRSpatialReference& reference) {
  const char* name = reference.GetName();
  return name != nullptr ? name : "unnamed";
}

std::string in_digits(double value) {
  std::ostringstream text;
  text.precision(12);
  text << value;
  return text.str();
}

}  // namespace

PlaneTransform::PlaneTransform(Frame from, Frame to, std::string origin)
    : from_(std::move(from)), to_(std::move(to)), origin_(std::move(origin)) {
  const bool is_known = !from_.reference.IsEmpty() && !to_.reference.IsEmpty();
  const bool with_heights =
      is_known && has_vertical_part(from_.reference) && has_vertical_part(to_.reference);
  if (!with_heights && !is_same_unit(from_.vertical_metres_per_unit, to_.vertical_metres_per_unit)) {
    height_factor_ = from_.vertical_metres_per_unit / to_.vertical_metres_per_unit;
  }
  note_heights();
  if (!is_known) return;
  const OGRSpatialReference source = with_heights ? from_.reference : horizontal_part(from_.reference);
  const OGRSpatialReference target = with_heights ? to_.reference : horizontal_part(to_.reference);
  if (means_same_crs(source, target)) return;

  GdalSession session;
  OGRCoordinateTransformationOptions options;
  options.SetBallparkAllowed(false);
  transformation_.reset(OGRCreateCoordinateTransformation(&source, &target, options));
  if (transformation_) return;
  session.reset();
  options.SetBallparkAllowed(true);
  transformation_.reset(OGRCreateCoordinateTransformation(&source, &target, options));
  if (!transformation_) {
    throw Error(ErrorCode::BadCrs, origin_ + ": no transformation leads from " + name_of(source) + " to " +
                                       name_of(target) + session.reason() + "; give its CRS with --s-crs");
  }
  notes_.push_back(
      origin_ + ": the datums of " + name_of(source) + " and " + name_of(target) +
      " are taken for the same, because no transformation between them is known; positions can be "
      "off by some hundred metres");
}

void PlaneTransform::note_heights() {
  if (height_factor_ == 1) return;
  notes_.push_back("heights of " + origin_ + " are brought from units of " +
                   in_digits(from_.vertical_metres_per_unit) + " m to units of " +
                   in_digits(to_.vertical_metres_per_unit) +
                   " m; if their unit is another, say so with a compound CRS (as EPSG:2994+5703)");
}

void PlaneTransform::apply(std::span<Point2> xy, std::span<double> z) {
  if (height_factor_ != 1) {
    for (double& height : z) height *= height_factor_;
  }
  if (!transformation_) return;
  constexpr std::size_t kBlock = 1024;
  for (std::size_t begin = 0; begin < xy.size(); begin += kBlock) {
    const std::size_t count = std::min(kBlock, xy.size() - begin);
    apply_block(xy.subspan(begin, count), z.empty() ? z : z.subspan(begin, count));
  }
}

void PlaneTransform::apply_block(std::span<Point2> xy, std::span<double> z) {
  std::array<double, 1024> x_block{};
  std::array<double, 1024> y_block{};
  std::array<int, 1024> success{};
  for (std::size_t i = 0; i < xy.size(); ++i) {
    x_block[i] = xy[i].x;
    y_block[i] = xy[i].y;
  }
  GdalSession session;
  transformation_->Transform(static_cast<int>(xy.size()), x_block.data(), y_block.data(),
                             z.empty() ? nullptr : z.data(), success.data());
  for (std::size_t i = 0; i < xy.size(); ++i) {
    const bool has_image = success[i] != 0 && std::isfinite(x_block[i]) && std::isfinite(y_block[i]) &&
                           (z.empty() || std::isfinite(z[i]));
    if (!has_image) {
      throw Error(ErrorCode::BadCoordinate, origin_ + ": point (" + in_digits(xy[i].x) + ", " +
                                                in_digits(xy[i].y) + ") cannot be transformed" +
                                                session.reason() + "; is its CRS the right one? (--s-crs)");
    }
    xy[i] = {x_block[i], y_block[i]};
  }
}

}  // namespace thalweg
