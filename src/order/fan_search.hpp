#pragma once

/// The vertices that can share a triangle of low order with one vertex: a search outward from it.

#include "order/disc_depth.hpp"
#include "order/fan_types.hpp"
#include "order/ground.hpp"
#include "order/stamped_map.hpp"

#include <array>
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
///
/// The ground around a vertex u falls into fans: what lies between two edges at u that block or are on the
/// rim, or all around. No valid triangle at u has corners in the inside of two of them.
class FanSearch {
 public:
  /// A vertex that u sees, along no other vertex.
  struct Partner {
    VertexId vertex;
    Inverted
        inverse;  ///< its position inverted about u, times a scale; `turn` is from the fan's first direction
  };
  void start(const Ground& ground, VertexId u, std::size_t k, FanPruning pruning);
  /// Searches the next fan; false if there is none left. Finds each vertex v in it that u sees, and that can
  /// be a corner with u of a valid triangle of order at most k in this fan: with FanPruning::NearEnds, only
  /// as far as the triangle's largest angle is at u. Others may be among them. Complexity: the faces of the
  /// ground in each gap of the view that is not given up.
  bool next_fan();
  /// What the last fan holds, counter-clockwise.
  [[nodiscard]] std::span<const Partner> partners() const { return partners_; }
  /// Vertices straight behind one that u sees, as far as a disc through u with at most k seen inside may have
  /// them inside. Others may be among them.
  [[nodiscard]] std::span<const Partner> behind() const { return behind_; }
  /// Whether the fan goes all around.
  [[nodiscard]] bool closed() const { return closed_; }

 private:
  using Seen = FanTypes::Seen;
  using Role = FanTypes::Role;
  using Range = FanTypes::Range;
  using Probe = FanTypes::Probe;
  /// A gap of the view, between two vertices seen: `edge` is entered from u's side; no part of it within the
  /// angle is nearer than `distance`.
  struct Gap {
    HalfedgeId edge;
    std::uint32_t right = 0, left = 0;  ///< of seen_
    double distance = 0;
    double tested = 0;              ///< the distance at which it, or one it comes from, was last tested
    std::array<Direction, 2> open;  ///< for each role one that few covered; zero: not known
  };

  void enter_fan(HalfedgeId first);
  [[nodiscard]] bool starts_fan(HalfedgeId h) const { return ground_->blocks(h) || ground_->tin().on_rim(h); }
  void expand(const Gap& gap);
  void push(HalfedgeId edge, Gap gap);
  std::uint32_t see(VertexId v, double turn);
  void count(std::uint32_t seen);
  void open_gaps(HalfedgeId first);
  [[nodiscard]] Inverted inverted(Point2 p, double turn) const;
  [[nodiscard]] bool hopeless_at(const Seen& seen);
  void collect();
  [[nodiscard]] bool gives_up(Gap& gap);
  [[nodiscard]] bool out_of_reach(const Gap& gap) const;
  [[nodiscard]] bool nearer(const Gap& gap, double distance) const;
  [[nodiscard]] double turn_of(std::uint32_t from, Point2 p) const;
  [[nodiscard]] Point2 at(std::uint32_t seen) const { return ground_->point(seen_[seen].vertex); }

  void note_behind(std::uint32_t seen, VertexId v);
  [[nodiscard]] double distance_to(const Gap& gap) const;
  void list_certain(const Range& range);
  void list_certain_beside(const Range& range, Role side);
  static Probe probe(const Range& range, Direction c);
  [[nodiscard]] bool deep_at(const Range& range, Direction c) const;
  bool keep_covering(const std::array<Probe, 4>& chief, Direction& open);
  [[nodiscard]] bool deep_between(const Range& range, const Probe& from, const Probe& to, int halvings,
                                  Direction& open) const;
  /// Whether no triangle of order <= k has u and a position in the range as corners; with NearEnds, u as that
  /// of the largest angle. Tells directions that few cover where it says no; `open` may bring guesses.
  [[nodiscard]] bool hopeless(const Range& range, std::array<Direction, 2>& open);
  [[nodiscard]] bool hopeless_as(Role role, Range range, Direction& open);

  const Ground* ground_ = nullptr;
  VertexId u_;
  Point2 at_;
  std::size_t k_ = 0;
  FanPruning pruning_ = FanPruning::None;
  std::vector<HalfedgeId> fans_;  ///< the first halfedge of each that is left
  bool closed_ = false;
  bool narrow_ = false;    ///< no two pieces of a disc through u can lie in the fan
  double breadth_ = 0;     ///< radians
  double scale_ = 1;       ///< the distance of the nearest neighbour in the fan
  double far_ = 0;         ///< from where on disc_depth.cpp may be too coarse
  Direction first_;        ///< unit vector of the fan's first direction
  bool counting_ = false;  ///< whether depth_ is kept
  bool tabled_ = false;    ///< whether it decides
  DiscDepth depth_;
  StampedMap counted_;     ///< vertices in depth_
  std::vector<Gap> gaps_;  ///< a heap by distance; with `tabled_` all so far
  std::vector<Seen> seen_;
  /// Relative: far above what rounding does, where positions inverted are compared.
  static constexpr double kCoverSlack = 1e-10;
  std::vector<std::uint32_t> active_;  ///< of seen_: those that count for the range at hand
  std::vector<Partner> partners_;
  std::vector<Partner> behind_;
};

}  // namespace thalweg::detail
