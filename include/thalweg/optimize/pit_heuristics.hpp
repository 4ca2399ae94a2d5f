#pragma once

/// The published heuristics for few pits at higher orders, as baselines of the exact choice.
///
/// Based on: T. de Kok, M. van Kreveld, M. Loeffler, Generating realistic terrains with higher-order Delaunay
/// triangulations, 2007.

#include <thalweg/optimize/optimize_faces.hpp>

#include <cstdint>
#include <vector>

namespace thalweg {

enum class PitHeuristic : std::uint8_t {
  Flip,  ///< flips edges to lower ones
  Hull   ///< inserts edges that remove a pit, each into the Delaunay triangles that it crosses
};

/// Whether every triangle of `delaunay` is a candidate: under Std it may not be. Complexity: n log n.
bool can_remove_pits(const Tin& delaunay, const FixedFaces& faces);

/// A triangulation made of candidates of the faces, sorted, that a heuristic reaches from the Delaunay one.
///
/// Laws (tests): (1) it is a triangulation of the faces' order; (2) its pits are at most those of
/// `delaunay`, and no fewer than the optimum. The result depends on coordinates, not on ids.
/// Pre: as optimize_faces. Throws: Error{Unsupported} unless can_remove_pits; {Cancelled}. Complexity: n log
/// n, and under Hull the hulls of edges at pits.
std::vector<OrderTriangle> remove_pits(const Tin& delaunay, const FixedFaces& faces, PitHeuristic heuristic,
                                       const Progress& progress);

/// As optimize_faces, but the triangles, the values and `new_edges` are those of the heuristic. Bounds
/// (by themselves where a criterion before is not reached), and the counts of faces and labels, are those of
/// the exact choice, which is made for them. Criteria after
/// the first are what they happen to be: the heuristics do not look at them.
/// Throws: as optimize_faces and remove_pits; Error{Usage} if the first criterion is not local-minima, or a
/// sum of orders is to be minimised.
FaceOptimizeResult optimize_faces_by(PitHeuristic heuristic, const Tin& delaunay, const FixedFaces& faces,
                                     const FaceOptimizeOptions& options, Progress& progress);

}  // namespace thalweg
