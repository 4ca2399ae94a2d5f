#pragma once

/// From a survey to its ground: the constrained Delaunay triangulation of all points and lines.
///
/// Laws: (1) input vertices never move, but for `snap`; (2) constraint edges meet only at vertices, no vertex
/// lies inside one, in exact arithmetic; (3) a line bends by less than `Ground::pixel`; (4) the triangles are
/// those of `triangulate`; (5) shuffled points and lines give the same ground but for ids, the rules First
/// and Last aside; (6) a height that is interpolated never leaves the range of the heights it comes from.

#include <thalweg/base/progress.hpp>
#include <thalweg/delaunay/triangulate.hpp>
#include <thalweg/mesh/ground_mode.hpp>
#include <thalweg/mesh/survey.hpp>
#include <thalweg/mesh/tin.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace thalweg {

/// The height of points that share a position. First and Last are meant in file order.
enum class DuplicateRule : std::uint8_t { First, Last, Lowest, Highest, Mean };

/// The height where lines with heights cross, touch, overlap or share a vertex, and disagree.
/// Auto: with a valley the lower (water must get through), else with a ridge the higher, else the mean.
/// Error: lines must not cross, touch or overlap inside an edge, whether they have heights or not, nor share
/// a vertex with different heights; a boundary or hole may cut other lines.
enum class CrossingRule : std::uint8_t { Auto, Error, Lower, Higher, Mean, First, Last };

/// How vertices get their ids. InOrder: by first appearance, as in every output. AlongCurve: along a
/// space-filling curve, so that neighbours are close in memory; `Ground::number` says what they are called.
enum class Numbering : std::uint8_t { InOrder, AlongCurve };

struct GroundOptions {
  DuplicateRule duplicates = DuplicateRule::First;
  /// Points at most so far from a representative are one with it; plane units. In order of (x, y) a point
  /// joins the first representative within reach, or becomes one. Line vertices take the position of the
  /// nearest point's representative within reach; the others are merged with each other in the same way.
  double snap = 0;
  CrossingRule crossing = CrossingRule::Auto;
  /// Least side of the snapping grid, 0 or a power of two, plane units: what the coordinates can tell, where
  /// that is more than the spacing of doubles in the plane (they were given in another frame).
  double resolution = 0;
  Numbering numbering = Numbering::InOrder;
  TriangulationEngine engine = TriangulationEngine::Flat;
};

/// Where a vertex of the ground comes from: what has its very position, first in the order of ids.
struct VertexOrigin {
  enum class Kind : std::uint8_t { Point, LineVertex, Crossing };
  Kind kind = Kind::Point;
  std::uint32_t index = 0;   ///< point, or line, in the survey; of a crossing: one of its lines
  std::uint32_t vertex = 0;  ///< vertex in the line; of a crossing: the vertex before it
};

struct Ground {
  /// Ids in order: points in file order, a duplicate with its first; then other line vertices in order of
  /// lines; then crossings by (x, y). In polygon mode only vertices of triangles have an id.
  Tin tin;
  std::vector<VertexOrigin> origins;     ///< one a vertex
  std::vector<VertexId> number;          ///< under Numbering::AlongCurve: for each vertex its id in order
  std::vector<VertexId> point_vertices;  ///< for each point of the survey; invalid: outside of the boundary
  std::vector<Conflict> conflicts;       ///< every height that disagrees at a vertex of the TIN, in order
  std::size_t duplicates_merged = 0;     ///< points that joined an earlier one
  std::size_t outside_boundary = 0;      ///< distinct points that were dropped
  std::size_t crossings = 0;             ///< vertices that are neither points nor line vertices
  std::size_t lakes = 0;                 ///< bodies of water; lakes that touch are one
  std::size_t points_in_lakes = 0;       ///< points whose height gave way to a lake's level
  double pixel = 0;                      ///< no line was moved so far; plane units; 0 without lines
  GroundMode mode = GroundMode::Hull;
};

/// Builds the ground of a survey. Lines with heights are hard: theirs beat those of points. Lines without are
/// soft: new vertices of theirs get the height of the Delaunay ground of all points and hard lines.
/// Lines of kind Boundary are closed rings; inside is what an odd number of those of a feature surrounds.
/// Lines of kind Hole are the rings of areas, one area a feature; what any of these surrounds is cut out.
/// Lines of kind Lake are the rings of lakes, one lake a feature: all vertices in it, shore included, get one
/// height: the lowest that its rings have, else the lowest of the vertices on its shore. Throws:
/// Error{BadCoordinate} not finite or beyond 1e15; {TooFewPoints}, {Collinear} no triangle exists;
/// {CrossingLines} under CrossingRule::Error; {OutsideHull} a soft vertex outside of that ground;
/// {WrongGeometry} an open ring; {TooClose} vertices too close for double arithmetic; {SizeLimit} lines cross
/// or overlap 2^26 times; {Cancelled}. Complexity: about n log n on real data; a crossing costs a vertex.
Ground build_ground(const Survey& survey, const GroundOptions& options, Progress& progress);
/// The same, and gives back the memory of the survey's points as soon as they are on the ground, which is
/// before it takes most memory itself; lines stay.
Ground build_ground(Survey&& survey, const GroundOptions& options, Progress& progress);

}  // namespace thalweg
