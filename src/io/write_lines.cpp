// Level lines by GDAL: a file in memory, copied out with every error seen.
#include "io/gdal_formats.hpp"
#include "io/gdal_session.hpp"
#include "io/memory_folder.hpp"
#include "io/spatial_reference.hpp"

#include <thalweg/io/write_lines.hpp>

#include <cpl_conv.h>
#include <cpl_string.h>
#include <ogrsf_frmts.h>

#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace thalweg {

namespace {

constexpr std::size_t kProgressStep = 1U << 10U;

[[noreturn]] void fail(const std::string& path, const GdalSession& session) {
  session.fail_to_write(path + ": could not be written as lines", "choose another format");
}

/// Whether the layer has an attribute for the heights.
bool add_field(const std::string& path, const LineLayerView& view, OGRLayer& layer, const char* format,
               const GdalSession& session) {
  if (layer.TestCapability(OLCCreateField) == 0) {  // as in DXF, where z tells the height
    if (!view.field_wanted) return false;
    throw Error(ErrorCode::Usage, path + ": " + format + " has no attributes, so none named '" + view.field +
                                      "' (--field); z holds the heights");
  }
  const auto taken = [&](const char* name) { return name[0] != '\0' && EQUAL(view.field.c_str(), name); };
  if (view.field.empty() || taken(layer.GetFIDColumn()) || taken(layer.GetGeometryColumn())) {
    throw Error(ErrorCode::Usage, path + ": an attribute of " + format + " cannot be named '" + view.field +
                                      "'; choose another name with --field");
  }
  OGRFieldDefn field(view.field.c_str(), OFTReal);
  if (layer.CreateField(&field) != OGRERR_NONE) fail(path, session);
  OGRFeatureDefn& fields = *layer.GetLayerDefn();
  const std::string made = fields.GetFieldDefn(fields.GetFieldCount() - 1)->GetNameRef();
  if (!EQUAL(made.c_str(), view.field.c_str())) {
    throw Error(ErrorCode::Usage, path + ": an attribute of " + format + " cannot be named '" + view.field +
                                      "', but '" + made + "'; choose another name with --field");
  }
  return true;
}

void write_features(const std::string& path, const LineLayerView& view, const DriverOptions& options,
                    GDALDataset& dataset, const GdalSession& session, Progress& progress) {
  std::optional<OGRSpatialReference> reference;
  if (!view.crs_wkt.empty()) reference = parse_reference(view.crs_wkt);
  // It names CRSs by their codes.
  const bool json = std::string_view(dataset.GetDriver()->GetDescription()).starts_with("GeoJSON");
  if (reference && json) reference = horizontal_part(*reference);
  OGRLayer* layer = dataset.CreateLayer(view.layer.c_str(), reference ? &*reference : nullptr,
                                        wkbLineString25D, CPLStringList(options.layer).List());
  if (layer == nullptr) fail(path, session);
  const char* format = dataset.GetDriver()->GetDescription();
  if (layer->GetGeomType() == wkbNone) {
    throw Error(ErrorCode::Usage, path + ": " + format +
                                      " holds no lines as it is; choose another format, or for CSV --co "
                                      "GEOMETRY=AS_WKT");
  }
  const bool has_field = add_field(path, view, *layer, format, session);
  const bool in_transaction =
      dataset.TestCapability(ODsCTransactions) != 0 && dataset.StartTransaction() == OGRERR_NONE;
  OGRFeature feature(layer->GetLayerDefn());
  for (std::size_t row = 0; row < view.lines.size(); ++row) {
    if (row % kProgressStep == 0) {
      progress.advance(static_cast<double>(row) / static_cast<double>(view.lines.size()));
    }
    const LevelLine& line = view.lines[row];
    auto geometry = std::make_unique<OGRLineString>();
    geometry->setNumPoints(static_cast<int>(line.points.size()));
    for (std::size_t i = 0; i < line.points.size(); ++i) {
      geometry->setPoint(static_cast<int>(i), line.points[i].x, line.points[i].y, line.height);
    }
    feature.SetFID(OGRNullFID);
    feature.SetGeometryDirectly(geometry.release());
    if (has_field) feature.SetField(layer->GetLayerDefn()->GetFieldCount() - 1, line.height);
    if (layer->CreateFeature(&feature) != OGRERR_NONE) fail(path, session);
  }
  if (in_transaction && dataset.CommitTransaction() != OGRERR_NONE) fail(path, session);
}

}  // namespace

void write_level_lines(const std::string& path, const LineLayerView& view, const WriteOptions& options,
                       PendingOutputs& pending, Overwrite mode, Progress& progress) {
  const GdalSession session;
  const CPLConfigOptionSetter date("OGR_CURRENT_DATE", "2000-01-01T00:00:00.000Z", false);
  GDALDriver* driver = find_output_driver(path, options.format, DriverUse::Vector);
  if (driver == nullptr) {
    throw Error(ErrorCode::Usage,
                path + ": no vector format that this GDAL writes; name one with --of (ogrinfo --formats)");
  }
  const std::string_view name = driver->GetDescription();
  if (view.crs_wkt.empty() && (name == "KML" || name == "LIBKML" || name == "GPX")) {
    throw Error(ErrorCode::BadCrs, path + ": " + std::string(name) +
                                       " holds longitudes and latitudes, but the CRS of the TIN "
                                       "is unknown; give it one (build --a-crs)");
  }
  const DriverOptions creation = sort_options(*driver, options.creation_options, DriverUse::Vector);
  progress.start_phase(std::string("write ") + driver->GetDescription());
  const std::string written = pending.add(path, mode);
  const MemoryFolder folder(path);
  GDALDatasetUniquePtr dataset(
      driver->Create(folder.path().c_str(), 0, 0, 0, GDT_Unknown, CPLStringList(creation.dataset).List()));
  if (!dataset) fail(path, session);
  write_features(path, view, creation, *dataset, session, progress);
  dataset.reset();
  if (session.failed()) fail(path, session);
  folder.deliver(written, pending, mode);
  progress.advance(1);
}

}  // namespace thalweg
