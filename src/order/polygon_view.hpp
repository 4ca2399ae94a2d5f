#pragma once

/// What a vertex of a simple polygon sees inside a disc, by a walk along the dual tree.

#include "order/circumdisc.hpp"
#include "order/ground.hpp"

#include <optional>
#include <span>
#include <vector>

namespace thalweg::detail {

/// Looks from one vertex after the other; scratch memory is reused.
class PolygonView {
 public:
  /// The vertices that the eye sees along segments in the disc, and some more that it sees; in no promised
  /// order. Pre: ground.simple_polygons(). Complexity: the faces that meet the disc: each is entered once.
  std::span<const VertexId> look(const Ground& ground, const Circumdisc& disc, VertexId eye);

 private:
  /// A cone that is still open: `edge` from its right to its left end, entered from the side of the eye.
  struct Cone {
    HalfedgeId edge;
    Angle angle;
  };

  /// Takes one cone through one face; the vertex that it finds in sight there.
  std::optional<VertexId> advance(const Ground& ground, const Circumdisc& disc, Point2 from);
  void follow(const Ground& ground, const Circumdisc& disc, Point2 from);

  std::vector<Cone> open_;
  std::vector<VertexId> visible_;
};

}  // namespace thalweg::detail
