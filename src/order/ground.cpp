// Straight walks over a triangulation.
//
// 1. A sight line from vertex to vertex starts in the face around its start into which it points, or along an
//    edge.
// 2. It crosses faces by the sides on which their third vertices lie, until it meets a vertex: its end, or
//    one that blocks if a blocking edge ends there, and from which the walk goes on otherwise.
// 3. A blocking edge that it would cross ends it. An edge that overlaps it is one of the ground's, for
//    vertices lie only at ends of edges; if it blocks, so do its ends.
#include "order/ground.hpp"

#include "base/ordered_blocks.hpp"
#include "base/union_find.hpp"

#include <algorithm>
#include <span>

namespace thalweg::detail {

namespace {

/// Halfedges that are passed over together where none is of a constraint edge: few are.
constexpr std::size_t kAtOnce = 48;
constexpr std::size_t kBlock = 1024 * kAtOnce;

// For p, a, b collinear, both other than p: whether a and b lie on the same side of p.
bool same_direction(Point2 p, Point2 a, Point2 b) {
  return p.x != a.x ? (a.x > p.x) == (b.x > p.x) : (a.y > p.y) == (b.y > p.y);
}

bool in_angle_from_right(Point2 p, Angle angle, Point2 direction) {
  return orientation(p, angle.right, direction) >= 0 && orientation(p, direction, angle.left) > 0;
}

bool in_angle_to_left(Point2 p, Angle angle, Point2 direction) {
  return orientation(p, angle.right, direction) > 0 && orientation(p, direction, angle.left) >= 0;
}

}  // namespace

std::optional<Angle> intersect(Point2 p, Angle a, Angle b) {
  Angle common;
  if (in_angle_from_right(p, a, b.right)) {
    common.right = b.right;
  } else if (in_angle_from_right(p, b, a.right)) {
    common.right = a.right;
  } else {
    return std::nullopt;
  }
  common.left = in_angle_to_left(p, a, b.left) ? b.left : a.left;
  return common;
}

Ground::Ground(const Tin& tin, GroundMode mode)
    : tin_(&tin), mode_(mode), blocking_(tin.vertex_count(), false) {
  const std::span<const EdgeKind> kinds = tin.arrays().kinds;
  const Progress uncancelled;
  const auto list = [&](std::size_t first, std::size_t last, std::vector<HalfedgeId>& found) {
    for (std::size_t begin = first; begin < last; begin += kAtOnce) {
      const std::size_t end = std::min(last, begin + kAtOnce);
      unsigned constrained = 0;
      for (std::size_t i = begin; i < end; ++i) constrained |= static_cast<unsigned>(kinds[i]);
      if (constrained == 0 && mode == GroundMode::Hull) continue;
      for (std::size_t i = begin; i < end; ++i) {
        if (blocks(HalfedgeId{i})) found.emplace_back(i);
      }
    }
  };
  for (const HalfedgeId h : list_in_order<HalfedgeId>(kinds.size(), kBlock, uncancelled, list)) {
    any_blocks_ = true;
    blocking_[tin.origin(h).index()] = true;
    blocking_[tin.target(h).index()] = true;
  }
  simple_polygons_ = mode == GroundMode::Polygon && find_simple_polygons();
}

// Each vertex is on the rim, with a single fan, and each piece has one rim (Euler's formula).
bool Ground::find_simple_polygons() const {
  std::size_t vertices = 0;
  for (std::size_t v = 0; v < tin_->vertex_count(); ++v) {
    const auto fan = tin_->outgoing(VertexId{v});
    if (fan.empty()) continue;
    ++vertices;
    if (std::count_if(fan.begin(), fan.end(), [&](HalfedgeId h) { return tin_->on_rim(h); }) != 1)
      return false;
  }
  UnionFind pieces(tin_->triangle_count());
  std::size_t count = tin_->triangle_count();
  for (std::size_t i = 0; i < tin_->halfedge_count(); ++i) {
    const HalfedgeId h{i}, twin = tin_->twin(h);
    if (twin.valid() && pieces.unite(Tin::triangle_of(h).value(), Tin::triangle_of(twin).value())) --count;
  }
  return vertices + tin_->triangle_count() == tin_->edge_count() + count;
}

bool Ground::blocks_between(VertexId a, VertexId b) const {
  const HalfedgeId ab = tin_->find_halfedge(a, b), ba = tin_->find_halfedge(b, a);
  return (ab.valid() && blocks(ab)) || (ba.valid() && blocks(ba));
}

bool Ground::sees(VertexId p, VertexId q) const {
  for (VertexId at = p; at != q;) {
    const Step step = next_vertex(at, q);
    if (step.blocked || (step.at != q && blocks(step.at))) return false;
    at = step.at;
  }
  return true;
}

Ground::Step Ground::next_vertex(VertexId from, VertexId to) const {
  const Point2 p = point(from);
  const Point2 q = point(to);
  for (const HalfedgeId h : tin_->outgoing(from)) {
    const VertexId right = tin_->target(h);
    const VertexId left = tin_->apex(h);
    if (right == to || left == to) return {to, false};
    const int of_right = orientation(p, point(right), q);
    if (of_right == 0 && same_direction(p, point(right), q)) return {right, false};
    const int of_left = orientation(p, q, point(left));
    if (of_left == 0 && same_direction(p, point(left), q)) return {left, false};
    if (of_right > 0 && of_left > 0) return cross_faces(Tin::next(h), from, to);
  }
  return {to, true};
}

Ground::Step Ground::cross_faces(HalfedgeId edge, VertexId from, VertexId to) const {
  while (true) {
    if (blocks(edge) || tin_->on_rim(edge)) return {to, true};
    const HalfedgeId entry = tin_->twin(edge);
    const VertexId apex = tin_->apex(entry);
    if (apex == to) return {to, false};
    const int side = orientation(point(from), point(to), point(apex));
    if (side == 0) return {apex, false};
    edge = side > 0 ? Tin::next(entry) : Tin::previous(entry);
  }
}

std::optional<HalfedgeId> Ground::face_in_angle(VertexId v, VertexId right, VertexId left) const {
  const Point2 p = point(v);
  const Angle angle{point(right), point(left)};
  for (const HalfedgeId h : tin_->outgoing(v)) {
    if (intersect(p, {point(tin_->target(h)), point(tin_->apex(h))}, angle)) return h;
  }
  return std::nullopt;
}

HalfedgeId Ground::rim_from(VertexId v) const {
  for (const HalfedgeId h : tin_->outgoing(v)) {
    if (tin_->on_rim(h)) return h;
  }
  return {};
}

HalfedgeId Ground::rim_to(VertexId v) const {
  for (const HalfedgeId h : tin_->outgoing(v)) {
    if (tin_->on_rim(Tin::previous(h))) return Tin::previous(h);
  }
  return {};
}

}  // namespace thalweg::detail
