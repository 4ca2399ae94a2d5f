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
  std::string layer;          ///< name of the layer
  std::string field;          ///< attribute with the height
  bool field_wanted = false;  ///< a format without attributes is refused
  std::string crs_wkt = {};
};

/// Writes the lines, with z, in the order given. `options.format` is GDAL's short name, else the extension
/// decides; creation options are those of the driver and of its layers. Throws: Error{Usage} for a format or
/// option that is not known, a format without lines, a name of the attribute that the format would change;
/// Error{WriteFailed}; what `PendingOutputs::add` throws. Memory: the file once.
void write_level_lines(const std::string& path, const LineLayerView& view, const WriteOptions& options,
                       PendingOutputs& pending, Overwrite mode, Progress& progress);

}  // namespace thalweg
