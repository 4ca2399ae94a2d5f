// Points from elevation rasters.
//
// 1. With a box, and if positions do not change, only the window of cells that can lie in the box is read.
// 2. Strips of rows are read, with the mask that GDAL derives from nodata value, mask band or alpha. NaN and
//    infinities are no data either.
// 3. Row by row: centres of valid cells become points, and the row goes to the RegionFinder.
#include "io/raster_points.hpp"

#include "io/gdal_session.hpp"
#include "io/height_unit.hpp"
#include "io/nodata_grid.hpp"
#include "io/point_collector.hpp"
#include "io/spatial_reference.hpp"

#include <thalweg/base/error.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace thalweg {

namespace {

class RasterPoints : public SourceReader {
 public:
  RasterPoints(const SourceSpec& spec, OpenedDataset opened)
      : SourceReader(spec), dataset_(std::move(opened.dataset)), band_(dataset_->GetRasterBand(1)) {
    GdalSession session;
    if (dataset_->GetGeoTransform(frame_.geotransform.data()) != CE_None) {
      throw Error(ErrorCode::Unsupported,
                  name() + (dataset_->GetGCPCount() > 0
                                ? " is placed by control points only; warp it first (gdalwarp)"
                                : " has no georeference; give it one (gdal_translate -a_ullr)"));
    }
    if (!has_area()) {
      throw Error(ErrorCode::BadFormat, name() + " has a geotransform that maps cells to no area");
    }
    if (GDALDataTypeIsComplex(band_->GetRasterDataType()) != 0) {
      throw Error(ErrorCode::Unsupported, name() + " holds complex numbers, not heights");
    }
    const OGRSpatialReference* const reference = dataset_->GetSpatialRef();
    if (lacks_declared_crs(opened, reference)) {
      set_unresolved_crs(opened.crs_errors);
    } else if (reference != nullptr && !means_none(*reference)) {
      set_reference(*reference);
    }
    if (const std::optional<double> unit = metres_of_unit(band_->GetUnitType())) set_vertical_unit(*unit);
  }

  void read(ReadContext& run, PlaneTransform& transform) override {
    GdalSession session;
    if (!run.options.where.empty())
      run.where.refusals.push_back(name() + " is a raster and has no attributes");
    if (!run.options.z_field.empty())
      run.z_field.refusals.push_back(name() + " is a raster and has no fields");
    if (dataset_->GetRasterCount() > 1) {
      run.note(name() + " has " + std::to_string(dataset_->GetRasterCount()) +
               " bands; the first is taken as heights");
    }
    const std::string unit = band_->GetUnitType();
    if (!unit.empty() && !metres_of_unit(unit)) {
      run.note(name() + ": the unit of its heights, '" + unit +
               "', is not known; they are taken to be in that of the CRS (another: --a-crs with a compound "
               "CRS, as EPSG:2994+5703)");
    }
    run.nodata.taken = true;
    has_mask_ = (band_->GetMaskFlags() & GMF_ALL_VALID) == 0;
    scale_ = band_->GetScale();
    offset_ = band_->GetOffset();
    choose_window(run, transform);
    if (!has_mask_)
      expect_points(run, static_cast<double>(frame_.columns) * static_cast<double>(frame_.rows));
    RegionFinder regions(frame_, run.options.nodata);
    read_strips(run, transform, session, regions);
    RegionFinder::Result found = regions.finish();
    run.result.nodata_holes += found.regions_bridged;
    run.result.bridged_cells += found.cells_bridged;
    run.has_outside = run.has_outside || found.has_outside;
    run.grids.push_back(std::make_shared<const NodataRegion::Grid>(
        frame_, std::move(found.cells), transform.moves() ? transform.inverse() : nullptr));
  }

 private:
  /// Whether cells have an area, and all of them lie where coordinates are finite.
  [[nodiscard]] bool has_area() const {
    const std::array<double, 6>& g = frame_.geotransform;
    const double columns = dataset_->GetRasterXSize(), rows = dataset_->GetRasterYSize();
    const double reach_x = std::abs(g[0]) + std::abs(g[1]) * columns + std::abs(g[2]) * rows;
    const double reach_y = std::abs(g[3]) + std::abs(g[4]) * columns + std::abs(g[5]) * rows;
    return is_usable(1 / (g[1] * g[5] - g[2] * g[4])) && is_usable(reach_x) && is_usable(reach_y);
  }
  /// Adds the centres of the cells in the whole raster's corners.
  void add_corners(Box2& box) const {
    const auto columns = static_cast<std::size_t>(dataset_->GetRasterXSize());
    const auto rows = static_cast<std::size_t>(dataset_->GetRasterYSize());
    for (const std::size_t column : {std::size_t{0}, columns - 1}) {
      for (const std::size_t row : {std::size_t{0}, rows - 1}) box.add(frame_.centre(column, row));
    }
  }

  void choose_window(ReadContext& run, const PlaneTransform& transform) {
    const auto columns = static_cast<double>(dataset_->GetRasterXSize());
    const auto rows = static_cast<double>(dataset_->GetRasterYSize());
    Box2 window{0, 0, columns, rows};
    if (run.options.bbox && !transform.moves()) {
      const Box2& box = *run.options.bbox;
      add_corners(run.extent);
      Box2 cells;
      for (const Point2 corner : {Point2{box.x_min, box.y_min}, Point2{box.x_max, box.y_min},
                                  Point2{box.x_min, box.y_max}, Point2{box.x_max, box.y_max}}) {
        cells.add(frame_.locate(corner));
      }
      // One cell more on each side, so that rounding loses none.
      window.x_min = std::clamp(std::floor(cells.x_min) - 1, 0.0, columns);
      window.y_min = std::clamp(std::floor(cells.y_min) - 1, 0.0, rows);
      window.x_max = std::clamp(std::ceil(cells.x_max) + 2, window.x_min, columns);
      window.y_max = std::clamp(std::ceil(cells.y_max) + 2, window.y_min, rows);
    }
    frame_.first_column = static_cast<std::size_t>(window.x_min);
    frame_.first_row = static_cast<std::size_t>(window.y_min);
    frame_.columns = static_cast<std::size_t>(window.width());
    frame_.rows = static_cast<std::size_t>(window.height());
    run.result.outside_bbox += static_cast<std::size_t>(columns * rows) - frame_.columns * frame_.rows;
  }

