#pragma once

/// Conflicts: which diagonals exclude which.
///
/// Based on: R. I. Silveira, M. van Kreveld, Towards a Definition of Higher Order Constrained Delaunay
/// Triangulations, 2009, section 6 and Figure 17.

#include <thalweg/base/progress.hpp>
#include <thalweg/mesh/tin.hpp>
#include <thalweg/order/fixed_faces.hpp>
#include <thalweg/order/quadrilaterals.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace thalweg {

/// Two quadrilaterals that share a triangle of the ground: their other diagonals cross in it, so at most one
/// of the two is flipped.
struct QuadrilateralConflict {
  std::uint32_t first;   ///< index into the list of quadrilaterals
  std::uint32_t second;  ///< index; first < second
  TriangleId shared;     ///< the triangle of the ground that is half of both
  auto operator<=>(const QuadrilateralConflict&) const = default;
};

/// All conflicts among quadrilaterals, sorted. None under Std ... SeesOpp. Under Sees3vtx and EmptyQuad they
/// form chains, trees and rings: a quadrilateral conflicts with at most four others, and three conflict with
/// each other only around a triangle.
///
/// Laws (tests): (1) flipping a set of quadrilaterals no two of which conflict gives a triangulation of order
/// at most 1, whose triangles are those of the ground that are in no flipped quadrilateral, and sut and tvs
/// of each flipped one; (2) these sets are all triangulations of order at most 1 that have no other edges
/// than those of the ground and the quadrilaterals' other diagonals. Under Sees3vtx and EmptyQuad there can
/// be further triangulations of order at most 1, with edges that cross several of the ground: an optimum over
/// flips need not be one over all. Under EmptyQuad this is so even without constraint edges.
/// find_edge_conflicts knows of all.
/// Pre: `quadrilaterals` is find_quadrilaterals(ground, ...). Complexity: linear.
std::vector<QuadrilateralConflict> find_conflicts(const Tin& ground,
                                                  std::span<const Quadrilateral> quadrilaterals);

/// Two edges that no triangulation holds both, though each is in one. a < b, c < d, (a, b) < (c, d).
struct EdgeConflict {
  VertexId a, b;
  VertexId c, d;
  bool crossing = true;  ///< false: they do not cross, but triangles of too high an order would be needed
  auto operator<=>(const EdgeConflict&) const = default;
};

struct EdgeConflicts {
  std::vector<EdgeConflict> pairs;  ///< sorted
  /// Faces with too many triangulations to list. Of their edges the pairs that cross are given, though some
  /// of these edges may be in no triangulation.
  std::size_t undecided_faces = 0;
};

/// Which edges exclude which, among all triangulations that are made of given triangles: those of order at
/// most k if `faces` comes from find_order_triangles.
///
/// Laws (tests), where no face is undecided: (1) a pair is listed exactly if each of the two is in a
/// triangulation, and none has both; (2) the edges that are listed are those that some but not all
/// triangulations have; each crosses another. Edges of different faces never exclude each other. Pairs do not
/// tell all: three edges of which no two conflict may still bound a triangle of too high an order.
/// Throws: Error{Cancelled}. Complexity: the triangulations of each face. Parallel; deterministic.
EdgeConflicts find_edge_conflicts(const FixedFaces& faces, const TriangulationListOptions& options,
                                  const Progress& progress);

}  // namespace thalweg
