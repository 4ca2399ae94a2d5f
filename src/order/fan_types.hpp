#pragma once

/// What a search around a vertex u keeps of its view.

#include "order/directions.hpp"

#include <thalweg/base/id.hpp>

#include <cstdint>

namespace thalweg::detail {

struct FanTypes {
  /// A vertex seen, relative to u.
  struct Seen {
    VertexId vertex;
    double x = 0, y = 0;
    double distance = 0;
    double turn = 0;   ///< from the fan's first direction
    double angle = 0;  ///< diamond angle, with NearEnds
    Direction inverse;
    double slack = 0;        ///< more than what rounding may do to products of `inverse` with unit vectors
    std::uint32_t next = 0;  ///< counter-clockwise; after the last comes the first
  };
  /// What ends certainty about the vertices farther round: a direction, for all vertices farther than
  /// `distance` over kReach.
  struct Stop {
    VertexId vertex;  ///< invalid: a side of a gap that was given up
    double angle = 0;
    double distance = 0;
  };
  /// What is known of the triangle's other corner w, as seen from u: nothing, or that it is 60 degrees or
  /// more counter-clockwise, or clockwise, of the place looked at.
  enum class Role : std::uint8_t { Any, Right, Left };
  /// A closed range of directions, counter-clockwise, and the positions in it at some distance or farther, as
  /// the corners of a triangle with u that holds them all after inversion.
  struct Range {
    double right_turn = 0, left_turn = 0;
    double right = 0, left = 0;   ///< diamond angles
    Direction to_right, to_left;  ///< unit vectors
    Direction right_at, left_at;  ///< the corners
    double horizon = 0;           ///< what lies nearer is known
    double slack = 0;
    Role role = Role::Any;
    double sector_end = 0;  ///< of any but Any: a diamond angle 60 degrees from the range's far end
  };
  /// A direction, and what products of inverse positions with it must exceed to cover it.
  struct Probe {
    Direction c;
    double threshold = 0;
    [[nodiscard]] bool covered_by(const Seen& seen) const {
      return seen.inverse.x * c.x + seen.inverse.y * c.y - seen.slack > threshold;
    }
  };
};

}  // namespace thalweg::detail
