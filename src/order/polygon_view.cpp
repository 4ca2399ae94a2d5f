// A shrinking cone.
//
// Based on: El Gindy and Avis, A linear algorithm for computing the visibility polygon from a point, 1981,
// for the problem; the walk over a triangulation is Guibas et al., Linear-time algorithms for visibility and
// shortest path problems inside triangulated simple polygons, 1987, with a point as source.
//
// 1. The dual of a triangulated simple polygon is a tree, so a walk from the eye enters each face through one
//    edge only, and the part of that edge that the eye sees is one cone: it shrinks to what the next edge
//    leaves of it, and ends where that is nothing, at an edge that blocks, or at one that leaves the disc.
// 2. Every vertex lies on the rim and blocks: one strictly inside of the cone is seen, one on its border lies
//    behind another.
#include "order/polygon_view.hpp"

#include <algorithm>

namespace thalweg::detail {

std::optional<VertexId> PolygonView::advance(const Ground& ground, const Circumdisc& disc, Point2 from) {
  const Tin& tin = ground.tin();
  const Cone cone = open_.back();
  open_.pop_back();
  if (ground.blocks(cone.edge)) return std::nullopt;
  const Point2 right_end = ground.point(tin.origin(cone.edge));
  const Point2 left_end = ground.point(tin.target(cone.edge));
  if (disc.side(right_end) < 0 && disc.side(left_end) < 0 && !disc.passes(right_end, left_end)) {
    return std::nullopt;
  }
  const HalfedgeId entry = tin.twin(cone.edge);
  const VertexId apex = tin.apex(entry);
  const Point2 at = ground.point(apex);
  const bool left_of_right = orientation(from, cone.angle.right, at) > 0;
  const bool right_of_left = orientation(from, at, cone.angle.left) > 0;
  if (left_of_right) {
    open_.push_back({Tin::next(entry), {cone.angle.right, right_of_left ? at : cone.angle.left}});
  }
  if (right_of_left) {
    open_.push_back({Tin::previous(entry), {left_of_right ? at : cone.angle.right, cone.angle.left}});
  }
  return left_of_right && right_of_left ? std::optional(apex) : std::nullopt;
}

void PolygonView::follow(const Ground& ground, const Circumdisc& disc, Point2 from) {
  while (!open_.empty()) {
    if (const auto seen = advance(ground, disc, from)) visible_.push_back(*seen);
  }
}

std::span<const VertexId> PolygonView::look(const Ground& ground, const Circumdisc& disc, VertexId eye) {
  const Tin& tin = ground.tin();
  visible_.clear();
  open_.clear();
  for (const HalfedgeId h : tin.outgoing(eye)) {
    visible_.push_back(tin.target(h));
    if (tin.on_rim(Tin::previous(h))) visible_.push_back(tin.apex(h));
    open_.push_back({Tin::next(h), {ground.point(tin.target(h)), ground.point(tin.apex(h))}});
  }
  follow(ground, disc, ground.point(eye));
  return visible_;
}

}  // namespace thalweg::detail
