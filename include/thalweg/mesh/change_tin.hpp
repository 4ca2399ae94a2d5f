#pragma once

/// TINs made of other ones: with other diagonals, other ids, fewer triangles.

#include <thalweg/mesh/tin.hpp>

#include <span>
#include <vector>

namespace thalweg {

struct FlippedTin {
  Tin tin;
  std::vector<HalfedgeId> diagonals;  ///< for each flipped edge one that took its place
};

/// The TIN in which each given interior, unconstrained edge is replaced by the other diagonal of its
/// quadrilateral; a TIN that is moved in gives its memory. Pre: no two of the edges bound the same triangle;
/// each quadrilateral is strictly convex. Throws: Error{InvalidTin} if a given edge is on the rim or
/// constrained. Complexity: linear.
FlippedTin flip_edges(Tin tin, std::span<const HalfedgeId> edges);

struct RenumberedTin {
  Tin tin;
  std::vector<TriangleId> place;  ///< for each triangle of the given TIN: which one it is now
};

/// The TIN where vertex v has the id number[v]; a TIN that is moved in gives its memory. Throws:
/// Error{InvalidTin} if the numbers are no permutation; Error{Cancelled}. Complexity: linear.
RenumberedTin renumber(Tin tin, std::span<const VertexId> number, const Progress& progress);

/// The TIN of the triangles for which `keep` is true; all vertices stay, with their ids. Constraint edges
/// that lose their last triangle are dropped. Pre: keep.size() == tin.triangle_count().
Tin keep_triangles(const Tin& tin, const std::vector<bool>& keep);
/// The same; a TIN that keeps all is passed on.
Tin keep_triangles(Tin&& tin, const std::vector<bool>& keep);

}  // namespace thalweg
