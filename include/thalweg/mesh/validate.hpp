#pragma once

/// The laws of a TIN, checked exactly.

#include <thalweg/mesh/tin.hpp>

#include <span>
#include <string>
#include <vector>

namespace thalweg {

/// Numbers of the laws that a TIN can break; fixed, for scripts.
namespace violation {
/// A coordinate or height is not finite, or 1e100 and more.
inline constexpr int kNotFinite = 101;
/// Two vertices share a position.
inline constexpr int kSamePosition = 102;
/// A triangle repeats a vertex, or names one that does not exist.
inline constexpr int kBadTriangle = 103;
/// A triangle does not start at its smallest id, or is out of order.
inline constexpr int kNotCanonical = 104;
/// A triangle is flat or clockwise in the plane.
inline constexpr int kNotCounterClockwise = 105;
/// A triangle is flat or clockwise in the written coordinates.
inline constexpr int kTurnedInWritten = 106;
/// Two triangles lie on the same side of an edge.
inline constexpr int kSameSide = 107;
/// A vertex lies on an edge or triangle that is not its own.
inline constexpr int kVertexOnSurface = 108;
/// Triangles overlap in the plane.
inline constexpr int kOverlap = 109;
/// Triangles overlap or touch in the written coordinates.
inline constexpr int kOverlapInWritten = 110;
/// A constraint edge is no edge of a triangle, so it is crossed.
inline constexpr int kConstraintNoEdge = 111;
/// A halfedge's twin is not the other side of its edge.
inline constexpr int kTwinWrong = 112;
/// The two sides of an edge differ in kind.
inline constexpr int kKindsDiffer = 113;
/// A vertex is in no triangle (only if asked).
inline constexpr int kIsolatedVertex = 115;
/// Parallel arrays differ in length.
inline constexpr int kLengthsDiffer = 116;
}  // namespace violation

/// One broken law and where.
struct Violation {
  int code = 0;      ///< one of the numbers above
  std::string what;  ///< one line that names vertices, edges or triangles by id
};

/// Whether a vertex that is in no triangle breaks a law; a Tin may hold such vertices.
enum class IsolatedVertices { Allow, Report };

/// Everything that is wrong with a TIN; empty if nothing is. `written_xy`, if given, holds for each vertex
/// the coordinates with which it will be written, in which the TIN must be valid too. At most 20 violations
/// of a code are listed, then one line that says how many more there are. Overlap is looked for only where
/// all triangles are sound otherwise (103, 105 or 106, 107). Complexity: linear plus r log r for r rim edges,
/// and n log n if anything is wrong; runs on all threads.
std::vector<Violation> validate(const Tin& tin, std::span<const Point2> written_xy = {},
                                IsolatedVertices isolated = IsolatedVertices::Allow);

/// The same for plain arrays, which may break any law. Arrays that are left empty are not checked, apart from
/// points, heights and triangles.
std::vector<Violation> validate(const TinArrays& arrays, std::span<const Point2> written_xy = {},
                                IsolatedVertices isolated = IsolatedVertices::Allow);

}  // namespace thalweg
