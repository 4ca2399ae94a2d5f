// What sees a triangle, and conflicting edges, from the triangle outward.
//
// 1. SeesTriang counts the vertices on which light falls from the open side beyond which they lie
//    (side_view.cpp).
// 2. Under ConfEdge a vertex p counts if it sees the corner opposite, or a vertex r inside beyond another
//    side: a segment from cap to cap always crosses the interior. It crosses both sides, so light from them
//    falls on p and r.
// 3. Of the two, one at least lies beyond one of the two shorter sides. So it is enough to find all on which
//    light falls from these, and what they see through the longest side (corner_views.cpp). Where a disc is
//    large the triangle is flat, and the caps beyond the shorter sides are small: they hold nothing mostly.
// 4. What is seen is few vertices, however much the disc holds, where edges block all around.
#include "order/side_count.hpp"

#include <algorithm>
#include <iterator>

namespace thalweg::detail {

namespace {

/// Under ConfEdge: faces on the ways of light from one side, and vertices beyond it, from which on a flood
/// costs less: a look from each vertex may take as many faces as the light.
constexpr std::size_t kMostFaces = 4096;
constexpr std::size_t kMostLit = 64;

double length_square(Point2 a, Point2 b) {
  return (b.x - a.x) * (b.x - a.x) + (b.y - a.y) * (b.y - a.y);
}

}  // namespace

void SideCount::add(VertexId v) {
  if (std::find(counted_.begin(), counted_.end(), v) == counted_.end()) counted_.push_back(v);
}

// False if light goes far: then it finds some only.
bool SideCount::look_from_side(const Ground& ground, const Triangle& corners, std::size_t side,
                               std::size_t most_faces) {
  std::vector<VertexId>& lit = lit_[side];
  lit.clear();
  const VertexId u = corners[side], v = corners[(side + 1) % 3];
  if (ground.blocks_between(u, v)) return true;
  const Point2 at_u = ground.point(u), at_v = ground.point(v);
  const Circumdisc disc(at_u, at_v, ground.point(corners[(side + 2) % 3]));
  const auto seen = side_view_.look(ground, disc, u, v, most_faces);
  std::copy_if(seen.begin(), seen.end(), std::back_inserter(lit), [&](VertexId p) {
    return orientation(at_u, at_v, ground.point(p)) < 0 && disc.holds(ground.point(p));
  });
  std::sort(lit.begin(), lit.end());
  lit.erase(std::unique(lit.begin(), lit.end()), lit.end());
  return !side_view_.gave_up();
}

// False if that goes far.
bool SideCount::look_through_longest(const Ground& ground, const Triangle& corners, VertexId eye,
                                     std::size_t limit) {
  views_.start_through(ground, corners, longest_, eye);
  while (const auto view = views_.next()) {
    add(eye);
    add(view->seen);
    if (counted_.size() > limit) return true;
  }
  return !views_.gave_up();
}

std::optional<std::span<const VertexId>> SideCount::lit(const Ground& ground, const Triangle& corners,
                                                        std::size_t limit, std::size_t most_faces) {
  counted_.clear();
  for (std::size_t side = 0; side < 3 && counted_.size() <= limit; ++side) {
    const bool complete = look_from_side(ground, corners, side, most_faces);
    counted_.insert(counted_.end(), lit_[side].begin(), lit_[side].end());
    if (!complete && counted_.size() <= limit) return std::nullopt;
  }
  return counted_;
}

std::optional<std::span<const VertexId>> SideCount::conflicting(const Ground& ground, const Triangle& corners,
                                                                std::span<const VertexId> by_corners,
                                                                std::size_t limit) {
  counted_.assign(by_corners.begin(), by_corners.end());
  const auto length = [&](std::size_t side) {
    return length_square(ground.point(corners[side]), ground.point(corners[(side + 1) % 3]));
  };
  longest_ = length(0) < length(1) ? 1 : 0;
  if (length(longest_) < length(2)) longest_ = 2;
  const std::size_t one = (longest_ + 1) % 3, other = (longest_ + 2) % 3;
  for (const std::size_t side : {one, other}) {
    if (!look_from_side(ground, corners, side, kMostFaces) || lit_[side].size() > kMostLit)
      return std::nullopt;
  }
  for (const VertexId p : lit_[one]) {
    for (const VertexId r : lit_[other]) {
      if (!ground.sees(p, r)) continue;
      add(p);
      add(r);
      if (counted_.size() > limit) return counted_;
    }
  }
  if (ground.blocks_between(corners[longest_], corners[one])) return counted_;
  for (const std::size_t side : {one, other}) {
    for (const VertexId eye : lit_[side]) {
      if (!look_through_longest(ground, corners, eye, limit)) return std::nullopt;
      if (counted_.size() > limit) return counted_;
    }
  }
  return counted_;
}

}  // namespace thalweg::detail
