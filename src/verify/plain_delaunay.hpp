#pragma once

/// The constrained Delaunay triangulation by flips, and the first-order quadrilaterals by trying every edge.

#include "verify/plain_mesh.hpp"
#include "verify/plain_orders.hpp"

#include <thalweg/base/progress.hpp>

#include <vector>

namespace thalweg::verify {

/// Flips edges that are neither constrained nor on the rim until every one is locally Delaunay under the tie
/// rule (Lawson 1977): the constrained Delaunay triangulation of what the mesh covers, its rim held.
/// Pre: the mesh is sound. Complexity: n + flips.
PlainMesh flip_to_delaunay(PlainMesh mesh, Progress& progress);

/// A convex quadrilateral s, u, t, v counter-clockwise with the Delaunay diagonal uv, whose other diagonal st
/// makes two triangles of order at most 1, convex in the written coordinates, too; and the two triangles that
/// it consists of.
struct PlainQuadrilateral {
  Index s, u, t, v;
  Index left, right;  ///< triangles u, v, s and v, u, t of the Delaunay mesh
};

/// All of them, in the order of their triangles.
std::vector<PlainQuadrilateral> find_quadrilaterals(const PlainMesh& delaunay, const PlainOrders& orders,
                                                    Progress& progress);

/// The mesh with the other diagonal where `flipped` says so. Pre: no two quadrilaterals share a triangle.
PlainMesh with_diagonals(PlainMesh delaunay, const std::vector<PlainQuadrilateral>& quadrilaterals,
                         const std::vector<bool>& flipped);

}  // namespace thalweg::verify