  void read_strips(ReadContext& run, PlaneTransform& transform, const GdalSession& session,
                   RegionFinder& regions) {
    if (frame_.columns == 0 || frame_.rows == 0) return;
    int block_columns = 0;
    int block_rows = 0;
    band_->GetBlockSize(&block_columns, &block_rows);
    // Whole blocks, about a million cells, never more than eight million.
    constexpr std::size_t kCells = std::size_t{1} << 20U;
    const auto block = static_cast<std::size_t>(std::max(1, block_rows));
    const std::size_t blocks = std::max<std::size_t>(1, kCells / (block * frame_.columns));
    const std::size_t strip = std::clamp<std::size_t>(8 * kCells / frame_.columns, 1, block * blocks);
    values_.resize(strip * frame_.columns);
    mask_.resize(has_mask_ ? values_.size() : 0);
    cells_.resize(frame_.columns);
    for (std::size_t row = 0; row < frame_.rows;) {
      // Strips end where blocks end, also in a window.
      const std::size_t count = std::min(frame_.rows - row, strip - (frame_.first_row + row) % strip);
      read_strip(row, count, session);
      for (std::size_t i = 0; i < count; ++i, ++row) {
        read_row(run, transform, row, i * frame_.columns);
        regions.add_row(cells_);
        run.advance(static_cast<double>(row) / static_cast<double>(frame_.rows));
      }
    }
  }

  void read_strip(std::size_t row, std::size_t count, const GdalSession& session) {
    const auto x = static_cast<int>(frame_.first_column);
    const auto y = static_cast<int>(frame_.first_row + row);
    const auto width = static_cast<int>(frame_.columns);
    const auto height = static_cast<int>(count);
    CPLErr error = band_->RasterIO(GF_Read, x, y, width, height, values_.data(), width, height, GDT_Float64,
                                   0, 0, nullptr);
    if (error == CE_None && has_mask_) {
      error = band_->GetMaskBand()->RasterIO(GF_Read, x, y, width, height, mask_.data(), width, height,
                                             GDT_Byte, 0, 0, nullptr);
    }
    if (error == CE_None) return;
    throw Error(ErrorCode::Unreadable, name() + ": rows " + std::to_string(y) + " to " +
                                           std::to_string(y + height - 1) + " cannot be read" +
                                           session.reason());
  }

  /// Appends the points of a row, whose values begin at `first`, and leaves its cells in cells_.
  void read_row(ReadContext& run, PlaneTransform& transform, std::size_t row, std::size_t first) {
    valid_.clear();
    valid_z_.clear();
    void_.clear();
    for (std::size_t column = 0; column < frame_.columns; ++column) {
      const double value = values_[first + column];
      const bool valid = is_usable(value) && (!has_mask_ || mask_[first + column] != 0);
      cells_[column] = valid ? Cell::Valid : Cell::Void;
      (valid ? valid_ : void_).push_back(frame_.centre(column, row));
      if (valid) valid_z_.push_back(value * scale_ + offset_);
    }
    transform.apply(valid_, valid_z_);
    if (run.options.bbox) leave_out(run, transform);
    append(run);
  }

  /// Marks the row's cells outside of the box as absent.
  void leave_out(ReadContext& run, PlaneTransform& transform) {
    const Box2& box = *run.options.bbox;
    transform.apply(void_, {});
    std::size_t next_valid = 0;
    std::size_t next_void = 0;
    std::size_t kept = 0;
    for (Cell& cell : cells_) {
      const bool valid = cell == Cell::Valid;
      const std::size_t i = valid ? next_valid++ : next_void++;
      if (!box.contains(valid ? valid_[i] : void_[i])) {
        cell = Cell::Absent;
        ++run.result.outside_bbox;
      } else if (valid) {
        valid_[kept] = valid_[i];
        valid_z_[kept++] = valid_z_[i];
      }
    }
    valid_.resize(kept);
    valid_z_.resize(kept);
  }

  void append(ReadContext& run) {
    SurveyPoints& points = run.result.survey.points;
    check_room(points, valid_.size());
    points.xy.insert(points.xy.end(), valid_.begin(), valid_.end());
    points.z.insert(points.z.end(), valid_z_.begin(), valid_z_.end());
    run.result.points_read += valid_.size();
    run.result.nodata_skipped +=
        static_cast<std::size_t>(std::count(cells_.begin(), cells_.end(), Cell::Void));
    if (run.options.admit) run.options.admit(points.xy.size());
  }

  GDALDatasetUniquePtr dataset_;
  GDALRasterBand* band_;
  CellFrame frame_;
  bool has_mask_ = false;
  double scale_ = 1;
  double offset_ = 0;
  std::vector<double> values_;
  std::vector<std::uint8_t> mask_;
  // Of one row:
  std::vector<Cell> cells_;
  std::vector<Point2> valid_;
  std::vector<double> valid_z_;
  std::vector<Point2> void_;
};

}  // namespace

std::unique_ptr<SourceReader> open_raster(const SourceSpec& spec, OpenedDataset opened) {
  return std::make_unique<RasterPoints>(spec, std::move(opened));
}

}  // namespace thalweg
