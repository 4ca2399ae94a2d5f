#pragma once

/// Which triangles stay when a TIN loses ground from its rim; the answers are masks for `keep_triangles`.
///
/// Laws: (1) the answer does not depend on the order of triangles; (2) a constraint edge keeps a triangle.

#include <thalweg/mesh/tin.hpp>

#include <functional>
#include <span>
#include <utility>
#include <vector>

namespace thalweg {

/// Drops, until none is left, each triangle that has a rim edge which is no constraint edge and for which
/// `goes` is true; edges of dropped triangles become rim. `goes` is asked with the halfedge of the triangle.
/// Where both triangles of a constraint edge could go at once, the one with the shorter longest edge stays.
/// Complexity: linear in the rim and in what is dropped.
std::vector<bool> drop_rim_triangles(const Tin& tin, const std::function<bool(HalfedgeId)>& goes);

/// As above: a rim edge goes if it is longer than `max_edge` (plane units).
std::vector<bool> drop_long_rim_triangles(const Tin& tin, double max_edge);

/// Drops the rim triangles that are flat or clockwise in the coordinates in which they will be written, one
/// position a vertex. Throws: Error{BadCrs} if such a triangle cannot go: it is interior, or the last one at
/// a constraint edge. The message names the place and offers --t-crs.
std::vector<bool> drop_turned_rim_triangles(const Tin& tin, std::span<const Point2> written);

/// Drops the triangles of which `outside` is true, wherever they are; law (2) does not hold here: a
/// constraint edge between two of them goes with them.
std::vector<bool> drop_outside_triangles(const Tin& tin, const std::function<bool(TriangleId)>& outside);

/// For each triangle whether it lies inside of an outline: directed edges, the inside to their left, of which
/// those that are edges of the TIN count. Complexity: linear.
std::vector<bool> inside_outline(const Tin& tin, std::span<const std::pair<VertexId, VertexId>> outline);

}  // namespace thalweg
