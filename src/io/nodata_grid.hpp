#pragma once

/// Regions without data of one raster.

#include "io/plane_transform.hpp"

#include <thalweg/io/nodata_region.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

namespace thalweg {

/// Where the cells of a raster, or of a window of it, lie.
struct CellFrame {
  std::array<double, 6> geotransform{};  ///< of the whole raster, as GDAL defines it
  std::size_t first_column = 0;          ///< of the window
  std::size_t first_row = 0;
  std::size_t columns = 0;
  std::size_t rows = 0;

  /// Centre of a cell, counted from 0 in the window.
  [[nodiscard]] Point2 centre(std::size_t column, std::size_t row) const {
    const double c = static_cast<double>(first_column + column) + 0.5;
    const double r = static_cast<double>(first_row + row) + 0.5;
    const std::array<double, 6>& g = geotransform;
    return {g[0] + c * g[1] + r * g[2], g[3] + c * g[4] + r * g[5]};
  }
  /// The other way: columns and rows, counted from the centre of the window's first cell.
  [[nodiscard]] Point2 locate(Point2 p) const {
    const std::array<double, 6>& g = geotransform;
    const double dx = p.x - g[0];
    const double dy = p.y - g[3];
    const double determinant = g[1] * g[5] - g[2] * g[4];
    return {(dx * g[5] - dy * g[2]) / determinant - 0.5 - static_cast<double>(first_column),
            (dy * g[1] - dx * g[4]) / determinant - 0.5 - static_cast<double>(first_row)};
  }
};

enum class Cell : std::uint8_t {
  Valid,
  Void,     ///< no data, bridged
  Outside,  ///< no data, and outside of the TIN
  Absent    ///< not read, because it lies outside of the box
};

/// The cells of one raster, two bits each.
class NodataRegion::Grid {
 public:
  enum class Ground { Unknown, Solid, Bridged, Outside };

  Grid(const CellFrame& frame, std::vector<std::uint8_t> cells, std::unique_ptr<PlaneTransform> to_raster)
      : frame_(frame), cells_(std::move(cells)), to_raster_(std::move(to_raster)) {}

  /// What the raster says of p, in the plane of the survey.
  [[nodiscard]] Ground at(Point2 p) const;

  static std::size_t bytes_per_row(std::size_t columns) { return (columns + 3) / 4; }
  [[nodiscard]] Cell cell(std::size_t column, std::size_t row) const {
    const unsigned four = cells_[row * bytes_per_row(frame_.columns) + column / 4];
    return static_cast<Cell>((four >> (2 * (column % 4))) & 3U);
  }

 private:
  CellFrame frame_;
  std::vector<std::uint8_t> cells_;
  std::unique_ptr<PlaneTransform> to_raster_;  // none: the raster lies in the survey's plane
  mutable std::mutex transforming_;
};

/// Finds the regions while the rows of a raster pass by, from the top.
class RegionFinder {
 public:
  RegionFinder(const CellFrame& frame, NodataMode mode);

  /// The next row: Valid, Void, Absent. Throws: nothing but bad_alloc.
  void add_row(std::span<const Cell> cells);

  struct Result {
    std::vector<std::uint8_t> cells;  ///< as Grid holds them
    std::size_t regions_bridged = 0;
    std::size_t cells_bridged = 0;
    bool has_outside = false;
  };
  /// Pre: all rows were added. Use once.
  Result finish();

 private:
  struct Run {
    std::uint32_t row = 0;
    std::uint32_t begin = 0;
    std::uint32_t end = 0;
    std::uint32_t parent = 0;
    bool on_frame = false;  // of a root: the region touches the frame
  };
  std::uint32_t root(std::uint32_t run);
  void unite(std::uint32_t a, std::uint32_t b);
  void collect_runs(std::span<const Cell> cells);
  void connect_to_previous_row(std::size_t first_of_row);

  CellFrame frame_;
  NodataMode mode_;
  Result result_;
  std::vector<Run> runs_;
  std::size_t first_of_previous_row_ = 0;
  std::vector<Cell> previous_;
  std::uint32_t row_ = 0;
};

}  // namespace thalweg
