// An angular sweep over a half-plane.
//
// 1. Walls are the edges that reach into the half-plane and are not seen end on: from their right to their
//    left end the direction turns by less than half a turn. Edges that end in the eye cast no shadow, and
//    those seen end on block by their ends alone.
// 2. Events by direction: at one direction walls that end there come first, then points, the nearest first,
//    then walls that start. So the status holds at a point the walls that its ray crosses properly, ordered
//    along the ray; edges do not cross, so two walls keep their order while both are there. A point is hidden
//    if it lies behind the first wall, or behind an end of an edge that blocks on the same ray.
// 3. Of two walls with a direction in common, the one whose right end lies within the other's span is in
//    front if that end, or where they share it the left end, is on the eye's side of the other.
#include "order/view_sweep.hpp"

#include <algorithm>
#include <optional>

namespace thalweg::detail {

namespace {

// For a and b on one ray from p.
bool nearer(Point2 p, Point2 a, Point2 b) {
  if (a.x != b.x) return a.x > p.x ? a.x < b.x : a.x > b.x;
  return a.y > p.y ? a.y < b.y : a.y > b.y;
}

}  // namespace

bool ViewSweep::in_front(const Wall& one, const Wall& other) const {
  const auto starts_within = [&](const Wall& inner, const Wall& outer) {
    return orientation(eye_, outer.right, inner.right) >= 0 && orientation(eye_, inner.right, outer.left) > 0;
  };
  const auto side_of = [](const Wall& wall, const Wall& of) {
    const int side = orientation(of.right, of.left, wall.right);
    return side != 0 ? side : orientation(of.right, of.left, wall.left);
  };
  return starts_within(one, other) ? side_of(one, other) > 0 : side_of(other, one) < 0;
}

bool ViewSweep::before(const Event& a, const Event& b) const {
  const int turn = orientation(eye_, a.at, b.at);
  if (turn != 0) return turn > 0;
  if (a.turn != b.turn) return a.turn < b.turn;
  if (a.turn == Turn::Point && a.at != b.at) return nearer(eye_, a.at, b.at);
  return a.subject < b.subject;
}

void ViewSweep::add_wall(const Ground& ground, HalfedgeId edge, Point2 along, int side) {
  Wall wall{ground.point(ground.tin().origin(edge)), ground.point(ground.tin().target(edge))};
  const int turn = orientation(eye_, wall.right, wall.left);
  if (turn == 0) return;
  if (turn < 0) std::swap(wall.right, wall.left);
  const bool starts = orientation(eye_, along, wall.right) == side;
  const bool ends = orientation(eye_, along, wall.left) == side;
  if (!starts && !ends) return;
  const auto number = static_cast<std::uint32_t>(walls_.size());
  walls_.push_back(wall);
  if (starts) {
    events_.push_back({wall.right, Turn::Start, number});
  } else {
    open_.push_back(number);
  }
  if (ends) events_.push_back({wall.left, Turn::End, number});
}

void ViewSweep::list_events(const Ground& ground, VertexId eye, HalfPlane half,
                            std::span<const VertexId> points, std::span<const HalfedgeId> edges) {
  walls_.clear();
  open_.clear();
  events_.clear();
  const Point2 along = ground.point(half.along);
  for (const HalfedgeId h : edges) {
    if (ground.tin().origin(h) != eye && ground.tin().target(h) != eye) {
      add_wall(ground, h, along, half.side);
    }
  }
  for (const VertexId p : points) {
    const Point2 at = ground.point(p);
    if (orientation(eye_, along, at) == half.side) events_.push_back({at, Turn::Point, p.value()});
  }
  std::sort(events_.begin(), events_.end(), [&](const Event& a, const Event& b) { return before(a, b); });
}

std::span<const VertexId> ViewSweep::look(const Ground& ground, VertexId eye, HalfPlane half,
                                          std::span<const VertexId> points,
                                          std::span<const HalfedgeId> edges) {
  eye_ = ground.point(eye);
  list_events(ground, eye, half, points, edges);
  Status status(Nearer{this});
  places_.assign(walls_.size(), status.end());
  for (const std::uint32_t wall : open_) places_[wall] = status.insert(wall).first;
  visible_.clear();
  std::optional<Point2> blocker;  // on the ray of the last point
  for (const Event& event : events_) {
    if (event.turn == Turn::End) {
      status.erase(places_[event.subject]);
    } else if (event.turn == Turn::Start) {
      places_[event.subject] = status.insert(event.subject).first;
    } else {
      if (blocker && orientation(eye_, *blocker, event.at) == 0) continue;
      blocker.reset();
      if (!status.empty()) {
        const Wall& first = walls_[*status.begin()];
        if (orientation(first.right, first.left, event.at) < 0) continue;
      }
      const VertexId p{event.subject};
      visible_.push_back(p);
      if (ground.blocks(p)) blocker = event.at;
    }
  }
  return visible_;
}

}  // namespace thalweg::detail
