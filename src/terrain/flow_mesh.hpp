#pragma once

/// The triangles of a TIN, numbered so that what is near in the plane is near in memory.

#include "base/large_pages.hpp"
#include "base/prefetch.hpp"

#include <thalweg/base/progress.hpp>
#include <thalweg/mesh/tin.hpp>

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

namespace thalweg {

/// Vertices and triangles of a TIN under numbers of its own: the TIN's, where its edges join vertices of near
/// numbers, else new ones along a Hilbert curve. Triangles start at the same corner as in the TIN, so what is
/// computed of one has the same bits. Refers to the TIN.
class FlowMesh {
 public:
  /// Complexity: linear; on all threads.
  FlowMesh(const Tin& tin, const Progress& progress);
  FlowMesh(const FlowMesh&) = delete;
  FlowMesh& operator=(const FlowMesh&) = delete;
  ~FlowMesh() = default;

  [[nodiscard]] std::size_t vertex_count() const { return points_.size(); }
  [[nodiscard]] std::size_t triangle_count() const { return triangles_.size(); }
  [[nodiscard]] std::size_t halfedge_count() const { return 3 * triangles_.size(); }
  [[nodiscard]] Point2 point(VertexId v) const { return points_[v.index()]; }
  [[nodiscard]] double height(VertexId v) const { return heights_[v.index()]; }
  [[nodiscard]] const Triangle& triangle(TriangleId t) const { return triangles_[t.index()]; }
  [[nodiscard]] VertexId origin(HalfedgeId h) const { return triangles_[h.index() / 3][h.index() % 3]; }
  [[nodiscard]] VertexId target(HalfedgeId h) const { return origin(Tin::next(h)); }
  [[nodiscard]] VertexId apex(HalfedgeId h) const { return origin(Tin::previous(h)); }
  [[nodiscard]] HalfedgeId twin(HalfedgeId h) const { return twins_[h.index()]; }
  /// Asks for the memory that `twin` needs.
  void ask_for_twin(HalfedgeId h) const { prefetch(&twins_[h.index()]); }
  [[nodiscard]] bool on_rim(HalfedgeId h) const { return !twin(h).valid(); }
  [[nodiscard]] EdgeKind kind(HalfedgeId h) const { return tin_.kind(given(h)); }

  /// The TIN's number of what has a number here.
  [[nodiscard]] VertexId given(VertexId v) const { return same() ? v : given_vertex_[v.index()]; }
  [[nodiscard]] HalfedgeId given(HalfedgeId h) const {
    return same() ? h : HalfedgeId{3 * given_triangle_[h.index() / 3].index() + h.index() % 3};
  }
  /// The number here of what has a number in the TIN.
  [[nodiscard]] VertexId own(VertexId v) const { return same() ? v : own_vertex_[v.index()]; }
  [[nodiscard]] TriangleId own(TriangleId t) const { return same() ? t : own_triangle_[t.index()]; }
  [[nodiscard]] HalfedgeId own(HalfedgeId h) const {
    return same() ? h : HalfedgeId{3 * own_triangle_[h.index() / 3].index() + h.index() % 3};
  }
  /// True if the numbers are the TIN's.
  [[nodiscard]] bool same() const { return given_vertex_.empty(); }

  /// The halfedge that starts at v, a corner of the halfedge's triangle, and goes round it.
  [[nodiscard]] HalfedgeId out_of(VertexId v, HalfedgeId h) const {
    return origin(h) == v ? h : target(h) == v ? Tin::next(h) : Tin::previous(h);
  }
  /// Calls `visit(neighbour, halfedge of the edge)` for each neighbour, in no promised order; those on
  /// interior edges once. `h`: of any triangle at v. Pre: link_fans.
  template <class Visit>
  void for_each_neighbour(VertexId v, HalfedgeId h, const Visit& visit) const {
    const HalfedgeId first = first_of_fan(out_of(v, h));
    if (!on_rim(first)) return turn_from(first, visit);
    auto fan = std::ranges::lower_bound(more_fans_, v, {}, [this](HalfedgeId f) { return origin(f); });
    if (fan == more_fans_.end() || origin(*fan) != v) return turn_from(first, visit);
    for (; fan != more_fans_.end() && origin(*fan) == v; ++fan) turn_from(*fan, visit);
  }
  /// Notes at which vertices several fans of triangles meet. `rim`: all halfedges without twin.
  void link_fans(std::span<const HalfedgeId> rim);

 private:
  void number_vertices(const Progress& progress);
  void number_triangles(const Progress& progress);
  void link_triangles(const Progress& progress);
  /// Clockwise from `out` the last halfedge from its vertex, which is on the rim; or `out`, if none is.
  [[nodiscard]] HalfedgeId first_of_fan(HalfedgeId out) const {
    HalfedgeId h = out;
    while (!on_rim(h)) {
      h = Tin::next(twin(h));
      if (h == out) break;
    }
    return h;
  }
  /// Counter-clockwise through one fan. Pre: `start` is on the rim, or no halfedge of its vertex is.
  template <class Visit>
  void turn_from(HalfedgeId start, const Visit& visit) const {
    HalfedgeId h = start;
    do {
      visit(target(h), h);
      const HalfedgeId in = Tin::previous(h);
      if (on_rim(in)) return visit(origin(in), in);
      h = twin(in);
    } while (h != start);
  }

  const Tin& tin_;
  std::span<const Point2> points_;
  std::span<const double> heights_;
  std::span<const Triangle> triangles_;
  std::span<const HalfedgeId> twins_;
  RawVector<VertexId> given_vertex_, own_vertex_;
  RawVector<TriangleId> given_triangle_, own_triangle_;
  std::vector<HalfedgeId> more_fans_;  // by their origins: those on the rim from where several fans meet
  RawVector<Point2> moved_points_;
  RawVector<double> moved_heights_;
  RawVector<Triangle> moved_triangles_;
  RawVector<HalfedgeId> moved_twins_;
};

}  // namespace thalweg
