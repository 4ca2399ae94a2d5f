#pragma once

/// What floating point says of many edges at once, with the bounds of the predicates' filters.

#include "order/ground.hpp"

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
  /// The vertices across the sides vs, tv, ut and su; s where there is no triangle.
  std::array<VertexId, 4> beyond;
  /// Whether each lies inside the circle of sut (the first two) or of tvs; of corners it is unclear.
  std::array<std::int8_t, 4> inside;
  bool convex;  ///< strictly; else that is unclear
};

/// Yes, no, or that rounding may hide it.
constexpr std::int8_t kInside = 1, kOutside = -1, kUnclear = 0;

/// At which ends of an edge a vertex inside the circle of the other three refuses it, across a side at that
/// end: at all, at those where no edge ends that blocks, or at none.
enum class Refusing : std::uint8_t { All, Unblocked, None };

/// Looks at halfedges in batches of kMost.
class QuadrilateralFilter {
 public:
  static constexpr std::size_t kMost = 128;
  QuadrilateralFilter(const detail::Ground& ground, Refusing refusing)
      : ground_(ground), tin_(ground.tin()), refusing_(refusing) {}

  /// The surroundings of edges inside the TIN that are no constraint, each by its lower halfedge among
  /// [begin, end), in order; but for those that are surely not convex, or surely refused.
  /// Pre: at most kMost halfedges. Valid until the next call.
  std::span<const EdgeSurroundings> look(std::size_t begin, std::size_t end);

 private:
  using Column = std::array<double, kMost>;
  struct Columns {
    std::array<Column, 8> x, y;  ///< s, u, t, v, then what is beyond
    std::array<Column, 4> verdict;
  };
  static void judge_corners(Columns& at, std::size_t count);
  static void judge_circles(Columns& at, std::size_t count);
  void place(std::size_t column, std::size_t i, VertexId v) {
    at_.x[column][i] = tin_.point(v).x;
    at_.y[column][i] = tin_.point(v).y;
  }
  std::size_t list_edges(std::size_t begin, std::size_t end);
  std::size_t list_convex(std::size_t edges);
  void look_beyond(std::size_t i);
  [[nodiscard]] bool refused(std::size_t i) const;

  const detail::Ground& ground_;
  const Tin& tin_;
  Refusing refusing_;
  Columns at_{};
  std::array<HalfedgeId, kMost> edge_;
  std::array<std::array<VertexId, 8>, kMost> vertex_;  ///< as the columns
  std::array<bool, kMost> convex_{};
  std::array<EdgeSurroundings, kMost> found_;
};

}  // namespace thalweg
