#pragma once

/// Writing grids as rasters of any format that GDAL writes.

#include <thalweg/base/progress.hpp>
#include <thalweg/geometry/point.hpp>
#include <thalweg/io/pending_outputs.hpp>
#include <thalweg/io/write_tin.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace thalweg {

/// Cells of a raster, north up: cell (column, row) has the centre x0 + (column + 0.5) cell, y0 - (row + 0.5)
/// cell.
struct RasterGrid {
  double x0 = 0;    ///< of the west side
  double y0 = 0;    ///< of the north side
  double cell = 0;  ///< side of a cell, in units of the coordinates
  std::size_t columns = 0;
  std::size_t rows = 0;

  [[nodiscard]] Point2 centre(std::size_t column, std::size_t row) const {
    return {x0 + (static_cast<double>(column) + 0.5) * cell, y0 - (static_cast<double>(row) + 0.5) * cell};
  }
};

enum class RasterType : std::uint8_t { Byte, Float32, Float64 };

/// A raster of one band. NaN is no data: written as 0 in bytes, else as -9999, or, if that is a value, -99999
/// and so on.
struct RasterView {
  RasterGrid grid;
  std::span<const double> values;  ///< row by row from the north
  RasterType type = RasterType::Float32;
  std::string crs_wkt = {};
  std::string description = {};  ///< name of the band
  double metres_per_unit = 0;    ///< of values that are lengths; 0: they are none
};

/// True if `format` (GDAL's short name), or the path's extension where it is empty, is a raster format that
/// GDAL writes.
bool is_raster_format(const std::string& path, const std::string& format);

/// Writes the raster, and what files beside it the format needs. Creation options are those of GDAL's driver.
/// Throws: Error{Usage} for a format that is not known; Error{WriteFailed}; what `PendingOutputs::add`
/// throws. Memory: the raster and its file, once each.
void write_raster(const std::string& path, const RasterView& view, const WriteOptions& options,
                  PendingOutputs& pending, Overwrite mode, Progress& progress);

}  // namespace thalweg
