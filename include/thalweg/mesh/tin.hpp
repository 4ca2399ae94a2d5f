#pragma once

/// The triangulated irregular network: flat arrays, immutable once built.

#include <thalweg/base/id.hpp>
#include <thalweg/base/lazy.hpp>
#include <thalweg/base/progress.hpp>
#include <thalweg/base/raw_vector.hpp>
#include <thalweg/geometry/point.hpp>
#include <thalweg/mesh/edge_kind.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace thalweg {

using Triangle = std::array<VertexId, 3>;

/// An edge that every triangulation keeps, between two vertices, in either order.
struct ConstraintEdge {
  VertexId a;
  VertexId b;
  EdgeKind kind = EdgeKind::Breakline;
};

/// Triangles as a TIN holds them: sorted, each from its smallest id on, with their neighbours.
struct LinkedTriangles {
  RawVector<Triangle> corners;  ///< counter-clockwise
  RawVector<HalfedgeId> twins;  ///< for each halfedge the one on the other side; invalid on the rim
  RawVector<EdgeKind> kinds;    ///< for each halfedge
  std::size_t edge_count = 0;
};

/// A TIN as plain arrays that others own, sound or not; what is not at hand stays empty.
struct TinArrays {
  std::span<const Point2> points;
  std::span<const double> heights;
  std::span<const Triangle> triangles;
  std::span<const ConstraintEdge> constraints;
  std::span<const HalfedgeId> twins;  ///< for each halfedge
  std::span<const EdgeKind> kinds;    ///< for each halfedge
};

/// A triangulation of points with heights.
///
/// Frame: the plane of triangulation; the owner knows its unit and CRS. Triangles are counter-clockwise seen
/// from above, start at their smallest vertex id, and are sorted, so equal input gives equal bytes.
/// A vertex may be in no triangle. The surface need not be convex or connected; at a vertex several fans may
/// meet. Halfedge h = 3 t + i runs from corner i of triangle t to corner (i + 1) % 3, triangle t to its left.
/// Memory: about 80 bytes a vertex, and 28 more from the time on when fans are first asked for.
class Tin {
 public:
  Tin() = default;
  /// Takes vertices and triangles (counter-clockwise, any order and start) and the constraint edges.
  /// Throws: Error{InvalidTin} if an id is out of range or repeated in a triangle, if two triangles lie on
  /// the same side of an edge, or if a constraint edge is no edge of any triangle; Error{SizeLimit} for more
  /// than 2^30 - 1 triangles or vertices. Complexity: linear for bounded vertex degree.
  Tin(std::vector<Point2> points, std::vector<double> heights, std::vector<Triangle> triangles,
      std::span<const ConstraintEdge> constraints);
  /// Takes triangles that are sorted and linked; nothing of that is checked. Complexity: constant.
  Tin(std::vector<Point2> points, std::vector<double> heights, LinkedTriangles triangles);

  [[nodiscard]] std::size_t vertex_count() const { return points_.size(); }
  [[nodiscard]] std::size_t triangle_count() const { return triangles_.size(); }
  [[nodiscard]] std::size_t halfedge_count() const { return 3 * triangles_.size(); }
  /// Number of edges, each counted once. Complexity: constant.
  [[nodiscard]] std::size_t edge_count() const { return edge_count_; }

  [[nodiscard]] std::span<const Point2> points() const { return points_; }
  [[nodiscard]] std::span<const double> heights() const { return heights_; }
  [[nodiscard]] std::span<const Triangle> triangles() const { return triangles_; }
  [[nodiscard]] Point2 point(VertexId v) const { return points_[v.index()]; }
  [[nodiscard]] double height(VertexId v) const { return heights_[v.index()]; }
  [[nodiscard]] const Triangle& triangle(TriangleId t) const { return triangles_[t.index()]; }

