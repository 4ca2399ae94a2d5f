#pragma once

/// Where no edge blocks: a raster of the edges that do.

#include "order/cell_frame.hpp"
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
  /// The place of the lower left corner of a cell among the sums.
  [[nodiscard]] std::size_t corner(std::size_t x, std::size_t y) const {
    return y * (frame_.columns() + 1) + x;
  }
  void mark(Point2 p, Point2 q);

  bool any_ = false;
  CellFrame frame_;
  std::vector<std::uint32_t> sums_;  ///< marked cells left of and below each corner of cells
};

}  // namespace thalweg::detail
