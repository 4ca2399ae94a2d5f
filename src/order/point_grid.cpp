// Vertices bucketed by cell, about two a cell.
#include "order/point_grid.hpp"

namespace thalweg::detail {

PointGrid::PointGrid(const Tin& tin) {
  std::vector<VertexId> used;
  Box2 bounds;
  for (std::size_t v = 0; v < tin.vertex_count(); ++v) {
    if (tin.outgoing(VertexId{v}).empty()) continue;
    used.emplace_back(v);
    bounds.add(tin.point(VertexId{v}));
  }
  frame_ = CellFrame(bounds, static_cast<double>(used.size()) / 2);
  const auto cell_of = [&](VertexId v) {
    return frame_.row(tin.point(v).y) * frame_.columns() + frame_.column(tin.point(v).x);
  };
  first_.assign(frame_.columns() * frame_.rows() + 1, 0);
  for (const VertexId v : used) ++first_[cell_of(v) + 1];
  for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
  std::vector<std::uint32_t> fill(first_.begin(), first_.end() - 1);
  vertices_.resize(used.size());
  for (const VertexId v : used) vertices_[fill[cell_of(v)]++] = v;
}

}  // namespace thalweg::detail
