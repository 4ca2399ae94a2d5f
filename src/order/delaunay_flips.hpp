#pragma once

/// How far a triangulation is from the constrained Delaunay triangulation: which triangles flips leave alone.

#include <thalweg/base/progress.hpp>
#include <thalweg/mesh/tin.hpp>

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace thalweg::detail {

/// Whether constraint edges stay, as in the constrained Delaunay triangulation, or are flipped like others.
enum class FlipRule : std::uint8_t { KeepConstraints, FlipAll };

/// Whether the apex on the other side of h is inside of the circle of the triangle of h; false for an edge
/// that the rule keeps, and on the rim.
bool breaks_delaunay(const Tin& tin, HalfedgeId h, FlipRule rule);

/// Flips a triangulation into the (constrained) Delaunay triangulation of its vertices, beside the TIN.
class DelaunayFlips {
 public:
  /// Two triangles that one flip turned into two of the Delaunay triangulation.
  struct Flip {
    TriangleId left;      ///< a, b, c
    TriangleId right;     ///< b, a, d
    VertexId a, b, c, d;  ///< edge ab was flipped to cd
  };

  /// Pre: `broken` are all halfedges, one an edge, for which breaks_delaunay holds.
  DelaunayFlips(const Tin& tin, FlipRule rule, std::span<const HalfedgeId> broken);

  /// Flips until no edge is broken. False if more than `most` flips did not do: then nothing is known.
  /// Throws: Error{Cancelled}. Complexity: constant a flip; there can be quadratically many.
  bool run(std::size_t most, const Progress& progress);

  /// Whether a triangle of the TIN was never flipped: then it is one of the Delaunay triangulation.
  [[nodiscard]] bool kept(TriangleId t) const { return changes_[t.index()] == 0; }
  /// The pairs of triangles that were flipped into each other's place once, and not again.
  [[nodiscard]] std::vector<Flip> single_flips() const;
  /// Whether, in the Delaunay triangulation, no neighbour of d but a, b, c lies in the circle of a, b, c; and
  /// the same for c and the circle of b, a, d.
  [[nodiscard]] bool alone_inside_left(const Flip& flip) const;
  [[nodiscard]] bool alone_inside_right(const Flip& flip) const;

 private:
  [[nodiscard]] VertexId origin(HalfedgeId h) const { return corners_[h.index() / 3][h.index() % 3]; }
  [[nodiscard]] VertexId apex(HalfedgeId h) const { return origin(Tin::previous(h)); }
  [[nodiscard]] bool broken(HalfedgeId h) const;
  void flip(HalfedgeId h);
  void place(HalfedgeId h, HalfedgeId twin, bool kept);
  [[nodiscard]] bool alone(const Triangle& circle, HalfedgeId first, HalfedgeId last) const;

  const Tin* tin_;
  std::vector<Triangle> corners_;
  std::vector<HalfedgeId> twins_;
  std::vector<std::uint8_t> keeps_;    ///< for each halfedge: its edge is never flipped
  std::vector<std::uint8_t> changes_;  ///< for each triangle: flips that changed it, at most 2 counted
  std::vector<HalfedgeId> pending_;
  std::vector<Flip> first_flips_;  ///< of two triangles that had not changed before
};

}  // namespace thalweg::detail
