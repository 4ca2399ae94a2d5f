#pragma once

/// What floating point says of many edges at once, with the bounds of the predicates' filters.

#include <thalweg/mesh/tin.hpp>
#include <thalweg/order/quadrilaterals.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace thalweg {

/// An edge between two triangles, with the vertices beyond the sides of its quadrilateral.
struct EdgeSurroundings {
  Quadrilateral quadrilateral;
  /// The sides vs, tv, ut and su, as halfedges of its two triangles.
  std::array<HalfedgeId, 4> sides;
  /// The vertices across them; s where there is no triangle.
  std::array<VertexId, 4> beyond;
  /// Whether each lies inside the circle of sut (the first two) or of tvs; not said of corners.
  std::array<std::int8_t, 4> inside;
};

/// Yes, no, or that rounding may hide it.
constexpr std::int8_t kInside = 1, kOutside = -1, kUnclear = 0;

/// Looks at edges in batches of kMost.
class QuadrilateralFilter {
 public:
  static constexpr std::size_t kMost = 128;
  explicit QuadrilateralFilter(const Tin& tin) : tin_(tin) {}

  /// The surroundings of those of the edges whose quadrilateral is strictly convex, in order.
  /// Pre: at most kMost edges, each inside the TIN. Valid until the next call.
  std::span<const EdgeSurroundings> look(std::span<const HalfedgeId> edges);

 private:
  using Column = std::array<double, kMost>;
  struct Columns {
    std::array<Column, 8> x, y;  ///< s, u, t, v, then what is beyond
    std::array<Column, 4> verdict;
  };
  static void judge_corners(Columns& at);
  static void judge_circles(Columns& at);
  void place(std::size_t column, std::size_t i, VertexId v) {
    at_.x[column][i] = tin_.point(v).x;
    at_.y[column][i] = tin_.point(v).y;
  }
  void surround(HalfedgeId h, EdgeSurroundings& found) const;
  [[nodiscard]] bool is_convex(const Quadrilateral& q, std::size_t i) const;

  const Tin& tin_;
  Columns at_{};
  std::array<EdgeSurroundings, kMost> found_;
};

}  // namespace thalweg
