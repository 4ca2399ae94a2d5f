#pragma once

/// From a TIN file to another mesh, to vector layers, to a raster, to contours.

#include <thalweg/base/progress.hpp>
#include <thalweg/geometry/point.hpp>
#include <thalweg/io/source.hpp>
#include <thalweg/io/write_raster.hpp>
#include <thalweg/terrain/sample_surface.hpp>

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace thalweg {

/// Coordinates and lengths are in units of the TIN's coordinates (degrees for a geographic CRS), heights in
/// its unit of heights.
struct RasterConfig {
  double resolution = 0;  ///< side of a cell
  /// Of the cells' sides. None: cell centres start at the lowest x and the highest y of the TIN's vertices,
  /// so that a DEM whose cells were the vertices comes back cell by cell.
  std::optional<Box2> extent;
  SurfaceValue value = SurfaceValue::Elevation;
  RasterType type = RasterType::Float32;  ///< hillshade is always bytes
};

struct ContourConfig {
  double interval = 0;
  double base = 0;
  std::optional<std::string> field;  ///< none: "elev", where the format has attributes
};

struct ProfileConfig {
  SourceSpec lines;
};

struct ConvertResult;

struct ConvertConfig {
  std::string input;
  std::string output;
  std::string format;                         ///< empty: by the output's extension
  std::vector<std::string> creation_options;  ///< K=V
  bool overwrite = false;
  std::optional<RasterConfig> raster;
  std::optional<ContourConfig> contours;
  std::optional<ProfileConfig> profile;
  /// Told the result when the output is whole, before it gets its name: what it throws leaves none.
  std::function<void(const ConvertResult&)> announce;
};

struct ConvertResult {
  enum class Kind { Tin, Raster, Contours, Profile } kind = Kind::Tin;
  std::size_t vertices = 0;
  std::size_t triangles = 0;
  std::size_t columns = 0, rows = 0, cells_without_data = 0;  ///< of a raster
  std::size_t lines = 0;  ///< contour lines, or lines of which there are profiles
  std::size_t profile_rows = 0;
  std::vector<std::string> notes;
};

/// Converts a TIN file; what to is decided by `profile`, `contours`, then by the format. A profile is a CSV
/// table `line,part,distance,x,y,z`: a row for each vertex of a line and each edge that it crosses; lines
/// count from 0, parts (of lines that leave the surface) likewise, distances are metres along the line. A
/// mesh keeps vertices, ids, triangles, constraint edges, orders and CRS, as far as the format can hold them.
/// Throws: Error; no output is left then.
ConvertResult convert_tin(const ConvertConfig& config, Progress& progress);

std::string to_json(const ConvertResult& result);
std::string to_text(const ConvertResult& result);

}  // namespace thalweg
