// Layers of plain features in a GeoPackage, by GDAL; as write_layers.cpp does it: one transaction, no
// journal, a fixed date of change, and what GDAL said while closing decides whether the file is whole.
#include "base/lower_case.hpp"
#include "io/gdal_session.hpp"
#include "io/spatial_reference.hpp"

#include <thalweg/io/write_features.hpp>

#include <cpl_conv.h>
#include <gdal_priv.h>
#include <ogrsf_frmts.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

namespace thalweg {

namespace {

OGRFieldType ogr_type(FieldType type) {
  return type == FieldType::Integer ? OFTInteger64 : type == FieldType::Real ? OFTReal : OFTString;
}

OGRwkbGeometryType ogr_type(const FeatureLayer& layer) {
  const OGRwkbGeometryType flat = layer.geometry == FeatureGeometry::Point  ? wkbPoint
                                  : layer.geometry == FeatureGeometry::Line ? wkbLineString
                                                                            : wkbMultiPolygon;
  return layer.has_z ? OGR_GT_SetZ(flat) : flat;
}

void fill(OGRSimpleCurve& curve, const FeatureLine& line, bool closed) {
  const std::size_t count = line.xy.size() + (closed ? 1 : 0);
  curve.setNumPoints(static_cast<int>(count));
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t at = i % line.xy.size();
    if (line.z.empty()) {
      curve.setPoint(static_cast<int>(i), line.xy[at].x, line.xy[at].y);
    } else {
      curve.setPoint(static_cast<int>(i), line.xy[at].x, line.xy[at].y, line.z[at]);
    }
  }
}

std::unique_ptr<OGRGeometry> geometry_of(const FeatureLayer& layer, const Feature& feature) {
  if (layer.geometry == FeatureGeometry::Polygon) {
    auto all = std::make_unique<OGRMultiPolygon>();
    for (const std::vector<FeatureLine>& part : feature.parts) {
      auto polygon = std::make_unique<OGRPolygon>();
      for (const FeatureLine& ring : part) {
        auto closed = std::make_unique<OGRLinearRing>();
        fill(*closed, ring, true);
        polygon->addRingDirectly(closed.release());
      }
      all->addGeometryDirectly(polygon.release());
    }
    return all;
  }
  const FeatureLine& line = feature.parts.at(0).at(0);
  if (layer.geometry == FeatureGeometry::Line) {
    auto curve = std::make_unique<OGRLineString>();
    fill(*curve, line, false);
    return curve;
  }
  const Point2 p = line.xy.at(0);
  if (line.z.empty()) return std::make_unique<OGRPoint>(p.x, p.y);
  return std::make_unique<OGRPoint>(p.x, p.y, line.z.at(0));
}

class FeatureWriter {
 public:
  FeatureWriter(const std::string& path, std::string target, const std::string& crs, Progress& progress)
      : target_(std::move(target)),
        progress_(progress),
        journal_("OGR_SQLITE_JOURNAL", "OFF", false),
        synchronous_("OGR_SQLITE_SYNCHRONOUS", "OFF", false),
        date_("OGR_CURRENT_DATE", "2000-01-01T00:00:00.000Z", false) {
    if (!crs.empty()) reference_ = parse_reference(crs);
    GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GPKG");
    if (driver == nullptr) {
      throw Error(ErrorCode::Unsupported, target_ + ": this GDAL has no driver GPKG; install one that has");
    }
    dataset_.reset(driver->Create(path.c_str(), 0, 0, 0, GDT_Unknown, nullptr));
    if (!dataset_ || dataset_->StartTransaction() != OGRERR_NONE) fail();
    session_.reset();
  }

  void write(const FeatureLayer& layer) {
    progress_.start_phase("write layer " + layer.name);
    OGRLayer* const out = dataset_->CreateLayer(layer.name.c_str(), reference_ ? &*reference_ : nullptr,
                                                ogr_type(layer), nullptr);
    if (out == nullptr) fail();
    for (const FeatureLayer::Field& field : layer.fields) {
      OGRFieldDefn definition(field.name.c_str(), ogr_type(field.type));
      if (out->CreateField(&definition) != OGRERR_NONE) fail();
    }
    OGRFeature row(out->GetLayerDefn());
    for (std::size_t i = 0; i < layer.features.size(); ++i) {
      if (i % 1024 == 0)
        progress_.advance(static_cast<double>(i) / static_cast<double>(layer.features.size()));
      const Feature& feature = layer.features[i];
      row.SetFID(OGRNullFID);
      for (std::size_t f = 0; f < feature.values.size(); ++f) {
        set(row, static_cast<int>(f), feature.values[f]);
      }
      if (row.SetGeometryDirectly(geometry_of(layer, feature).release()) != OGRERR_NONE) fail();
      if (out->CreateFeature(&row) != OGRERR_NONE) fail();
    }
    progress_.advance(1);
  }

  void close() {
    if (dataset_->CommitTransaction() != OGRERR_NONE) fail();
    dataset_.reset();
    if (session_.failed()) fail();
  }

 private:
  static void set(OGRFeature& row, int field, const FieldValue& value) {
    if (const auto* whole = std::get_if<std::int64_t>(&value)) {
      row.SetField(field, static_cast<GIntBig>(*whole));
    } else if (const auto* real = std::get_if<double>(&value)) {
      row.SetField(field, *real);
    } else if (const auto* text = std::get_if<std::string>(&value)) {
      row.SetField(field, text->c_str());
    } else {
      row.SetFieldNull(field);
    }
  }

  [[noreturn]] void fail() {
    session_.fail_to_write(target_ + ": could not be written whole",
                           "free some space or choose another place; no partial file is left");
  }

  std::string target_;
  Progress& progress_;
  GdalSession session_;
  CPLConfigOptionSetter journal_, synchronous_, date_;
  std::optional<OGRSpatialReference> reference_;
  GDALDatasetUniquePtr dataset_;
};

}  // namespace

void check_features_path(const std::string& path) {
  if (extension_of(path) != ".gpkg") {
    throw Error(ErrorCode::Usage,
                path + ": several layers are written, which takes a GeoPackage: name it .gpkg");
  }
  if (!is_stream(path)) return;
  throw Error(ErrorCode::Unsupported,
              path + ": is a pipe or a device, and a GeoPackage can be written to a file only");
}

void write_features(const std::string& path, std::span<const FeatureLayer> layers, const std::string& crs,
                    PendingOutputs& pending, Overwrite mode, Progress& progress) {
  check_features_path(path);
  FeatureWriter writer(pending.add(path, mode), path, crs, progress);
  for (const FeatureLayer& layer : layers) writer.write(layer);
  writer.close();
}

}  // namespace thalweg
