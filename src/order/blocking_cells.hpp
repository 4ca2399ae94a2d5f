#pragma once

/// Where no edge blocks: a raster of the edges that do.

#include "order/ground.hpp"

#include <cstdint>
#include <vector>

namespace thalweg::detail {

class BlockingCells {
 public:
  /// Complexity: cells, about one a vertex, and those that edges which block pass.
  explicit BlockingCells(const Ground& ground);

  /// True only if no edge that blocks meets the closed box. Constant time.
  [[nodiscard]] bool free(const Box2& box) const;

 private:
  [[nodiscard]] std::size_t column(double x) const { return cell((x - bounds_.x_min) * per_x_, columns_); }
  [[nodiscard]] std::size_t row(double y) const { return cell((y - bounds_.y_min) * per_y_, rows_); }
  static std::size_t cell(double position, std::size_t count) {
    if (!(position > 0)) return 0;
    return position < static_cast<double>(count) ? static_cast<std::size_t>(position) : count - 1;
  }
  void mark(Point2 p, Point2 q);

  bool any_ = false;
  Box2 bounds_;
  double per_x_ = 0, per_y_ = 0;  ///< cells a unit of length
  std::size_t columns_ = 1, rows_ = 1;
  std::vector<std::uint32_t> sums_;  ///< marked cells left of and below each corner of cells
};

}  // namespace thalweg::detail
