#pragma once

/// A box cut into cells that are about square.

#include <thalweg/geometry/point.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace thalweg::detail {

/// Positions and the sides of boxes are put into columns and rows by the same monotone arithmetic, so no
/// rounding can place what a box holds outside of the cells from its low sides to its high ones. Positions
/// outside are in the nearest cell.
class CellFrame {
 public:
  CellFrame() = default;
  /// About as many cells as given, at least one.
  CellFrame(const Box2& bounds, double cells) : bounds_(bounds) {
    cells = std::max(1.0, cells);
    const double width = std::max(bounds.width(), 1e-300), height = std::max(bounds.height(), 1e-300);
    columns_ = static_cast<std::size_t>(std::clamp(std::sqrt(cells / height * width), 1.0, cells));
    rows_ = static_cast<std::size_t>(std::clamp(cells / static_cast<double>(columns_), 1.0, cells));
    per_x_ = static_cast<double>(columns_) / width;
    per_y_ = static_cast<double>(rows_) / height;
  }
  [[nodiscard]] const Box2& bounds() const { return bounds_; }
  [[nodiscard]] std::size_t columns() const { return columns_; }
  [[nodiscard]] std::size_t rows() const { return rows_; }
  /// Cells a unit of length.
  [[nodiscard]] double per_x() const { return per_x_; }
  [[nodiscard]] double per_y() const { return per_y_; }
  [[nodiscard]] std::size_t column(double x) const { return cell((x - bounds_.x_min) * per_x_, columns_); }
  [[nodiscard]] std::size_t row(double y) const { return cell((y - bounds_.y_min) * per_y_, rows_); }

 private:
  static std::size_t cell(double position, std::size_t count) {
    if (!(position > 0)) return 0;
    return position < static_cast<double>(count) ? static_cast<std::size_t>(position) : count - 1;
  }

  Box2 bounds_;
  double per_x_ = 0, per_y_ = 0;
  std::size_t columns_ = 1, rows_ = 1;
};

}  // namespace thalweg::detail
