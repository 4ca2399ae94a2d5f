#pragma once

/// Sight through the sides of a triangle, one vertex at a time.

#include "order/ground.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace thalweg::detail {

/// Whether p sees a point of the open side from u to v of a valid triangle. Its scratch is reused.
class SideSight {
 public:
  /// Pre: the triangle lies left of uv, p strictly right of it and inside its circumcircle; uv does not
  /// block. Complexity: the faces of the ground in each of the gaps that the view from p to uv has.
  bool sees_side(const Ground& ground, VertexId p, VertexId u, VertexId v);
  /// The same. Pre: `edges` hold each edge that blocks and is the first on some line from uv to p.
  /// Complexity: m log m for m edges at most.
  bool sees_side(const Ground& ground, VertexId p, VertexId u, VertexId v, std::span<const HalfedgeId> edges);

 private:
  /// A gap that is still open: `edge` from its right to its left end, entered from the side of p.
  struct Gap {
    HalfedgeId edge;
    Angle angle;
  };
  enum class Place : std::uint8_t { Before, Across, Beyond };
  static Place place(Point2 p, Point2 u, Point2 v, Point2 right, Point2 left);

  enum class Light : std::uint8_t { None, Some, Unknown };
  Light follow_gaps(const Ground& ground, VertexId p, VertexId u, VertexId v, std::size_t most);
  bool covered(const Ground& ground, VertexId p, VertexId u, VertexId v, std::span<const HalfedgeId> edges);

  std::vector<Gap> open_;
  std::vector<Angle> shadows_;
};

}  // namespace thalweg::detail
