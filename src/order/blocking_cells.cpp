// Cells that edges pass, and their sums over all rectangles from the lower left corner (Crow, Summed-area
// tables for texture mapping, 1984).
//
// Edges and boxes are put into the same cells, so that a common point lies in a marked one: of an edge, each
// row of cells gets the columns of the part of the edge in that row, widened by far more than rounding may
// move its ends.
#include "order/blocking_cells.hpp"

#include <algorithm>
#include <utility>

namespace thalweg::detail {

BlockingCells::BlockingCells(const Ground& ground) : any_(ground.any_blocks()) {
  if (!any_) return;
  const Tin& tin = ground.tin();
  Box2 bounds;
  for (std::size_t v = 0; v < tin.vertex_count(); ++v) bounds.add(tin.point(VertexId{v}));
  frame_ = CellFrame(bounds, static_cast<double>(tin.vertex_count()));
  sums_.assign(corner(0, frame_.rows() + 1), 0);
  for (std::size_t i = 0; i < tin.halfedge_count(); ++i) {
    const HalfedgeId h{i};
    if (tin.represents_edge(h) && ground.blocks(h)) mark(tin.point(tin.origin(h)), tin.point(tin.target(h)));
  }
  for (std::size_t y = 1; y <= frame_.rows(); ++y) {
    std::uint32_t in_row = 0;
    for (std::size_t x = 1; x <= frame_.columns(); ++x) {
      in_row += sums_[corner(x, y)];
      sums_[corner(x, y)] = in_row + sums_[corner(x, y - 1)];
    }
  }
}

void BlockingCells::mark(Point2 p, Point2 q) {
  if (p.y > q.y) std::swap(p, q);
  const std::size_t first = frame_.row(p.y), last = frame_.row(q.y);
  const double low = std::min(p.x, q.x), high = std::max(p.x, q.x);
  const double slack = 1e-3 / frame_.per_x();
  for (std::size_t y = first; y <= last; ++y) {
    double from = low, to = high;
    if (first != last) {
      const double below = frame_.bounds().y_min + (static_cast<double>(y) - 1e-3) / frame_.per_y();
      const double above = frame_.bounds().y_min + (static_cast<double>(y) + 1.001) / frame_.per_y();
      const auto x_at = [&](double level) {
        return p.x + (q.x - p.x) * std::clamp((level - p.y) / (q.y - p.y), 0.0, 1.0);
      };
      const double a = x_at(below), b = x_at(above);
      from = std::max(low, std::min(a, b) - slack);
      to = std::min(high, std::max(a, b) + slack);
    }
    for (std::size_t x = frame_.column(from), end = frame_.column(to); x <= end; ++x) {
      sums_[corner(x + 1, y + 1)] = 1;
    }
  }
}

bool BlockingCells::free(const Box2& box) const {
  if (!any_) return true;
  const std::size_t x_first = frame_.column(box.x_min), x_last = frame_.column(box.x_max) + 1;
  const std::size_t y_first = frame_.row(box.y_min), y_last = frame_.row(box.y_max) + 1;
  const auto sum = [&](std::size_t x, std::size_t y) { return sums_[corner(x, y)]; };
  return sum(x_last, y_last) + sum(x_first, y_first) == sum(x_first, y_last) + sum(x_last, y_first);
}

}  // namespace thalweg::detail
