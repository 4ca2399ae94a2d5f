#pragma once

/// Which points, segments or boxes are near: a grid of square cells, nothing more.

#include <thalweg/geometry/point.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

namespace thalweg::verify {

/// Numbers filed under the cells of a grid. An index into the caller's array is a bare number here: the grid
/// does not know what it files.
class PlainGrid {
 public:
  /// About `per_cell` of `count` things a cell if they lay evenly in the box.
  PlainGrid(const Box2& box, std::size_t count, double per_cell) : box_(box) {
    constexpr double kMost = 4096;
    const double area = std::max(box.width(), 1e-300) * std::max(box.height(), 1e-300);
    size_ = std::sqrt(area * per_cell / static_cast<double>(std::max<std::size_t>(count, 1)));
    size_ = std::max({size_, box.width() / kMost, box.height() / kMost, 1e-300});
    columns_ = static_cast<int>(box.width() / size_) + 1;
    rows_ = static_cast<int>(box.height() / size_) + 1;
    cells_.resize(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
  }

  void file_box(const Box2& box, std::uint32_t number) {
    for_cells(box, [&](std::size_t cell, const Box2&) { cells_[cell].push_back(number); });
  }
  void file_segment(Point2 a, Point2 b, std::uint32_t number) {
    for_cells_on(a, b, [&](std::size_t cell) {
      cells_[cell].push_back(number);
      return true;
    });
  }
  [[nodiscard]] std::span<const std::uint32_t> in(std::size_t cell) const { return cells_[cell]; }
  [[nodiscard]] std::size_t cell_count() const { return cells_.size(); }

  /// Calls f(cell, its box) for every cell that the box meets.
  template <class F>
  void for_cells(const Box2& box, const F& f) const {
    const int last_column = column(box.x_max), last_row = row(box.y_max);
    for (int r = row(box.y_min); r <= last_row; ++r) {
      for (int c = column(box.x_min); c <= last_column; ++c) f(index(r, c), cell_box(r, c));
    }
  }
  /// The same in squares around the cell of `from`, the nearest first, until f returns false.
  template <class F>
  void for_cells_outward(const Box2& box, Point2 from, const F& f) const {
    const int left = column(box.x_min), right = column(box.x_max), low = row(box.y_min),
              high = row(box.y_max);
    const int c0 = column(from.x), r0 = row(from.y);
    const int last = std::max({c0 - left, right - c0, r0 - low, high - r0, 0});
    for (int d = 0; d <= last; ++d) {
      for (int r = std::max(low, r0 - d); r <= std::min(high, r0 + d); ++r) {
        const bool whole_row = r == r0 - d || r == r0 + d;
        for (int c = c0 - d; c <= c0 + d; c += whole_row || d == 0 ? 1 : 2 * d) {
          if (c >= left && c <= right && !f(index(r, c), cell_box(r, c))) return;
        }
      }
    }
  }
  /// Calls f(cell) for at least every cell that the segment meets, from a to b, until f returns false.
  template <class F>
  void for_cells_on(Point2 a, Point2 b, const F& f) const {
    const Point2 first = a < b ? a : b, second = a < b ? b : a;
    const int step = a < b ? 1 : -1;
    const int end = column(b.x) + step;
    const double slope = first.x < second.x ? (second.y - first.y) / (second.x - first.x) : 0;
    for (int c = column(a.x); c != end; c += step) {
      // The part of the segment over this column, one cell more on all sides.
      const double from = std::max(first.x, box_.x_min + (c - 1) * size_);
      const double to = std::min(second.x, box_.x_min + (c + 2) * size_);
      const bool steep = first.x == second.x || !std::isfinite(slope);
      const double y1 = steep ? first.y : first.y + (from - first.x) * slope;
      const double y2 = steep ? second.y : first.y + (to - first.x) * slope;
      const int low = std::max(row(std::min(y1, y2)) - 1, row(std::min(a.y, b.y)));
      const int high = std::min(row(std::max(y1, y2)) + 1, row(std::max(a.y, b.y)));
      for (int r = low; r <= high; ++r) {
        if (!f(index(r, c))) return;
      }
    }
  }

 private:
  [[nodiscard]] int column(double x) const { return clamped((x - box_.x_min) / size_, columns_); }
  [[nodiscard]] int row(double y) const { return clamped((y - box_.y_min) / size_, rows_); }
  static int clamped(double cell, int count) {
    return static_cast<int>(std::clamp(cell, 0.0, static_cast<double>(count - 1)));
  }
  [[nodiscard]] std::size_t index(int r, int c) const {
    return static_cast<std::size_t>(r) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(c);
  }
  [[nodiscard]] Box2 cell_box(int r, int c) const {
    return {box_.x_min + c * size_, box_.y_min + r * size_, box_.x_min + (c + 1) * size_,
            box_.y_min + (r + 1) * size_};
  }

  Box2 box_;
  double size_ = 1;
  int columns_ = 1, rows_ = 1;
  std::vector<std::vector<std::uint32_t>> cells_;
};

}  // namespace thalweg::verify
