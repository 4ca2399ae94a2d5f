#pragma once

/// Flooding the ground inside the circumdisc of a triangle.

#include "order/circumdisc.hpp"
#include "order/ground.hpp"
#include "order/stamped_map.hpp"

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

namespace thalweg::detail {

/// What stops a flood.
enum class Barrier : std::uint8_t {
  None,          ///< nothing: the faces that meet the disc
  BlockingEdges  ///< edges that block: the faces that paths inside the disc reach
};

/// Yields, one by one, the vertices inside the disc that a flood reaches; its memory is reused by the next
/// flood.
class Flood {
 public:
  /// Starts at a face of the ground that overlaps the interior of `corners`.
  /// Pre: corners counter-clockwise, a valid triangle.
  void start(const Ground& ground, const Triangle& corners, TriangleId face, Barrier barrier);
  /// Starts at one more face as well.
  void start_also(TriangleId face) { enter(face.value()); }
  /// The next vertex inside, or none when the flood has ended, or entered `most_faces` in all. Each comes
  /// once; corners never come.
  std::optional<VertexId> next(std::size_t most_faces = std::numeric_limits<std::size_t>::max());
  /// Goes on without yielding what it finds. False if it enters more than `most_faces` in all.
  bool spread(std::size_t most_faces = std::numeric_limits<std::size_t>::max());
  [[nodiscard]] bool ended() const { return pending_.empty() && yielded_ == inside_.size(); }
  /// All vertices that have come so far.
  [[nodiscard]] std::span<const VertexId> inside() const { return inside_; }
  /// The blocking edges met so far, each once or twice (from both sides); with Barrier::None those of all
  /// faces met.
  [[nodiscard]] std::span<const HalfedgeId> barriers() const { return barriers_; }

 private:
  void spread_from_last();
  void spread_from_triangle(TriangleId face);
  void spread_from_outside(HalfedgeId rim);
  void enter(std::uint32_t face);
  int side(VertexId v);
  bool meets(HalfedgeId h);

  const Ground* ground_ = nullptr;
  Barrier barrier_ = Barrier::None;
  Circumdisc disc_;
  StampedMap faces_;  ///< triangles by id; outside of rim halfedge h: triangle count + h
  StampedMap sides_;  ///< for each vertex met: side of the circle, plus one
  std::vector<std::uint32_t> pending_;
  std::vector<VertexId> inside_;
  std::size_t yielded_ = 0;
  std::size_t spread_ = 0;  ///< faces
  std::vector<HalfedgeId> barriers_;
};

}  // namespace thalweg::detail
