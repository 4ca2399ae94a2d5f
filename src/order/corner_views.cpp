// Cones that shrink.
//
// 1. A line of sight from corner w to a vertex inside beyond uv lies in the disc and in the angle from u to
// v.
//    The walk takes that angle from face to face, cut to what the next edge leaves of it, and ends it at an
//    edge that blocks, at the rim, and at an edge that does not meet the disc.
// 2. A vertex next to the eye is seen. One strictly inside of a cone is, too: all lines to the points of the
// edge through which the cone
//    came in are free. It splits the cone. One on the border is in line with a vertex before it, and is asked
//    for by itself.
// 3. Cones never overlap, so each line of sight is followed once. But a face is entered once for each cone,
//    and there are as many as vertices seen: where these are many, a flood costs less.
#include "order/corner_views.hpp"

#include <algorithm>

namespace thalweg::detail {

void CornerViews::start(const Ground& ground, const Triangle& corners) {
  ground_ = &ground;
  corners_ = corners;
  disc_ = Circumdisc(ground.point(corners[0]), ground.point(corners[1]), ground.point(corners[2]));
  faces_ = 0;
  turn_to(0);
}

void CornerViews::turn_to(std::size_t corner) {
  corner_ = corner;
  open_.clear();
  at_border_.clear();
  neighbours_.clear();
  const VertexId eye = corners_[corner];
  const Point2 from = ground_->point(eye);
  const Angle angle{ground_->point(corners_[(corner + 1) % 3]), ground_->point(corners_[(corner + 2) % 3])};
  const Tin& tin = ground_->tin();
  const auto add_neighbour = [&](VertexId v) {
    const Point2 at = ground_->point(v);
    if (orientation(from, angle.right, at) > 0 && orientation(from, at, angle.left) > 0 && inside(v)) {
      neighbours_.push_back(v);
    }
  };
  for (const HalfedgeId h : tin.outgoing(eye)) {
    add_neighbour(tin.target(h));
    if (tin.on_rim(Tin::previous(h))) add_neighbour(tin.apex(h));
    const auto part = intersect(from, {ground_->point(tin.target(h)), ground_->point(tin.apex(h))}, angle);
    if (part) open_.push_back({Tin::next(h), *part});
  }
}

bool CornerViews::inside(VertexId v) const {
  if (std::find(corners_.begin(), corners_.end(), v) != corners_.end()) return false;
  const int side = disc_.side(ground_->point(v));
  return side > 0 || (side == 0 && disc_.wins_tie(ground_->point(v)));
}

std::optional<VertexId> CornerViews::next() {
  const Tin& tin = ground_->tin();
  while (faces_ <= kMostFaces) {
    if (!neighbours_.empty()) {
      const VertexId v = neighbours_.back();
      neighbours_.pop_back();
      return v;
    }
    if (open_.empty()) {
      if (corner_ == 2) return std::nullopt;
      turn_to(corner_ + 1);
      continue;
    }
    const Cone cone = open_.back();
    open_.pop_back();
    if (ground_->blocks(cone.edge) || tin.on_rim(cone.edge)) continue;
    const Point2 right_end = ground_->point(tin.origin(cone.edge));
    const Point2 left_end = ground_->point(tin.target(cone.edge));
    const int right_side = disc_.side(right_end), left_side = disc_.side(left_end);
    const bool meets = right_side > 0 || left_side > 0 || (right_side == 0 && left_side == 0) ||
                       disc_.passes(right_end, left_end);
    if (!meets) continue;
    ++faces_;
    const HalfedgeId entry = tin.twin(cone.edge);
    const VertexId apex = tin.apex(entry), eye = corners_[corner_];
    const Point2 from = ground_->point(eye), at = ground_->point(apex);
    const int of_right = orientation(from, cone.angle.right, at);
    const int of_left = orientation(from, at, cone.angle.left);
    if (of_right > 0)
      open_.push_back({Tin::next(entry), {cone.angle.right, of_left > 0 ? at : cone.angle.left}});
    if (of_left > 0) {
      open_.push_back({Tin::previous(entry), {of_right > 0 ? at : cone.angle.right, cone.angle.left}});
    }
    if (of_right < 0 || of_left < 0 || !inside(apex)) continue;
    if (of_right > 0 && of_left > 0) return apex;
    const bool known = std::find(at_border_.begin(), at_border_.end(), apex) != at_border_.end();
    if (known || !ground_->sees(apex, eye)) continue;
    at_border_.push_back(apex);
    return apex;
  }
  return std::nullopt;
}

}  // namespace thalweg::detail
