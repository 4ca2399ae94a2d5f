// Rasters by GDAL: the grid becomes a dataset in memory, which the driver copies to a file in memory, and
// that is copied out with every error seen. So formats that can only copy (COG, PNG, AAIGrid) work like
// others.
#include "io/gdal_formats.hpp"
#include "io/gdal_session.hpp"
#include "io/height_unit.hpp"
#include "io/memory_folder.hpp"
#include "io/spatial_reference.hpp"

#include <thalweg/io/write_raster.hpp>

#include <cpl_conv.h>
#include <cpl_string.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <memory>
#include <utility>
#include <vector>

namespace thalweg {

namespace {

GDALDataType gdal_type(RasterType type) {
  switch (type) {
    case RasterType::Byte:
      return GDT_Byte;
    case RasterType::Float32:
      return GDT_Float32;
    case RasterType::Float64:
      return GDT_Float64;
  }
  return GDT_Float32;
}

[[noreturn]] void fail(const std::string& path, const GdalSession& session) {
  session.fail_to_write(path + ": could not be written as a raster",
                        "choose another format or other creation options");
}

/// Marks the cells without data: no other cell has this value.
double choose_nodata(const RasterView& view) {
  if (view.type == RasterType::Byte) return 0;
  const auto is_value = [&](double nodata) {
    const bool single = view.type == RasterType::Float32;
    return std::ranges::any_of(view.values, [&](double value) {
      return (single ? static_cast<double>(static_cast<float>(value)) : value) == nodata;
    });
  };
  double nodata = -9999;
  while (is_value(nodata)) nodata = 10 * nodata - 9;
  return nodata;
}

GDALDatasetUniquePtr make_dataset(const std::string& path, const RasterView& view, double nodata,
                                  const GdalSession& session) {
  GDALDriver* memory = GetGDALDriverManager()->GetDriverByName("MEM");
  const int columns = static_cast<int>(view.grid.columns), rows = static_cast<int>(view.grid.rows);
  GDALDatasetUniquePtr dataset(
      memory == nullptr ? nullptr : memory->Create("", columns, rows, 1, gdal_type(view.type), nullptr));
  if (!dataset) fail(path, session);
  std::array<double, 6> transform = {view.grid.x0, view.grid.cell, 0, view.grid.y0, 0, -view.grid.cell};
  dataset->SetGeoTransform(transform.data());
  if (!view.crs_wkt.empty()) {
    const OGRSpatialReference reference = parse_reference(view.crs_wkt);
    dataset->SetSpatialRef(&reference);
  }
  GDALRasterBand& band = *dataset->GetRasterBand(1);
  band.SetNoDataValue(nodata);
  band.SetDescription(view.description.c_str());
  for (const auto& [metres, name] :
       {std::pair(1.0, "m"), std::pair(0.3048, "ft"), std::pair(1200.0 / 3937, "US survey foot")}) {
    if (is_same_unit(view.metres_per_unit, metres)) band.SetUnitType(name);
  }
  std::vector<double> line(view.grid.columns);
  for (int row = 0; row < rows; ++row) {
    const auto from = view.values.begin() + static_cast<std::ptrdiff_t>(view.grid.columns) * row;
    std::transform(from, from + columns, line.begin(), [&](double v) { return std::isnan(v) ? nodata : v; });
    if (band.RasterIO(GF_Write, 0, row, columns, 1, line.data(), columns, 1, GDT_Float64, 0, 0, nullptr) !=
        CE_None)
      fail(path, session);
  }
  return dataset;
}

/// What the driver made, opened again: some write what nobody can read, or colours instead of heights.
void check_readable(GDALDataset* dataset, const std::string& path, const RasterView& view, double nodata,
                    const GDALDriver& driver) {
  const auto refuse = [&](const std::string& what) {
    return Error(ErrorCode::Unsupported, path + ": the format " + driver.GetDescription() + " " + what +
                                             "; choose another one, such as GTiff (.tif)");
  };
  if (dataset == nullptr) throw refuse("makes no file that can be opened again");
  GDALRasterBand* const band = dataset->GetRasterCount() == 1 ? dataset->GetRasterBand(1) : nullptr;
  const bool keeps_values = band != nullptr && band->GetColorTable() == nullptr &&
                            (view.type == RasterType::Byte || band->GetRasterDataType() != GDT_Byte);
  if (!keeps_values) throw refuse("turns heights into colours");
  int has_nodata = FALSE;
  const double told = band->GetNoDataValue(&has_nodata);
  const bool any_without =
      std::any_of(view.values.begin(), view.values.end(), [](double v) { return std::isnan(v); });
  if (any_without && view.type != RasterType::Byte && (has_nodata == FALSE || told != nodata)) {
    throw refuse("cannot tell the cells without data");
  }
}

/// Whether what the driver made says where the cells lie, in which CRS, and the unit of heights if that is
/// not what the CRS lets one think.
bool tells_place(GDALDataset* dataset, const std::string& path, const RasterView& view) {
  std::array<double, 6> transform{};
  if (dataset == nullptr || dataset->GetGeoTransform(transform.data()) != CE_None) return false;
  const OGRSpatialReference* const reference = dataset->GetSpatialRef();
  if (view.crs_wkt.empty()) return true;
  if (reference == nullptr || reference->IsEmpty()) return false;
  if (view.metres_per_unit == 0) return true;
  const double unit = metres_of_unit(dataset->GetRasterBand(1)->GetUnitType())
                          .value_or(describe_reference(*reference, path).vertical_metres_per_unit);
  return is_same_unit(unit, view.metres_per_unit);
}

/// Progress for GDAL, through which no exception may pass: what a report throws waits until it has returned.
struct GdalProgress {
  Progress& progress;
  std::exception_ptr thrown;

