#pragma once

/// Conflicts of the first-order structure: which diagonals exclude which.
///
/// Based on: R. I. Silveira, M. van Kreveld, Towards a Definition of Higher Order Constrained Delaunay
/// Triangulations, 2009, section 6 and Figure 17.

#include <thalweg/mesh/tin.hpp>
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
/// Pre: `quadrilaterals` is find_quadrilaterals(ground, ...). Complexity: linear.
std::vector<QuadrilateralConflict> find_conflicts(const Tin& ground,
                                                  std::span<const Quadrilateral> quadrilaterals);

}  // namespace thalweg
