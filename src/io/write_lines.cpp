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

namespace thalweg {

namespace {

constexpr std::size_t kProgressStep = 1U << 10U;

[[noreturn]] void fail(const std::string& path, const GdalSession& session) {
  throw Error(ErrorCode::WriteFailed,
              path + ": could not be written as lines" + session.reason() + "; choose another format");
}

void write_features(const std::string& path, const LineLayerView& view, const WriteOptions& options,
                    GDALDataset& dataset, const GdalSession& session, Progress& progress) {
  std::optional<OGRSpatialReference> reference;
  if (!view.crs_wkt.empty()) reference = parse_reference(view.crs_wkt);
  CPLStringList creation;
  for (const std::string& option : options.creation_options) creation.AddString(option.c_str());
  OGRLayer* layer = dataset.CreateLayer(view.layer.c_str(), reference ? &*reference : nullptr,
                                        wkbLineString25D, creation.List());
  if (layer == nullptr) fail(path, session);
  OGRFieldDefn field(view.field.c_str(), OFTReal);
  const bool has_field = layer->TestCapability(OLCCreateField) != 0;  // not DXF: z tells the height
  if (has_field && layer->CreateField(&field) != OGRERR_NONE) fail(path, session);
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
  progress.start_phase(std::string("write ") + driver->GetDescription());
  const std::string written = pending.add(path, mode);
  const MemoryFolder folder(path);
  GDALDatasetUniquePtr dataset(driver->Create(folder.path().c_str(), 0, 0, 0, GDT_Unknown, nullptr));
  if (!dataset) fail(path, session);
  write_features(path, view, options, *dataset, session, progress);
  dataset.reset();
  if (session.failed()) fail(path, session);
  folder.deliver(written, pending, mode);
  progress.advance(1);
}

}  // namespace thalweg
