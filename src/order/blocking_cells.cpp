// Cells that edges pass, and their sums over all rectangles from the lower left corner (Crow, Summed-area
// tables for texture mapping, 1984).
//
// Positions are put into cells by the same monotone arithmetic for edges and boxes, so that a common point
// lies in a marked cell: of an edge, each row of cells gets the columns of the part of the edge in that row,
// widened by far more than rounding may move its ends.
#include "order/blocking_cells.hpp"

#include <algorithm>
#include <cmath>

namespace thalweg::detail {

BlockingCells::BlockingCells(const Ground& ground) : any_(ground.any_blocks()) {
  if (!any_) return;
  const Tin& tin = ground.tin();
  for (std::size_t v = 0; v < tin.vertex_count(); ++v) bounds_.add(tin.point(VertexId{v}));
  const double cells = std::max(1.0, static_cast<double>(tin.vertex_count()));
  const double width = std::max(bounds_.width(), 1e-300), height = std::max(bounds_.height(), 1e-300);
  columns_ = static_cast<std::size_t>(std::clamp(std::sqrt(cells / height * width), 1.0, cells));
  rows_ = static_cast<std::size_t>(std::clamp(cells / static_cast<double>(columns_), 1.0, cells));
  per_x_ = static_cast<double>(columns_) / width;
  per_y_ = static_cast<double>(rows_) / height;
  sums_.assign((columns_ + 1) * (rows_ + 1), 0);
  for (std::size_t i = 0; i < tin.halfedge_count(); ++i) {
    const HalfedgeId h{i};
    if (tin.represents_edge(h) && ground.blocks(h)) mark(tin.point(tin.origin(h)), tin.point(tin.target(h)));
  }
  for (std::size_t y = 1; y <= rows_; ++y) {
    std::uint32_t in_row = 0;
    for (std::size_t x = 1; x <= columns_; ++x) {
      in_row += sums_[y * (columns_ + 1) + x];
      sums_[y * (columns_ + 1) + x] = in_row + sums_[(y - 1) * (columns_ + 1) + x];
    }
  }
}

void BlockingCells::mark(Point2 p, Point2 q) {
  if (p.y > q.y) std::swap(p, q);
  const std::size_t first = row(p.y), last = row(q.y);
  const double low = std::min(p.x, q.x), high = std::max(p.x, q.x);
  const double slack = 1e-3 / per_x_;
  for (std::size_t y = first; y <= last; ++y) {
    double from = low, to = high;
    if (first != last) {
      const double below = bounds_.y_min + (static_cast<double>(y) - 1e-3) / per_y_;
      const double above = bounds_.y_min + (static_cast<double>(y) + 1.001) / per_y_;
      const auto x_at = [&](double level) {
        return p.x + (q.x - p.x) * std::clamp((level - p.y) / (q.y - p.y), 0.0, 1.0);
      };
      const double a = x_at(below), b = x_at(above);
      from = std::max(low, std::min(a, b) - slack);
      to = std::min(high, std::max(a, b) + slack);
    }
    for (std::size_t x = column(from), end = column(to); x <= end; ++x) {
      sums_[(y + 1) * (columns_ + 1) + x + 1] = 1;
    }
  }
}

bool BlockingCells::free(const Box2& box) const {
  if (!any_) return true;
  const std::size_t x_first = column(box.x_min), x_last = column(box.x_max) + 1;
  const std::size_t y_first = row(box.y_min), y_last = row(box.y_max) + 1;
  const auto sum = [&](std::size_t x, std::size_t y) { return sums_[y * (columns_ + 1) + x]; };
  return sum(x_last, y_last) + sum(x_first, y_first) == sum(x_first, y_last) + sum(x_last, y_first);
}

}  // namespace thalweg::detail
