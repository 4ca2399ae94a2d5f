// Cones that shrink.
//
// 1. A line of sight from the opposite corner w to a vertex inside beyond uv lies in the disc and in the
//    angle from u to v; one from u lies right of uv. The walk takes that angle from face to face, cut to what
//    the next edge leaves of it, and ends it at an edge that blocks, at the rim, and at an edge that does not
//    meet the disc.
// 2. A vertex next to the eye is seen. One strictly inside of a cone is, too: all lines to the points of the
//    edge through which the cone came in are free. It splits the cone. One on the border is in line with a
//    vertex before it, and is asked for by itself.
// 3. Cones never overlap, so each line of sight is followed once. But a face is entered once for each cone,
//    and there are as many as vertices seen: where these are many, a flood costs less.
#include "order/corner_views.hpp"

#include <algorithm>

namespace thalweg::detail {

void CornerViews::set_up(const Ground& ground, const Triangle& corners, std::size_t last_turn) {
  ground_ = &ground;
  corners_ = corners;
  disc_ = Circumdisc(ground.point(corners[0]), ground.point(corners[1]), ground.point(corners[2]));
  faces_ = 0;
  last_turn_ = last_turn;
}

void CornerViews::start(const Ground& ground, const Triangle& corners, Eyes eyes) {
  set_up(ground, corners, eyes == Eyes::Opposite ? 2 : 8);
  turn_to(0);
}

void CornerViews::start_through(const Ground& ground, const Triangle& corners, std::size_t side,
                                VertexId eye) {
  set_up(ground, corners, side);
  turn_ = side;
  clear();
  u_ = corners[side];
  v_ = corners[(side + 1) % 3];
  eye_ = eye;
  look_through_side();
}

void CornerViews::start_past(const Ground& ground, const Triangle& corners, HalfedgeId to_first,
                             HalfedgeId from_last) {
  set_up(ground, corners, 2);
  turn_ = 2;
  clear();
  u_ = corners[2];
  v_ = corners[0];
  eye_ = corners[1];
  for (const HalfedgeId edge : {to_first, from_last}) {
    open_.push_back(
        {edge, {ground.point(ground.tin().origin(edge)), ground.point(ground.tin().target(edge))}});
  }
}

void CornerViews::clear() {
  open_.clear();
  at_border_.clear();
  neighbours_.clear();
}

void CornerViews::turn_to(std::size_t turn) {
  turn_ = turn;
  clear();
  u_ = corners_[turn % 3];
  v_ = corners_[(turn + 1) % 3];
  eye_ = turn < 3 ? corners_[(turn + 2) % 3] : turn < 6 ? u_ : v_;
  turn < 3 ? look_through_side() : look_from_end();
}

void CornerViews::look_through_side() {
  const Tin& tin = ground_->tin();
  const Point2 from = ground_->point(eye_);
  const Angle angle{ground_->point(u_), ground_->point(v_)};
  for (const HalfedgeId h : tin.outgoing(eye_)) {
    add_neighbour(tin.target(h));
    if (tin.on_rim(Tin::previous(h))) add_neighbour(tin.apex(h));
    const auto part = intersect(from, {ground_->point(tin.target(h)), ground_->point(tin.apex(h))}, angle);
    if (part) open_.push_back({Tin::next(h), *part});
  }
}

// Faces that reach right of uv. Behind the eye they are not cut: there the disc ends at its tangent.
void CornerViews::look_from_end() {
  const Tin& tin = ground_->tin();
  if (ground_->blocks_between(u_, v_)) return;
  const Point2 u = ground_->point(u_), v = ground_->point(v_);
  const VertexId other = eye_ == u_ ? v_ : u_;
  const auto beyond = [&](VertexId x) { return orientation(u, v, ground_->point(x)) < 0; };
  for (const HalfedgeId h : tin.outgoing(eye_)) {
    const VertexId right = tin.target(h), left = tin.apex(h);
    add_neighbour(right);
    if (tin.on_rim(Tin::previous(h))) add_neighbour(left);
    if (!beyond(right) && !beyond(left)) continue;
    Angle angle{ground_->point(right), ground_->point(left)};
    if (eye_ == u_ && !beyond(left)) angle.left = ground_->point(other);
    if (eye_ == v_ && !beyond(right)) angle.right = ground_->point(other);
    open_.push_back({Tin::next(h), angle});
  }
}

void CornerViews::add_neighbour(VertexId v) {
  if (wanted(v)) neighbours_.push_back(v);
}

bool CornerViews::wanted(VertexId x) const {
  if (std::find(corners_.begin(), corners_.end(), x) != corners_.end()) return false;
  const Point2 at = ground_->point(x);
  if (orientation(ground_->point(u_), ground_->point(v_), at) >= 0) return false;
  return disc_.holds(at);
}

bool CornerViews::meets(HalfedgeId edge) const {
  const Point2 from = ground_->point(ground_->tin().origin(edge));
  const Point2 to = ground_->point(ground_->tin().target(edge));
  const int from_side = disc_.side(from), to_side = disc_.side(to);
  return from_side > 0 || to_side > 0 || (from_side == 0 && to_side == 0) || disc_.passes(from, to);
}

std::optional<CornerViews::View> CornerViews::next() {
  const Tin& tin = ground_->tin();
  const auto view = [&](VertexId seen) { return View{seen, u_, v_, turn_ < 3}; };
  while (!gave_up()) {
    if (!neighbours_.empty()) {
      const VertexId seen = neighbours_.back();
      neighbours_.pop_back();
      return view(seen);
    }
    if (open_.empty()) {
      if (turn_ == last_turn_) return std::nullopt;
      turn_to(turn_ + 1);
      continue;
    }
    const Cone cone = open_.back();
    open_.pop_back();
    if (ground_->blocks(cone.edge) || tin.on_rim(cone.edge) || !meets(cone.edge)) continue;
    ++faces_;
    const HalfedgeId entry = tin.twin(cone.edge);
    const VertexId apex = tin.apex(entry);
    const Point2 from = ground_->point(eye_), at = ground_->point(apex);
    const int of_right = orientation(from, cone.angle.right, at);
    const int of_left = orientation(from, at, cone.angle.left);
    if (of_right > 0) {
      open_.push_back({Tin::next(entry), {cone.angle.right, of_left > 0 ? at : cone.angle.left}});
    }
    if (of_left > 0) {
      open_.push_back({Tin::previous(entry), {of_right > 0 ? at : cone.angle.right, cone.angle.left}});
    }
    if (of_right < 0 || of_left < 0 || !wanted(apex)) continue;
    if (of_right > 0 && of_left > 0) return view(apex);
    const bool known = std::find(at_border_.begin(), at_border_.end(), apex) != at_border_.end();
    if (known || !ground_->sees(apex, eye_)) continue;
    at_border_.push_back(apex);
    return view(apex);
  }
  return std::nullopt;
}

}  // namespace thalweg::detail
