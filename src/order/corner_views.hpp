#pragma once

/// What the corners of a triangle see in its disc, through its sides or beside them.

#include "order/circumdisc.hpp"
#include "order/ground.hpp"

#include <cstddef>
#include <optional>
#include <vector>

namespace thalweg::detail {

/// Looks from one corner after the other; scratch memory is reused.
class CornerViews {
 public:
  enum class Eyes {
    Opposite,   ///< each side from the corner opposite of it
    AllCorners  ///< and then from its ends
  };
  /// A vertex inside, strictly beyond the side from u to v of the triangle, which lies to its left.
  struct View {
    VertexId seen, u, v;
    bool from_opposite = true;
  };
  /// Pre: corners counter-clockwise, a valid triangle of the ground.
  void start(const Ground& ground, const Triangle& corners, Eyes eyes);
  /// Looks through one side, from corners[side] to the next, from a vertex inside beyond another side.
  /// Pre: as for start.
  void start_through(const Ground& ground, const Triangle& corners, std::size_t side, VertexId eye);
  /// Looks through side corners[2] corners[0] from corners[1], past a vertex that is next to all corners and
  /// beyond that side: by the edges that join it to corners[0] and corners[2], of the faces at the eye.
  void start_past(const Ground& ground, const Triangle& corners, HalfedgeId to_first, HalfedgeId from_last);
  /// The next vertex that an eye sees, in no promised order, for each eye once. None if there is no further
  /// one, or if the walk grew too long. Complexity, all calls together: a face for each time that the lines
  /// of sight to two neighbouring vertices enclose it.
  std::optional<View> next();
  /// Whether the walk was given up: then what `next` yielded is not all.
  [[nodiscard]] bool gave_up() const { return faces_ > kMostFaces; }

 private:
  /// Faces after which a flood of the disc costs less.
  static constexpr std::size_t kMostFaces = 4096;
  /// What the eye sees of an edge, which it crosses on its way out.
  struct Cone {
    HalfedgeId edge;
    Angle angle;
  };
  void set_up(const Ground& ground, const Triangle& corners, std::size_t last_turn);
  void clear();
  void turn_to(std::size_t turn);
  void look_through_side();
  void look_from_end();
  void add_neighbour(VertexId v);
  [[nodiscard]] bool wanted(VertexId v) const;
  [[nodiscard]] bool meets(HalfedgeId edge) const;

  const Ground* ground_ = nullptr;
  Triangle corners_{};
  std::size_t turn_ = 0;  ///< 0 to 2: through that side; 3 to 8: ends of sides
  std::size_t last_turn_ = 0;
  VertexId eye_, u_, v_;
  std::size_t faces_ = 0;
  Circumdisc disc_;
  std::vector<VertexId> neighbours_;  ///< of the eye, not yielded yet
  std::vector<Cone> open_;
  std::vector<VertexId> at_border_;  ///< found on the border of a cone, which two cones may have in common
};

}  // namespace thalweg::detail
