#pragma once

/// The vertices of a ground in the cells of a grid: what lies in a box, wherever faces lead.

#include "order/cell_frame.hpp"

#include <thalweg/mesh/tin.hpp>

#include <cstdint>
#include <vector>

namespace thalweg::detail {

class PointGrid {
 public:
  /// Takes the vertices that are in a triangle.
  explicit PointGrid(const Tin& tin);

  /// Calls `visit(VertexId)` for every vertex in the closed box, and for some near it, until it returns
  /// false.
  template <class Visit>
  void visit_box(const Box2& box, const Visit& visit) const {
    const std::size_t x_first = frame_.column(box.x_min), x_last = frame_.column(box.x_max);
    const std::size_t y_first = frame_.row(box.y_min), y_last = frame_.row(box.y_max);
    for (std::size_t y = y_first; y <= y_last; ++y) {
      for (std::size_t i = first_[y * frame_.columns() + x_first];
           i < first_[y * frame_.columns() + x_last + 1]; ++i) {
        if (!visit(vertices_[i])) return;
      }
    }
  }

 private:
  CellFrame frame_;
  std::vector<std::uint32_t> first_;
  std::vector<VertexId> vertices_;
};

}  // namespace thalweg::detail
