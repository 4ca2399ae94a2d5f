#pragma once

/// Writing lines of constant height as a vector layer of any format that GDAL writes.

#include <thalweg/base/progress.hpp>
#include <thalweg/geometry/point.hpp>
#include <thalweg/io/pending_outputs.hpp>
#include <thalweg/io/write_tin.hpp>

#include <span>
#include <string>
#include <vector>

namespace thalweg {

struct LevelLine {
  double height = 0;
  std::vector<Point2> points;
};

struct LineLayerView {
  std::span<const LevelLine> lines;
  std::string layer;  ///< name of the layer
  std::string field;  ///< attribute with the height
  std::string crs_wkt = {};
};

/// Writes the lines, with z, in the order given. `options.format` is GDAL's short name, else the extension
/// decides; creation options are those of the driver's layers. Throws: Error{Usage} for a format that is not
/// known; Error{WriteFailed}; what `PendingOutputs::add` throws. Memory: the file once.
void write_level_lines(const std::string& path, const LineLayerView& view, const WriteOptions& options,
                       PendingOutputs& pending, Overwrite mode, Progress& progress);

}  // namespace thalweg
