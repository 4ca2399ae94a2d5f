#pragma once

/// The vertices of a ground in the cells of a grid: what lies in a box, wherever faces lead.

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
    const std::size_t x_first = column(box.x_min), x_last = column(box.x_max);
    const std::size_t y_first = row(box.y_min), y_last = row(box.y_max);
    for (std::size_t y = y_first; y <= y_last; ++y) {
      for (std::size_t i = first_[y * columns_ + x_first]; i < first_[y * columns_ + x_last + 1]; ++i) {
        if (!visit(vertices_[i])) return;
      }
    }
  }

 private:
  [[nodiscard]] std::size_t column(double x) const { return cell((x - bounds_.x_min) * per_x_, columns_); }
  [[nodiscard]] std::size_t row(double y) const { return cell((y - bounds_.y_min) * per_y_, rows_); }
  static std::size_t cell(double position, std::size_t count) {
    if (!(position > 0)) return 0;
    return position < static_cast<double>(count) ? static_cast<std::size_t>(position) : count - 1;
  }

  Box2 bounds_;
  double per_x_ = 0, per_y_ = 0;  ///< cells a unit of length
  std::size_t columns_ = 1, rows_ = 1;
  std::vector<std::uint32_t> first_;
  std::vector<VertexId> vertices_;
};

}  // namespace thalweg::detail
