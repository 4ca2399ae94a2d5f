// Does p see the open side uv of a valid triangle t = uvw?
//
// 1. The closed shadows of finitely many edges leave a point of uv in the light exactly if they leave an open
//    piece of it, so it is enough to follow open angles ("gaps") at p, which start as the angle from v to u
//    and are cut at each vertex that they reach. Edges that end in p cast a shadow without breadth: they only
//    cut.
// 2. A gap passes from face to face. It is lost at an edge that blocks and lies before uv. It is proved when
//    it reaches an edge beyond uv: then nothing blocked it as far as uv, which no blocking edge meets.
// 3. Where an edge e lies: both ends on or left of uv: beyond. Both on or right of it: before. Else the line
//    of uv cuts e. If e cuts the open side uv itself, it does not block (t is valid), and the gap goes on;
//    some rays of it are proved already, but the faces that follow lie beyond uv for them, and prove them
//    soon. If e cuts the line outside the side, u and v lie on one side of the line of e: if p is there too,
//    the gap reaches e beyond uv; if not, e lies between p and uv.
// 4. Where gaps are many, the closed shadows of the edges before uv, cut to the view of uv, are sorted by
//    their right ends, and followed from v as far as they join.
#include "order/sights.hpp"

#include <algorithm>
#include <limits>

namespace thalweg::detail {

namespace {

// Gaps that are followed at least before shadows are sorted: a step in a gap takes about as long as one edge
// takes there.
constexpr std::size_t kGapsFree = 256;

}  // namespace

SideSight::Place SideSight::place(Point2 p, Point2 u, Point2 v, Point2 right, Point2 left) {
  const int of_right = orientation(u, v, right);
  const int of_left = orientation(u, v, left);
  if (of_right >= 0 && of_left >= 0) return Place::Beyond;
  if (of_right <= 0 && of_left <= 0) return Place::Before;
  const int of_u = orientation(right, left, u);
  const int of_v = orientation(right, left, v);
  if (of_u * of_v < 0) return Place::Across;
  return orientation(right, left, p) * (of_u + of_v) > 0 ? Place::Beyond : Place::Before;
}

bool SideSight::sees_side(const Ground& ground, VertexId p, VertexId u, VertexId v) {
  return follow_gaps(ground, p, u, v, std::numeric_limits<std::size_t>::max()) == Light::Some;
}

bool SideSight::sees_side(const Ground& ground, VertexId p, VertexId u, VertexId v,
                          std::span<const HalfedgeId> edges) {
  const Light light = follow_gaps(ground, p, u, v, kGapsFree + edges.size());
  return light == Light::Unknown ? !covered(ground, p, u, v, edges) : light == Light::Some;
}

// The shadows in angular order: what they cover from v on, until u or a gap.
bool SideSight::covered(const Ground& ground, VertexId p, VertexId u, VertexId v,
                        std::span<const HalfedgeId> edges) {
  const Tin& tin = ground.tin();
  const Point2 from = ground.point(p), side_start = ground.point(u), side_end = ground.point(v);
  shadows_.clear();
  for (const HalfedgeId h : edges) {
    if (tin.origin(h) == p || tin.target(h) == p) continue;
    Point2 right = ground.point(tin.origin(h)), left = ground.point(tin.target(h));
    const int turn = orientation(from, right, left);
    if (turn == 0) continue;
    if (turn < 0) std::swap(right, left);
    if (place(from, side_start, side_end, right, left) != Place::Before) continue;
    if (const auto angle = intersect(from, {right, left}, {side_end, side_start})) shadows_.push_back(*angle);
  }
  std::sort(shadows_.begin(), shadows_.end(),
            [&](const Angle& a, const Angle& b) { return orientation(from, a.right, b.right) > 0; });
  Point2 reach = side_end;
  for (const Angle& shadow : shadows_) {
    if (orientation(from, reach, shadow.right) > 0) return false;
    if (orientation(from, reach, shadow.left) > 0) reach = shadow.left;
  }
  return orientation(from, reach, side_start) <= 0;
}

SideSight::Light SideSight::follow_gaps(const Ground& ground, VertexId p, VertexId u, VertexId v,
                                        std::size_t most) {
  const Tin& tin = ground.tin();
  const Point2 from = ground.point(p);
  const Point2 side_start = ground.point(u);
  const Point2 side_end = ground.point(v);
  open_.clear();
  for (const HalfedgeId h : tin.outgoing(p)) {
    const Angle face{ground.point(tin.target(h)), ground.point(tin.apex(h))};
    if (const auto angle = intersect(from, face, {side_end, side_start}))
      open_.push_back({Tin::next(h), *angle});
  }
  for (std::size_t steps = 0; !open_.empty(); ++steps) {
    if (steps == most) return Light::Unknown;
    const Gap gap = open_.back();
    open_.pop_back();
    const Point2 right = ground.point(tin.origin(gap.edge));
    const Point2 left = ground.point(tin.target(gap.edge));
    const Place where = place(from, side_start, side_end, right, left);
    if (where == Place::Beyond) return Light::Some;
    if (where == Place::Before && ground.blocks(gap.edge)) continue;
    const HalfedgeId entry = tin.twin(gap.edge);
    if (!entry.valid()) continue;
    const Point2 apex = ground.point(tin.apex(entry));
    const bool apex_left_of_right = orientation(from, gap.angle.right, apex) > 0;
    const bool apex_right_of_left = orientation(from, apex, gap.angle.left) > 0;
    const HalfedgeId right_exit = Tin::next(entry);
    const HalfedgeId left_exit = Tin::previous(entry);
    if (!apex_left_of_right) {
      open_.push_back({left_exit, gap.angle});
    } else if (!apex_right_of_left) {
      open_.push_back({right_exit, gap.angle});
    } else {
      open_.push_back({right_exit, {gap.angle.right, apex}});
      open_.push_back({left_exit, {apex, gap.angle.left}});
    }
  }
  return Light::None;
}

}  // namespace thalweg::detail
