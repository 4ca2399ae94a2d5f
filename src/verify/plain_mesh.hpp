#pragma once

/// A mesh as the verifier sees it: arrays of numbers, edges found by sorting.

#include <thalweg/geometry/point.hpp>
#include <thalweg/mesh/edge_kind.hpp>

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace thalweg::verify {

/// Indices of vertices and triangles are bare 32-bit numbers in this module: it shares no type with the code
/// that it checks.
using Index = std::uint32_t;
using Corners = std::array<Index, 3>;
inline constexpr Index kNone = 0xffffffffU;

struct PlainMesh {
  std::vector<Point2> xy;  ///< in the plane of triangulation
  std::vector<double> z;
  std::vector<Point2> written;     ///< as in the file, where that is another plane; else empty
  std::vector<Corners> triangles;  ///< counter-clockwise
  /// Across side i (corner i to corner i + 1) of each triangle: the other triangle, or kNone.
  std::vector<std::array<Index, 3>> across;
  std::map<std::pair<Index, Index>, EdgeKind> constraints;  ///< lower index first
  std::vector<bool> on_valley;                              ///< by vertex: at a drawn valley

  [[nodiscard]] Point2 at(Index v) const { return xy[v]; }
  [[nodiscard]] bool constrained(Index a, Index b) const {
    return !constraints.empty() && constraints.contains(std::minmax(a, b));
  }
};

/// Fills `across`; what is wrong with the sides, if anything: "triangles 3 and 7 are on the same side of edge
/// 1-2".
std::optional<std::string> link_sides(PlainMesh& mesh);

/// Whether no vertex is on a side but its ends, no two triangles overlap and all are counter-clockwise; what
/// is wrong, if anything. Every vertex must be in a triangle. Complexity: linear on usual meshes.
std::optional<std::string> find_unsoundness(const PlainMesh& mesh);

}  // namespace thalweg::verify
