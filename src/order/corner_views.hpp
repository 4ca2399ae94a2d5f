#pragma once

/// What the corners of a triangle see in its disc, each through the side across from it.

#include "order/circumdisc.hpp"
#include "order/ground.hpp"

#include <cstddef>
#include <optional>
#include <vector>

namespace thalweg::detail {

/// Looks from one corner after the other; scratch memory is reused.
class CornerViews {
 public:
  /// Pre: corners counter-clockwise, a valid triangle of the ground.
  void start(const Ground& ground, const Triangle& corners);
  /// The next vertex inside that its opposite corner sees, in no promised order, each once. None if there is
  /// no further one, or if the walk grew too long. Complexity, all calls together: a face for each time that
  /// the lines of sight to two neighbouring vertices enclose it.
  std::optional<VertexId> next();
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
  void turn_to(std::size_t corner);
  [[nodiscard]] bool inside(VertexId v) const;

  const Ground* ground_ = nullptr;
  Triangle corners_{};
  std::size_t corner_ = 0;
  std::size_t faces_ = 0;
  Circumdisc disc_;
  std::vector<VertexId> neighbours_;  ///< of the eye, not yielded yet
  std::vector<Cone> open_;
  std::vector<VertexId> at_border_;  ///< found on the border of a cone, which two cones may have in common
};

}  // namespace thalweg::detail
