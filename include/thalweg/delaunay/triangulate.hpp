#pragma once

/// The constrained Delaunay triangulation of vertices that are fit for it already.

#include <thalweg/base/progress.hpp>
#include <thalweg/mesh/tin.hpp>

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace thalweg {

/// Who triangulates; the triangulation is the same.
enum class TriangulationEngine : std::uint8_t {
  Flat,  ///< our own: flat arrays, all threads
  Cgal   ///< CGAL's Constrained_Delaunay_triangulation_2, as a check
};

/// "flat" or "cgal".
std::string_view engine_name(TriangulationEngine engine);

/// Triangulates the convex hull of the points such that every constraint edge is an edge, and every other
/// edge is locally Delaunay under the tie rule of `in_circle_perturbed`: there is exactly one such
/// triangulation. Pre: points distinct and finite; constraint edges meet only at their ends, and hold no
/// other vertex; an edge may be given several times (its kinds add up). Throws: Error{TooFewPoints} fewer
/// than three points; {Collinear}; {InvalidTin} the constraint edges break the precondition; {Cancelled}.
/// Complexity: n log n in practice; runs on all threads.
Tin triangulate(std::vector<Point2> points, std::vector<double> heights,
                std::span<const ConstraintEdge> constraints, Progress& progress,
                TriangulationEngine engine = TriangulationEngine::Flat);

}  // namespace thalweg
