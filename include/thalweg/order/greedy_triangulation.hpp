#pragma once

/// The greedy triangulation of an edge: the least change of a constrained Delaunay triangulation that
/// holds it.
///
/// Based on: R. I. Silveira, M. van Kreveld, Towards a Definition of Higher Order Constrained Delaunay
/// Triangulations, 2009, section 2 and Figure 6.

#include <thalweg/mesh/tin.hpp>
#include <thalweg/order/constrained_order.hpp>

#include <vector>

namespace thalweg {

/// What the greedy triangulation of an edge changes: the edge's hull, triangulated anew.
struct GreedyPatch {
  std::vector<TriangleId> removed;  ///< triangles of the ground that the edge crosses, from a to b
  std::vector<Triangle> triangles;  ///< counter-clockwise; as many as were removed
};

/// The patch of edge ab: on either side of ab, each triangle on an edge is the one whose circle holds no
/// vertex of the hull beyond it. Empty if ab is an edge of the ground.
/// Laws (tests): (1) patch and remaining triangles are the constrained Delaunay triangulation with ab as one
/// more constraint edge; (2) under Pathcon, and under Std without constraint edges, no triangle of the patch
/// has an order higher than both triangles at ab (Corollary 1); under ConfEdge and SeesOpp ab is useful at k
/// exactly if the patch has order at most k (Lemma 4).
/// Pre: a sees b, and no vertex lies between them. Complexity: quadratic in the triangles that ab crosses at
/// worst, m log m in practice.
GreedyPatch greedy_patch(const Tin& ground, VertexId a, VertexId b);

/// The whole greedy triangulation. Throws: Error{Usage} if a does not see b, if a vertex lies between them,
/// or a == b. Complexity: linear, and the patch.
Tin greedy_triangulation(const ConstrainedOrder& order, VertexId a, VertexId b);

}  // namespace thalweg