  static int report(double fraction, const char*, void* self) {
    auto& ours = *static_cast<GdalProgress*>(self);
    if (ours.thrown) return FALSE;
    try {
      ours.progress.advance(fraction);
    } catch (...) {
      ours.thrown = std::current_exception();
    }
    return ours.thrown ? FALSE : TRUE;
  }
};

}  // namespace

bool is_raster_format(const std::string& path, const std::string& format) {
  const GdalSession session;
  return find_output_driver(path, format, DriverUse::Raster) != nullptr;
}

void write_raster(const std::string& path, const RasterView& view, const WriteOptions& options,
                  PendingOutputs& pending, Overwrite mode, Progress& progress) {
  const GdalSession session;
  GDALDriver* driver = find_output_driver(path, options.format, DriverUse::Raster);
  if (driver == nullptr) {
    throw Error(ErrorCode::Usage,
                path + ": no raster format that this GDAL writes; name one with --of (gdalinfo --formats)");
  }
  if (!holds_type(*driver, gdal_type(view.type))) {
    throw Error(ErrorCode::Usage, path + ": " + driver->GetDescription() + " holds no values of type " +
                                      GDALGetDataTypeName(gdal_type(view.type)) +
                                      ", and would change them; choose another format or --ot");
  }
  const DriverOptions creation = sort_options(*driver, options.creation_options, DriverUse::Raster);
  progress.start_phase(std::string("write ") + driver->GetDescription());
  const std::string written = pending.add(path, mode);
  const double nodata = choose_nodata(view);
  const GDALDatasetUniquePtr dataset = make_dataset(path, view, nodata, session);
  const auto make = [&](bool sidecar) {
    const CPLConfigOptionSetter choice("GDAL_PAM_ENABLED", sidecar ? "YES" : "NO", false);
    auto folder = std::make_unique<MemoryFolder>(path);
    GdalProgress reports{progress, {}};
    GDALDatasetUniquePtr copy(driver->CreateCopy(folder->path().c_str(), dataset.get(), FALSE,
                                                 creation.dataset.List(), GdalProgress::report, &reports));
    if (reports.thrown) std::rethrow_exception(reports.thrown);
    if (!copy) fail(path, session);
    copy.reset();
    if (session.failed()) fail(path, session);
    const GDALDatasetUniquePtr again(GDALDataset::Open(folder->path().c_str(), GDAL_OF_RASTER));
    if (!sidecar && !tells_place(again.get(), path, view)) return std::unique_ptr<MemoryFolder>();
    check_readable(again.get(), path, view, nodata, *driver);
    return folder;
  };
  std::unique_ptr<MemoryFolder> folder = make(false);
  if (!folder) folder = make(true);  // GDAL's own sidecar, .aux.xml, tells what the format cannot
  folder->deliver(written, pending, mode);
  progress.advance(1);
}

}  // namespace thalweg
