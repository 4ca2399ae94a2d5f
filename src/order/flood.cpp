// Which vertices can be reached inside a disc.
//
// 1. The flood spreads from face to face through every edge that meets the open disc (and does not block).
//    Faces and disc are convex, so their common part is connected: if a face is reached, so is each point of
//    it in the disc.
// 2. A vertex inside is reached if a reached face has it as a corner: from a point of the face in the open
//    disc a segment inside both leads to it. Vertices exactly on the circle are inside by the tie rule only;
//    the disc itself, and so the question which edges meet it, is never perturbed.
// 3. Outside of a convex ground there is one face for each rim edge. The rim inside the disc falls into
//    chains, and the outside inside the disc into one piece a chain, for the ground between them is convex:
//    neighbouring outer faces are joined exactly if their common vertex is strictly inside. With no barrier
//    the faces of the ground alone are connected inside the disc, and hold every vertex.
#include "order/flood.hpp"

namespace thalweg::detail {

void Flood::start(const Ground& ground, const Triangle& corners, TriangleId face, Barrier barrier) {
  ground_ = &ground;
  barrier_ = barrier;
  disc_ = Circumdisc(ground.point(corners[0]), ground.point(corners[1]), ground.point(corners[2]));
  faces_.clear();
  sides_.clear();
  pending_.clear();
  inside_.clear();
  barriers_.clear();
  yielded_ = spread_ = 0;
  for (const VertexId corner : corners) sides_.insert(corner.value(), 1);
  enter(face.value());
}

std::optional<VertexId> Flood::next(std::size_t most_faces) {
  while (yielded_ == inside_.size()) {
    if (pending_.empty() || spread_ == most_faces) return std::nullopt;
    spread_from_last();
  }
  return inside_[yielded_++];
}

bool Flood::spread(std::size_t most_faces) {
  while (!pending_.empty()) {
    if (spread_ == most_faces) return false;
    spread_from_last();
  }
  return true;
}

void Flood::spread_from_last() {
  const std::size_t triangles = ground_->tin().triangle_count();
  ++spread_;
  const std::uint32_t face = pending_.back();
  pending_.pop_back();
  if (face < triangles) {
    spread_from_triangle(TriangleId{face});
  } else {
    spread_from_outside(HalfedgeId{face - triangles});
  }
}

void Flood::enter(std::uint32_t face) {
  if (faces_.insert(face)) pending_.push_back(face);
}

int Flood::side(VertexId v) {
  if (const std::uint8_t* known = sides_.find(v.value())) return *known - 1;
  const int found = disc_.side(ground_->point(v));
  sides_.insert(v.value(), static_cast<std::uint8_t>(found + 1));
  if (found > 0 || (found == 0 && disc_.wins_tie(ground_->point(v)))) inside_.push_back(v);
  return found;
}

bool Flood::meets(HalfedgeId h) {
  const VertexId from = ground_->tin().origin(h);
  const VertexId to = ground_->tin().target(h);
  const int from_side = side(from);
  const int to_side = side(to);
  if (from_side > 0 || to_side > 0) return true;
  if (from_side == 0 && to_side == 0) return true;
  return disc_.passes(ground_->point(from), ground_->point(to));
}

void Flood::spread_from_triangle(TriangleId face) {
  const Tin& tin = ground_->tin();
  for (const VertexId corner : tin.triangle(face)) side(corner);
  for (std::size_t i = 0; i < 3; ++i) {
    const HalfedgeId h = Tin::halfedge(face, i);
    const bool stops = barrier_ == Barrier::BlockingEdges && ground_->blocks(h);
    const HalfedgeId twin = tin.twin(h);
    if (barrier_ == Barrier::None && ground_->blocks(h)) barriers_.push_back(h);
    if (stops) {
      if (meets(h)) barriers_.push_back(h);
    } else if (twin.valid()) {
      const std::uint32_t beyond = Tin::triangle_of(twin).value();
      if (faces_.find(beyond) == nullptr && meets(h)) enter(beyond);
    } else if (barrier_ == Barrier::BlockingEdges && meets(h)) {
      enter(static_cast<std::uint32_t>(tin.triangle_count()) + h.value());
    }
  }
}

void Flood::spread_from_outside(HalfedgeId rim) {
  const Tin& tin = ground_->tin();
  const auto triangles = static_cast<std::uint32_t>(tin.triangle_count());
  const bool stops = ground_->blocks(rim);
  if (meets(rim)) {
    if (stops) {
      barriers_.push_back(rim);
    } else {
      enter(Tin::triangle_of(rim).value());
    }
  }
  const VertexId from = tin.origin(rim);
  const VertexId to = tin.target(rim);
  if (side(from) > 0) enter(triangles + ground_->rim_to(from).value());
  if (side(to) > 0) enter(triangles + ground_->rim_from(to).value());
}

}  // namespace thalweg::detail
