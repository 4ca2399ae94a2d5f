// Vertices bucketed by cell, about two a cell. A position and a box's side are put into cells by the same
// monotone arithmetic, so that no rounding can place a vertex of the box outside of the cells visited.
#include "order/point_grid.hpp"

#include <cmath>

namespace thalweg::detail {

PointGrid::PointGrid(const Tin& tin) {
  std::vector<VertexId> used;
  for (std::size_t v = 0; v < tin.vertex_count(); ++v) {
    if (tin.outgoing(VertexId{v}).empty()) continue;
    used.emplace_back(v);
    bounds_.add(tin.point(VertexId{v}));
  }
  const double cells = std::max(1.0, static_cast<double>(used.size()) / 2);
  const double width = std::max(bounds_.width(), 1e-300);
  const double height = std::max(bounds_.height(), 1e-300);
  columns_ = static_cast<std::size_t>(std::clamp(std::sqrt(cells / height * width), 1.0, cells));
  rows_ = static_cast<std::size_t>(std::clamp(cells / static_cast<double>(columns_), 1.0, cells));
  per_x_ = static_cast<double>(columns_) / width;
  per_y_ = static_cast<double>(rows_) / height;

  const auto cell_of = [&](VertexId v) { return row(tin.point(v).y) * columns_ + column(tin.point(v).x); };
  first_.assign(columns_ * rows_ + 1, 0);
  for (const VertexId v : used) ++first_[cell_of(v) + 1];
  for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
  std::vector<std::uint32_t> fill(first_.begin(), first_.end() - 1);
  vertices_.resize(used.size());
  for (const VertexId v : used) vertices_[fill[cell_of(v)]++] = v;
}

}  // namespace thalweg::detail
