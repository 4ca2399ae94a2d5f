#pragma once

/// First-order structure: the quadrilaterals whose diagonal is free at order 1.

#include <thalweg/base/progress.hpp>
#include <thalweg/mesh/ground_mode.hpp>
#include <thalweg/mesh/tin.hpp>
#include <thalweg/order/definition.hpp>

#include <vector>

namespace thalweg {

/// A strictly convex quadrilateral of two triangles of the constrained Delaunay triangulation.
/// Corners s, u, t, v run counter-clockwise; uv is its Delaunay diagonal, st the other one.
struct Quadrilateral {
  VertexId s;
  VertexId u;
  VertexId t;
  VertexId v;
  HalfedgeId diagonal;  ///< the lower halfedge of edge uv: from u to v, apex s; its twin has apex t
  bool operator==(const Quadrilateral&) const = default;
};

struct QuadrilateralOptions {
  OrderDefinition definition = OrderDefinition::SeesOpp;
  GroundMode mode = GroundMode::Hull;
};

/// The quadrilaterals whose other triangulation, triangles sut and tvs, has order at most 1; ascending by
/// diagonal.
///
/// Laws, under Std, Pathcon, SeesTriang, SeesVtx, ConfEdge and SeesOpp (the paper's Lemma 7): (1) interiors
/// are disjoint; (2) every triangulation of order at most 1 consists of the edges that are no diagonal here,
/// and of one diagonal of each quadrilateral, and each such choice has order at most 1. Under Std there is
/// such a triangulation only if the constrained Delaunay triangulation itself has order at most 1; if not,
/// the list is empty. Under Sees3vtx and EmptyQuad quadrilaterals may share triangles, only one of which can
/// then be flipped, and further edges can be free as well. Pre: `ground` is the constrained Delaunay
/// triangulation of all its vertices (tie rule of in_circle_perturbed), covering the convex hull in mode
/// Hull. Throws: Error{Cancelled}. Complexity: linear in practice: the degrees of u and v for each edge, and
/// a flood of the disc near constraint edges. Deterministic, parallel.
std::vector<Quadrilateral> find_quadrilaterals(const Tin& ground, const QuadrilateralOptions& options,
                                               const Progress& progress);

}  // namespace thalweg
