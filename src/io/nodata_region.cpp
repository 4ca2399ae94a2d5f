// Regions without data of rasters.
//
// A row of cells without data is cut into runs. Runs of neighbouring rows that touch over a side or a corner
// are united (union-find with path halving), and a region is marked if one of its runs lies at the raster's
// frame or beside a cell that was not read. In the end the cells of the regions that are outside are written
// into the grid.
#include "io/gdal_session.hpp"
#include "io/nodata_grid.hpp"

#include <thalweg/base/error.hpp>
#include <thalweg/io/nodata_region.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

namespace thalweg {

bool NodataRegion::outside(Point2 p) const {
  bool outside = false;
  for (const std::shared_ptr<const Grid>& grid : grids_) {
    const Grid::Ground ground = grid->at(p);
    if (ground == Grid::Ground::Solid) return false;
    outside = outside || ground == Grid::Ground::Outside;
  }
  return outside;
}

NodataRegion::Grid::Ground NodataRegion::Grid::at(Point2 p) const {
  if (to_raster_) {
    const std::scoped_lock lock(transforming_);
    try {
      to_raster_->apply(std::span(&p, 1), {});
    } catch (const Error&) {
      return Ground::Unknown;
    }
  }
  const Point2 place = frame_.locate(p);
  const auto columns = static_cast<double>(frame_.columns);
  const auto rows = static_cast<double>(frame_.rows);
  const bool in_frame = place.x >= 0 && place.y >= 0 && place.x <= columns - 1 && place.y <= rows - 1;
  if (!in_frame || frame_.columns < 2 || frame_.rows < 2) return Ground::Unknown;
  const auto column = std::min(static_cast<std::size_t>(place.x), frame_.columns - 2);
  const auto row = std::min(static_cast<std::size_t>(place.y), frame_.rows - 2);
  const double right = place.x - static_cast<double>(column);
  const double down = place.y - static_cast<double>(row);

  int valid = 0;
  bool outside = false;
  bool in_triangle = false;  // of the valid centres, if one is invalid
  for (const auto& [c, r] : {std::pair(0, 0), std::pair(1, 0), std::pair(0, 1), std::pair(1, 1)}) {
    const Cell state = cell(column + static_cast<std::size_t>(c), row + static_cast<std::size_t>(r));
    if (state == Cell::Absent) return Ground::Unknown;
    if (state == Cell::Valid) {
      ++valid;
    } else {
      in_triangle = std::abs(right - c) + std::abs(down - r) >= 1;
      outside = outside || state == Cell::Outside;
    }
  }
  if (valid == 4 || (valid == 3 && in_triangle)) return Ground::Solid;
  return outside ? Ground::Outside : Ground::Bridged;
}

RegionFinder::RegionFinder(const CellFrame& frame, NodataMode mode) : frame_(frame), mode_(mode) {
  result_.cells.reserve(NodataRegion::Grid::bytes_per_row(frame.columns) * frame.rows);
}

void RegionFinder::add_row(std::span<const Cell> cells) {
  for (std::size_t column = 0; column < cells.size(); column += 4) {
    unsigned four = 0;
    for (std::size_t i = 0; i < std::min<std::size_t>(4, cells.size() - column); ++i) {
      four |= static_cast<unsigned>(cells[column + i]) << (2 * i);
    }
    result_.cells.push_back(static_cast<std::uint8_t>(four));
  }
  const std::size_t first_of_row = runs_.size();
  collect_runs(cells);
  if (row_ > 0) connect_to_previous_row(first_of_row);
  first_of_previous_row_ = first_of_row;
  previous_.assign(cells.begin(), cells.end());
  ++row_;
}

void RegionFinder::collect_runs(std::span<const Cell> cells) {
  const auto absent_near = [](std::span<const Cell> row, const Run& run) {
    const std::size_t begin = run.begin > 0 ? run.begin - 1 : 0;
    const std::size_t end = std::min<std::size_t>(row.size(), run.end + std::size_t{1});
    return std::find(row.begin() + begin, row.begin() + end, Cell::Absent) != row.begin() + end;
  };
  for (std::size_t column = 0; column < cells.size(); ++column) {
    if (cells[column] != Cell::Void) continue;
    Run run;
    run.row = row_;
    run.begin = static_cast<std::uint32_t>(column);
    while (column < cells.size() && cells[column] == Cell::Void) ++column;
    run.end = static_cast<std::uint32_t>(column);
    run.parent = static_cast<std::uint32_t>(runs_.size());
    run.on_frame = row_ == 0 || row_ + 1 == frame_.rows || run.begin == 0 || run.end == frame_.columns ||
                   absent_near(cells, run) || absent_near(previous_, run);
    runs_.push_back(run);
  }
  for (std::size_t i = first_of_previous_row_; i < runs_.size() && runs_[i].row + 1 == row_; ++i) {
    if (absent_near(cells, runs_[i])) runs_[root(static_cast<std::uint32_t>(i))].on_frame = true;
  }
}

/// Two sorted lists of runs, walked together: whichever ends first is done with.
void RegionFinder::connect_to_previous_row(std::size_t first_of_row) {
  std::size_t above = first_of_previous_row_;
  std::size_t below = first_of_row;
  while (above < first_of_row && below < runs_.size()) {
    if (runs_[above].begin <= runs_[below].end && runs_[below].begin <= runs_[above].end) {
      unite(static_cast<std::uint32_t>(above), static_cast<std::uint32_t>(below));
    }
    if (runs_[above].end < runs_[below].end) {
      ++above;
    } else {
      ++below;
    }
  }
}

std::uint32_t RegionFinder::root(std::uint32_t run) {
  while (runs_[run].parent != run) {
    runs_[run].parent = runs_[runs_[run].parent].parent;
    run = runs_[run].parent;
  }
  return run;
}

void RegionFinder::unite(std::uint32_t a, std::uint32_t b) {
  a = root(a);
  b = root(b);
  if (a == b) return;
  const auto [first, second] = std::minmax(a, b);
  runs_[second].parent = first;
  runs_[first].on_frame = runs_[first].on_frame || runs_[second].on_frame;
}

RegionFinder::Result RegionFinder::finish() {
  const std::size_t bytes = NodataRegion::Grid::bytes_per_row(frame_.columns);
  for (std::size_t i = 0; i < runs_.size(); ++i) {
    const Run run = runs_[i];
    const std::uint32_t top = root(static_cast<std::uint32_t>(i));
    const bool outside =
        mode_ == NodataMode::BridgeNone || (mode_ == NodataMode::BridgeHoles && runs_[top].on_frame);
    if (!outside) {
      result_.cells_bridged += run.end - run.begin;
      if (top == i) ++result_.regions_bridged;
      continue;
    }
    result_.has_outside = true;
    for (std::size_t column = run.begin; column < run.end; ++column) {
      std::uint8_t& four = result_.cells[run.row * bytes + column / 4];
      // Void is 1, Outside is 2: both bits of the pair change.
      four = static_cast<std::uint8_t>(four ^ (3U << (2 * (column % 4))));
    }
  }
  return std::move(result_);
}

}  // namespace thalweg
