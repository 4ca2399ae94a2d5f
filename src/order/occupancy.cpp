// Is a triangle of three vertices valid?
//
// 1. Visit the faces of the ground that meet the open triangle, from one at its first corner on, through all
//    edges that meet it. A face and a triangle are convex, so this visits all of them.
// 2. Each vertex in the closed triangle is a corner of such a face: the triangle is occupied if one is found
//    that is no corner of its own.
// 3. In an unoccupied triangle an edge that blocks can meet the closed triangle only at its corners or
//    through its interior, for its ends lie outside: it is crossed if one was met on the way.
// 4. A segment meets an open triangle unless a line separates them; two convex polygons are separated, if at
//    all, by the line of a side of one of them.
// 5. Where the triangle leaves the ground of a polygon, the faces do not tell what lies in it: then every
//    vertex and edge is looked at.
#include "order/occupancy.hpp"

#include <algorithm>
#include <array>

namespace thalweg::detail {

namespace {

bool meets_open_triangle(const std::array<Point2, 3>& corners, Point2 p, Point2 q) {
  for (std::size_t i = 0; i < 3; ++i) {
    const Point2 from = corners[i];
    const Point2 to = corners[(i + 1) % 3];
    if (orientation(from, to, p) <= 0 && orientation(from, to, q) <= 0) return false;
  }
  bool left = false;
  bool right = false;
  for (const Point2 corner : corners) {
    const int side = orientation(p, q, corner);
    left = left || side > 0;
    right = right || side < 0;
  }
  return left && right;
}

bool in_closed_triangle(const std::array<Point2, 3>& corners, Point2 p) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (orientation(corners[i], corners[(i + 1) % 3], p) < 0) return false;
  }
  return true;
}

std::array<Point2, 3> positions(const Ground& ground, const Triangle& corners) {
  return {ground.point(corners[0]), ground.point(corners[1]), ground.point(corners[2])};
}

}  // namespace

TriangleValidity Occupancy::inspect(const Ground& ground, const Triangle& triangle, Inspection inspection) {
  Triangle corners = triangle;
  const auto at = positions(ground, corners);
  const int turn = orientation(at[0], at[1], at[2]);
  if (turn == 0) return {TriangleFault::Flat, {}, {}};
  if (turn < 0) std::swap(corners[1], corners[2]);
  occupant_ = crossing_low_ = crossing_high_ = VertexId{};
  const auto start = ground.face_in_angle(corners[0], corners[1], corners[2]);
  left_ground_ = !start;
  if (start) visit_faces(ground, corners, Tin::triangle_of(*start), inspection);
  if (left_ground_ && inspection == Inspection::Lowest) search_everywhere(ground, corners);
  if (occupant_.valid()) return {TriangleFault::Occupied, occupant_, {}};
  if (crossing_low_.valid()) return {TriangleFault::Crossed, crossing_low_, crossing_high_};
  return {start ? TriangleFault::None : TriangleFault::Outside, {}, {}};
}

void Occupancy::visit_faces(const Ground& ground, const Triangle& corners, TriangleId start,
                            Inspection inspection) {
  faces_.clear();
  pending_.clear();
  faces_.insert(start.value());
  pending_.push_back(start.value());
  while (!pending_.empty()) {
    const std::uint32_t face = pending_.back();
    pending_.pop_back();
    inspect_face(ground, corners, face);
    if (inspection == Inspection::FirstFault && (occupant_.valid() || crossing_low_.valid())) return;
  }
}

void Occupancy::search_everywhere(const Ground& ground, const Triangle& corners) {
  const Tin& tin = ground.tin();
  const auto at = positions(ground, corners);
  for (std::size_t i = 0; i < tin.halfedge_count(); ++i) {
    const HalfedgeId h{i};
    note_vertex(ground, corners, tin.origin(h));
    if (ground.blocks(h) &&
        meets_open_triangle(at, ground.point(tin.origin(h)), ground.point(tin.target(h)))) {
      note_crossing(tin, h);
    }
  }
}

void Occupancy::inspect_face(const Ground& ground, const Triangle& corners, std::uint32_t face) {
  const Tin& tin = ground.tin();
  const auto at = positions(ground, corners);
  for (const VertexId v : tin.triangle(TriangleId{face})) note_vertex(ground, corners, v);
  for (std::size_t i = 0; i < 3; ++i) {
    const HalfedgeId h = Tin::halfedge(TriangleId{face}, i);
    const HalfedgeId twin = tin.twin(h);
    const bool visited = twin.valid() && faces_.find(Tin::triangle_of(twin).value()) != nullptr;
    if (visited && !ground.blocks(h)) continue;
    if (!meets_open_triangle(at, ground.point(tin.origin(h)), ground.point(tin.target(h)))) continue;
    if (ground.blocks(h)) note_crossing(tin, h);
    left_ground_ = left_ground_ || !twin.valid();
    if (visited || !twin.valid()) continue;
    faces_.insert(Tin::triangle_of(twin).value());
    pending_.push_back(Tin::triangle_of(twin).value());
  }
}

void Occupancy::note_vertex(const Ground& ground, const Triangle& corners, VertexId v) {
  if (std::find(corners.begin(), corners.end(), v) != corners.end()) return;
  if (occupant_.valid() && occupant_ < v) return;
  if (in_closed_triangle(positions(ground, corners), ground.point(v))) occupant_ = v;
}

void Occupancy::note_crossing(const Tin& tin, HalfedgeId h) {
  const VertexId low = std::min(tin.origin(h), tin.target(h));
  const VertexId high = std::max(tin.origin(h), tin.target(h));
  if (crossing_low_.valid() && std::pair(crossing_low_, crossing_high_) < std::pair(low, high)) return;
  crossing_low_ = low;
  crossing_high_ = high;
}

}  // namespace thalweg::detail
