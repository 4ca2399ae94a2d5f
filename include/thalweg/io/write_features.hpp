#pragma once

/// Writing layers of plain features.

#include <thalweg/base/progress.hpp>
#include <thalweg/geometry/point.hpp>
#include <thalweg/io/pending_outputs.hpp>

#include <cstdint>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace thalweg {

/// A value of an attribute; std::monostate is null.
using FieldValue = std::variant<std::monostate, std::int64_t, double, std::string>;

enum class FieldType : std::uint8_t { Integer, Real, Text };
enum class FeatureGeometry : std::uint8_t { Point, Line, Polygon };

/// A line or ring; `z` is empty or as long as `xy`. Rings repeat no point.
struct FeatureLine {
  std::vector<Point2> xy;
  std::vector<double> z;
};

/// Point: one line of one point. Line: one line. Polygon: parts, each of an outer ring and its holes.
struct Feature {
  std::vector<std::vector<FeatureLine>> parts;
  std::vector<FieldValue> values;  ///< as the layer's fields
};

struct FeatureLayer {
  std::string name;
  FeatureGeometry geometry = FeatureGeometry::Point;
  bool has_z = false;
  struct Field {
    std::string name;
    FieldType type = FieldType::Real;
  };
  std::vector<Field> fields;
  std::vector<Feature> features;
};

/// Throws Error{Usage} if `path` does not name a GeoPackage (.gpkg), Error{Unsupported} if it is a stream.
void check_features_path(const std::string& path);

/// Writes the layers to a GeoPackage; polygons as multipolygons. `crs`: a definition, or empty. Equal input
/// gives equal bytes. Throws: as check_features_path; what `PendingOutputs::add` throws; Error{WriteFailed};
/// Error{Cancelled}.
void write_features(const std::string& path, std::span<const FeatureLayer> layers, const std::string& crs,
                    PendingOutputs& pending, Overwrite mode, Progress& progress);

}  // namespace thalweg
