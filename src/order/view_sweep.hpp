#pragma once

/// What one vertex sees of many, by an angular sweep.

#include "order/ground.hpp"

#include <cstdint>
#include <set>
#include <span>
#include <vector>

namespace thalweg::detail {

/// Sweeps around one eye after the other; scratch memory is reused.
class ViewSweep {
 public:
  /// The open half-plane of the points x for which orientation(eye, along, x) is `side`.
  struct HalfPlane {
    VertexId along;
    int side = 1;
  };

  /// Those of `points` in the half-plane that the eye sees, in angular order.
  /// Pre: for each point p that the eye does not see, the obstacle nearest to the eye on the segment to p is
  /// in the interior of one of `edges`, or is one of `points` and an end of an edge that blocks. All edges
  /// block, and none comes twice. Complexity: n log n for n points and edges.
  std::span<const VertexId> look(const Ground& ground, VertexId eye, HalfPlane half,
                                 std::span<const VertexId> points, std::span<const HalfedgeId> edges);

 private:
  /// An edge, from its right to its left end as the eye sees it.
  struct Wall {
    Point2 right, left;
  };
  enum class Turn : std::uint8_t { End, Point, Start };  // in this order at one direction
  struct Event {
    Point2 at;
    Turn turn = Turn::Point;
    std::uint32_t subject = 0;  ///< the wall, or the vertex
  };
  struct Nearer {
    const ViewSweep* sweep;
    bool operator()(std::uint32_t one, std::uint32_t other) const {
      return sweep->in_front(sweep->walls_[one], sweep->walls_[other]);
    }
  };
  using Status = std::set<std::uint32_t, Nearer>;

  void list_events(const Ground& ground, VertexId eye, HalfPlane half, std::span<const VertexId> points,
                   std::span<const HalfedgeId> edges);
  void add_wall(const Ground& ground, HalfedgeId edge, Point2 along, int side);
  [[nodiscard]] bool in_front(const Wall& one, const Wall& other) const;
  [[nodiscard]] bool before(const Event& a, const Event& b) const;

  Point2 eye_;
  std::vector<Wall> walls_;
  std::vector<std::uint32_t> open_;  ///< walls that reach into the half-plane from its right side
  std::vector<Event> events_;
  std::vector<Status::iterator> places_;  ///< of walls in the status
  std::vector<VertexId> visible_;
};

}  // namespace thalweg::detail
