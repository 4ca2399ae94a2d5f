#pragma once

/// The order of one triangle under SeesTriang and ConfEdge, by what is seen from and through its sides.

#include "order/corner_views.hpp"
#include "order/ground.hpp"
#include "order/side_view.hpp"

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace thalweg::detail {

/// Counts for one triangle after the other; scratch memory is reused.
class SideCount {
 public:
  /// The vertices that SeesTriang counts, in no promised order; of more than `limit`, some more of them. None
  /// if light from a side goes through `most_faces`. Pre: corners counter-clockwise, a valid triangle.
  /// Complexity: the ways of light from each side (side_view.hpp).
  std::optional<std::span<const VertexId>> lit(const Ground& ground, const Triangle& corners,
                                               std::size_t limit, std::size_t most_faces);
  /// The vertices that ConfEdge counts, in no promised order; of more than `limit`, some more of them. None
  /// if sight goes far through the two shorter sides. Pre: as for lit; `by_corners` are the vertices that
  /// SeesOpp counts. Complexity: the ways of light from the two shorter sides, and for each vertex on which
  /// it falls what that sees through the longest (corner_views.hpp).
  std::optional<std::span<const VertexId>> conflicting(const Ground& ground, const Triangle& corners,
                                                       std::span<const VertexId> by_corners,
                                                       std::size_t limit);

 private:
  bool look_from_side(const Ground& ground, const Triangle& corners, std::size_t side,
                      std::size_t most_faces);
  bool look_through_longest(const Ground& ground, const Triangle& corners, VertexId eye, std::size_t limit);
  void add(VertexId v);

  SideView side_view_;
  CornerViews views_;
  std::size_t longest_ = 0;                   ///< of the sides
  std::array<std::vector<VertexId>, 3> lit_;  ///< inside, beyond each side
  std::vector<VertexId> counted_;
};

}  // namespace thalweg::detail
