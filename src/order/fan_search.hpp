#pragma once

/// The vertices that can share a triangle of low order with one vertex: a search outward from it.

#include "order/ground.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace thalweg::detail {

/// What a vertex that u sees, inside a disc through u, is known to add to the order of a triangle at u.
enum class FanPruning : std::uint8_t {
  Visible,   ///< it counts: Std, Pathcon, SeesTriang, SeesVtx
  NearEnds,  ///< it counts as far as no end of a constraint edge lies between: ConfEdge, SeesOpp
  None       ///< nothing: the search visits all that u sees
};

/// Searches around one vertex after the other; scratch memory is reused.
class FanSearch {
 public:
  /// A vertex that u sees, along no other vertex.
  struct Partner {
    VertexId vertex;
    double angle = 0;  ///< diamond angle of its direction, in [0, 4), rounded
  };

  /// Finds each vertex v that u sees, and that can be a corner with u of a valid triangle of order at most k:
  /// with FanPruning::NearEnds, only as far as the triangle's largest angle is at u. Others may be among
  /// them. Complexity: the faces of the ground in each gap of the view that is not given up.
  std::span<const Partner> partners(const Ground& ground, VertexId u, std::size_t k, FanPruning pruning);

 private:
  /// A vertex seen, relative to u.
  struct Seen {
    VertexId vertex;
    double x = 0, y = 0;
    double distance = 0;
    double angle = 0;
    double inverse_x = 0, inverse_y = 0;  ///< the position inverted at the unit circle about u
  };
  /// What ends certainty about the vertices farther round: a direction, for all vertices farther than
  /// `distance` over kReach.
  struct Stop {
    VertexId vertex;  ///< invalid: the side of a gap that was given up
    double angle = 0;
    double distance = 0;
  };
  /// A gap of the view: `edge` from its right to its left end, entered from u's side; no part of it within
  /// the angle is nearer than `distance`.
  struct Gap {
    HalfedgeId edge;
    Angle angle;
    double distance = 0;
  };
  /// A closed range of directions, counter-clockwise, and the positions in it at some distance or farther, as
  /// the corners of a triangle with u that holds them all after inversion.
  struct Range {
    double right = 0, left = 0;
    double right_x = 0, right_y = 0, left_x = 0, left_y = 0;
  };
  struct Turn {
    double angle = 0;
    int change = 0;
  };

  void start();
  void expand(const Gap& gap);
  void push(HalfedgeId edge, const Angle& angle, double distance);
  void see(VertexId v);
  void stop_at(VertexId v, double distance);
  void give_up(const Gap& gap);
  [[nodiscard]] double distance_to(const Gap& gap) const;
  [[nodiscard]] bool certain(const Range& range, const Seen& seen, double horizon) const;
  [[nodiscard]] bool hopeless(const Range& range, double horizon);
  void add_turns(const Range& range, const Seen& seen);

  const Ground* ground_ = nullptr;
  VertexId u_;
  Point2 at_;
  std::size_t k_ = 0;
  FanPruning pruning_ = FanPruning::None;
  std::vector<Gap> gaps_;  ///< a heap by distance
  std::vector<Seen> seen_;
  std::vector<Stop> stops_;
  std::vector<Turn> turns_;
  std::vector<Partner> partners_;
};

}  // namespace thalweg::detail