  [[nodiscard]] static HalfedgeId halfedge(TriangleId t, std::size_t side) {
    return HalfedgeId{3 * t.index() + side};
  }
  [[nodiscard]] static TriangleId triangle_of(HalfedgeId h) { return TriangleId{h.index() / 3}; }
  [[nodiscard]] static HalfedgeId next(HalfedgeId h) {
    return HalfedgeId{h.index() % 3 == 2 ? h.index() - 2 : h.index() + 1};
  }
  [[nodiscard]] static HalfedgeId previous(HalfedgeId h) {
    return HalfedgeId{h.index() % 3 == 0 ? h.index() + 2 : h.index() - 1};
  }
  [[nodiscard]] VertexId origin(HalfedgeId h) const { return triangles_[h.index() / 3][h.index() % 3]; }
  [[nodiscard]] VertexId target(HalfedgeId h) const { return origin(next(h)); }
  /// The third corner of the halfedge's triangle.
  [[nodiscard]] VertexId apex(HalfedgeId h) const { return origin(previous(h)); }
  /// The halfedge on the other side; invalid on the rim.
  [[nodiscard]] HalfedgeId twin(HalfedgeId h) const { return twins_[h.index()]; }
  [[nodiscard]] bool on_rim(HalfedgeId h) const { return !twins_[h.index()].valid(); }
  [[nodiscard]] EdgeKind kind(HalfedgeId h) const { return kinds_[h.index()]; }
  [[nodiscard]] bool constrained(HalfedgeId h) const { return kinds_[h.index()] != EdgeKind::None; }
  /// True for the one halfedge that stands for its edge (the lower of the two).
  [[nodiscard]] bool represents_edge(HalfedgeId h) const { return !twin(h).valid() || h < twin(h); }
  /// All halfedges that start at v, in no promised order. The first call, by whatever thread, lists those of
  /// all vertices; so does that of `find_halfedge`.
  [[nodiscard]] std::span<const HalfedgeId> outgoing(VertexId v) const {
    const Fans& all = fans();
    return std::span(all.outgoing)
        .subspan(all.first[v.index()], all.first[v.index() + 1] - all.first[v.index()]);
  }
  /// The halfedge from a to b, or an invalid id. Complexity: at most logarithmic in the degree of a.
  [[nodiscard]] HalfedgeId find_halfedge(VertexId a, VertexId b) const;
  /// For each vertex: 1 if it is in a triangle, else 0. Complexity: linear; runs on all threads.
  [[nodiscard]] std::vector<std::uint8_t> vertices_in_triangles() const;
  /// For each vertex: true if it lies on the rim, or in no triangle. Complexity: linear.
  [[nodiscard]] std::vector<bool> rim_vertices() const;
  /// What the TIN is made of (without `constraints`: `kinds` says the same). Valid as long as the TIN.
  [[nodiscard]] TinArrays arrays() const { return {points_, heights_, triangles_, {}, twins_, kinds_}; }
  /// The constraint edges, a < b, sorted. Complexity: linear.
  [[nodiscard]] std::vector<ConstraintEdge> constraint_edges() const;
  /// The same TIN with other heights. Throws: Error{InvalidTin} unless there is one a vertex. Complexity: a
  /// copy.
  [[nodiscard]] Tin with_heights(std::vector<double> heights) const;

 private:
  friend struct FlippedTin flip_edges(Tin tin, std::span<const HalfedgeId> edges);
  friend struct RenumberedTin renumber(Tin tin, std::span<const VertexId> number, const Progress& progress);
  /// Halfedges by their origin.
  struct Fans {
    std::vector<std::uint32_t> first;  ///< for each vertex where its part of `outgoing` starts; then its end
    RawVector<HalfedgeId> outgoing;
  };
  const Fans& fans() const {
    return fans_.get([this] { return list_fans(); });
  }
  [[nodiscard]] Fans list_fans() const;
  void link_halfedges();
  void mark_constraints(std::span<const ConstraintEdge> constraints);

  std::vector<Point2> points_;
  std::vector<double> heights_;
  RawVector<Triangle> triangles_;
  RawVector<HalfedgeId> twins_;
  RawVector<EdgeKind> kinds_;
  std::size_t edge_count_ = 0;
  Lazy<Fans> fans_;
};

}  // namespace thalweg
