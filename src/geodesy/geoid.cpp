// Geoid heights by GeographicLib::Geoid. The part of the model's grid that a batch covers is read once into
// memory: heights of single positions would seek in the file.
#include "position.hpp"

#include <thalweg/base/error.hpp>
#include <thalweg/geodesy/geoid.hpp>

#include <GeographicLib/Geoid.hpp>

#include <algorithm>
#include <cmath>
#include <exception>
#include <filesystem>
#include <limits>

namespace thalweg {

struct Geoid::Model {
  explicit Model(const std::string& name) : geoid(name) {}
  GeographicLib::Geoid geoid;
};

namespace {

std::string file_of(const std::string& model) {
  return GeographicLib::Geoid::DefaultGeoidPath() + "/" + model + ".pgm";
}

}  // namespace

Geoid::Geoid(const std::string& model) {
  const std::string file = file_of(model);
  std::error_code ignored;
  if (model.empty() || !std::filesystem::is_regular_file(file, ignored)) {
    throw Error(ErrorCode::NotFound,
                "the geoid model '" + model + "' is not installed (" + file +
                    "); install it with geographiclib-get-geoids " + model +
                    " (Debian's geographiclib-tools), or name its folder in GEOGRAPHICLIB_GEOID_PATH");
  }
  try {
    model_ = std::make_unique<Model>(model);
  } catch (const std::exception& error) {
    throw Error(ErrorCode::BadFormat, file + ": " + error.what() + "; install the model again");
  }
}

Geoid::~Geoid() = default;

Geoid::Range Geoid::add_to(std::span<double> z, std::span<const Point2> lonlat_deg, double sign,
                           double metres_per_unit) const {
  Range range{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  Box2 box;
  for (std::size_t i = 0; i < lonlat_deg.size(); ++i) {
    check_position(lonlat_deg[i], i);
    box.add({std::remainder(lonlat_deg[i].x, 360.0), lonlat_deg[i].y});
  }
  if (lonlat_deg.empty()) return {};
  try {
    model_->geoid.CacheArea(box.y_min, box.x_min, box.y_max, box.x_max);
    for (std::size_t i = 0; i < lonlat_deg.size(); ++i) {
      const double height = model_->geoid(lonlat_deg[i].y, lonlat_deg[i].x);
      range = {std::min(range.min_m, height), std::max(range.max_m, height)};
      z[i] += sign * height / metres_per_unit;
    }
  } catch (const std::exception& error) {
    throw Error(ErrorCode::Unreadable, std::string("the geoid's heights cannot be read: ") + error.what() +
                                           "; install the model again");
  }
  return range;
}

}  // namespace thalweg
