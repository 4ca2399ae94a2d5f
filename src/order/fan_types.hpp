#pragma once

/// What a search around a vertex u keeps of its view.

#include "order/directions.hpp"

#include <thalweg/base/id.hpp>

#include <cstdint>
#include <limits>

namespace thalweg::detail {

struct FanTypes {
  static constexpr double kNoStop = std::numeric_limits<double>::infinity();
  /// A vertex seen, relative to u. With NearEnds, what ends certainty about vertices farther round than it,
  /// or than the gap that follows it: for all that lie farther than a stop over kReach.
  struct Seen {
    VertexId vertex;
    double x = 0, y = 0;
    double distance = 0;
    double turn = 0;  ///< from the fan's first direction
    Direction inverse;
    double slack = 0;  ///< more than what rounding may do to products of `inverse` with unit vectors
    std::uint32_t next = 0, previous = 0;  ///< counter-clockwise; after the last comes the first
    double stop = kNoStop;                 ///< itself, if edges that block end in it
    double stop_behind = kNoStop;          ///< straight behind it, for itself also
    double stop_after = kNoStop;           ///< in the gap that follows it, where that was given up
  };
  /// What is known of the triangle's other corner w, as seen from u: nothing, or that it is 60 degrees or
  /// more counter-clockwise, or clockwise, of the place looked at.
  enum class Role : std::uint8_t { Any, Right, Left };
  /// The directions between two neighbours in the view, or that of one, and the positions in it at some
  /// distance or farther, as the corners of a triangle with u that holds them all after inversion.
  struct Range {
    std::uint32_t right = 0, left = 0;      ///< of those seen
    double right_turn = 0, left_turn = 0;   ///< theirs
    Direction to_right = {}, to_left = {};  ///< unit vectors
    Direction right_at = {}, left_at = {};  ///< the corners
    double horizon = 0;                     ///< what lies nearer is known
    double slack = 0;
    Role role = Role::Any;
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
