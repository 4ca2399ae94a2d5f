#pragma once

/// The ground of orders: a triangulation with what blocks on it, and straight walks over it.

#include <thalweg/geometry/predicates.hpp>
#include <thalweg/mesh/ground_mode.hpp>
#include <thalweg/mesh/tin.hpp>
#include <thalweg/order/definition.hpp>

#include <optional>
#include <vector>

namespace thalweg::detail {

class Ground {
 public:
  Ground(const Tin& tin, GroundMode mode);

  [[nodiscard]] const Tin& tin() const { return *tin_; }
  [[nodiscard]] GroundMode mode() const { return mode_; }
  [[nodiscard]] Point2 point(VertexId v) const { return tin_->point(v); }
  /// Whether an edge blocks paths and sight: a constraint edge, or the rim of a polygon.
  [[nodiscard]] bool blocks(HalfedgeId h) const {
    return tin_->constrained(h) || (mode_ == GroundMode::Polygon && tin_->on_rim(h));
  }
  /// Whether an edge that blocks joins two vertices.
  [[nodiscard]] bool blocks_between(VertexId a, VertexId b) const;
  /// Whether a vertex is an end of an edge that blocks.
  [[nodiscard]] bool blocks(VertexId v) const { return blocking_[v.index()]; }
  [[nodiscard]] bool any_blocks() const { return any_blocks_; }
  /// Whether the ground is one simple polygon, or several apart, with no vertex inside, so that the dual of
  /// each is a tree. Only in mode Polygon.
  [[nodiscard]] bool simple_polygons() const { return simple_polygons_; }

  /// See ConstrainedOrder::sees.
  [[nodiscard]] bool sees(VertexId p, VertexId q) const;
  /// A halfedge of v whose face overlaps the open angle from direction v -> right counter-clockwise to v ->
  /// left. Pre: v, right, left counter-clockwise. None if the ground does not reach into the angle.
  [[nodiscard]] std::optional<HalfedgeId> face_in_angle(VertexId v, VertexId right, VertexId left) const;
  /// The rim halfedges that start and that end in v. Pre: v lies on the rim of a convex ground.
  [[nodiscard]] HalfedgeId rim_from(VertexId v) const;
  [[nodiscard]] HalfedgeId rim_to(VertexId v) const;

 private:
  struct Step {
    VertexId at;
    bool blocked = false;
  };
  [[nodiscard]] bool find_simple_polygons() const;
  [[nodiscard]] Step next_vertex(VertexId from, VertexId to) const;
  [[nodiscard]] Step cross_faces(HalfedgeId edge, VertexId from, VertexId to) const;

  const Tin* tin_;
  GroundMode mode_;
  std::vector<bool> blocking_;
  bool any_blocks_ = false;
  bool simple_polygons_ = false;
};

/// An open angle of less than 180 degrees at p: from direction p -> right counter-clockwise to p -> left.
struct Angle {
  Point2 right;
  Point2 left;
};

/// The common part of two angles at p, or none if it is empty.
std::optional<Angle> intersect(Point2 p, Angle a, Angle b);

}  // namespace thalweg::detail
