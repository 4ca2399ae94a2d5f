#pragma once

/// Simplification: few vertices of a dense TIN from which all others are within a bound.
///
/// Based on: M. Garland, P. S. Heckbert, Fast Polygonal Approximation of Terrains and Height Fields, 1995
/// (greedy insertion); lines, outlines and the exact bound are ours.
///
/// Laws: (1) no vertex moves; constraint edges stay, vertex by vertex, and the outline stays the same set of
/// points; (2) the TIN is the constrained Delaunay triangulation of its vertices within its outline; (3)
/// stopped by the error, each vertex that is left out is vertically at most `max_error` from its triangle, in
/// exact arithmetic; (4) the vertices depend on positions and heights, not on ids or threads.

#include <thalweg/base/progress.hpp>
#include <thalweg/delaunay/triangulate.hpp>
#include <thalweg/mesh/tin.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace thalweg {

struct SimplifyOptions {
  /// Largest vertical distance of a vertex that is left out, in the TIN's unit of heights; at least 0.
  std::optional<double> max_error;
  /// Stop at so many vertices, lines and outline included.
  std::optional<std::size_t> max_vertices;
  /// Coordinates in which triangles must not be flat or turned over either, one a vertex; empty: the plane's.
  std::span<const Point2> written;
  TriangulationEngine engine = TriangulationEngine::Flat;  ///< of the vertices it starts with
};

/// Which limit ended the work.
enum class SimplifyStop : std::uint8_t {
  MaxError,     ///< all vertices left out are within max_error
  MaxVertices,  ///< max_vertices was reached, perhaps by lines and outline alone
  Exact         ///< no max_error was given, and all vertices left out lie on the surface
};

struct Simplified {
  Tin tin;
  std::vector<VertexId> kept;           ///< for each vertex of `tin` its id in the dense TIN, ascending
  std::vector<VertexId> left_out;       ///< the other vertices of the dense TIN, ascending
  std::vector<TriangleId> left_out_in;  ///< for each of these the triangle of `tin` that holds it
  std::size_t fixed = 0;                ///< vertices that lines and the outline need
  double max_error = 0;                 ///< of the vertices left out, rounded
  SimplifyStop stop = SimplifyStop::Exact;
  /// False: the outline is convex. True: it is not, and its edges are constraint edges, of kind Boundary
  /// where they were none.
  bool outlined = false;
};

/// Starts with the ends of all constraint edges and the corners of the outline, then inserts the vertex with
/// the largest error (equal ones: the first by (x, y)) until a limit is reached. At corners of triangles
/// that are flat or turned over as written, vertices nearby are inserted, even beyond max_vertices.
/// Pre: `dense` is constrained Delaunay within its outline; each vertex is in a triangle; at least one limit
/// is given. Throws: Error{Cancelled}. Complexity: about n log m expected, for m of n vertices kept.
Simplified simplify(const Tin& dense, const SimplifyOptions& options, Progress& progress);

}  // namespace thalweg
