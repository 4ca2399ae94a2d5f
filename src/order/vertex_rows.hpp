#pragma once

/// The vertices of a ground in rows, sorted along each: what lies in a box or a disc, wherever faces lead.

#include "order/cell_frame.hpp"

#include <thalweg/mesh/tin.hpp>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace thalweg::detail {

class VertexRows {
 public:
  /// Takes the vertices that are in a triangle. Keeps a reference to the TIN.
  explicit VertexRows(const Tin& tin);

  /// Calls `visit(VertexId)` for every vertex in the closed box, and for some near it, until it returns
  /// false.
  template <class Visit>
  void visit_box(const Box2& box, const Visit& visit) const {
    for (std::size_t row = frame_.row(box.y_min); row <= frame_.row(box.y_max); ++row) {
      for (std::size_t i = lower(row, box.x_min); i < first_[row + 1] && x_[i] <= box.x_max; ++i) {
        if (!visit(vertices_[i])) return;
      }
    }
  }

  /// Number of vertices but the corners in the open disc of a triangle, by the tie rule. Pre: corners
  /// counter-clockwise. Complexity: the rows that the disc meets, and the vertices about its circle.
  [[nodiscard]] std::size_t count_in_disc(const Triangle& corners) const;

 private:
  /// The first vertex of a row whose x is not below.
  [[nodiscard]] std::size_t lower(std::size_t row, double x) const {
    return static_cast<std::size_t>(
        std::lower_bound(x_.begin() + first_[row], x_.begin() + first_[row + 1], x) - x_.begin());
  }

  const Tin& tin_;
  CellFrame frame_;  // columns are of no use
  std::vector<std::uint32_t> first_;
  std::vector<double> low_, high_;  // of each row: the range of its vertices' y
  std::vector<double> x_;
  std::vector<VertexId> vertices_;
};

}  // namespace thalweg::detail
