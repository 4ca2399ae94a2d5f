#pragma once

/// The triangles that triangulations of an order can be made of, with their edges, and the faces into which
/// the edges that none of them crosses cut the ground.

#include <thalweg/base/progress.hpp>
#include <thalweg/order/order_triangles.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace thalweg::detail {

/// An edge of candidate triangles; a < b.
struct CandidateEdge {
  VertexId a;
  VertexId b;
  HalfedgeId ground;  ///< a halfedge of it in the ground; invalid: it is no edge there
  bool free = false;  ///< some candidate edge crosses it
};

/// Lists of numbers, one a row, end to end.
struct Rows {
  std::vector<std::uint32_t> first = {0};
  std::vector<std::uint32_t> items;
  [[nodiscard]] std::span<const std::uint32_t> row(std::size_t i) const {
    return std::span(items).subspan(first[i], first[i + 1] - first[i]);
  }
  [[nodiscard]] std::size_t size() const { return first.size() - 1; }
};

/// Candidates: of the given triangles those that have, beyond each side off the rim, another candidate.
/// Every triangulation that is made of the given triangles is made of candidates. An edge that is not free is
/// in each of them, for a triangulation without it would have an edge that crosses it. Faces are what the
/// edges that are not free leave; each triangulation is one of each face, and these do not know of each
/// other.
struct Candidates {
  std::vector<OrderTriangle> triangles;  ///< sorted
  std::vector<CandidateEdge> edges;      ///< sorted by ends
  /// For each triangle its sides from corner i to corner i + 1: twice the edge, plus 1 if it runs from b to
  /// a.
  std::vector<std::array<std::uint32_t, 3>> sides;
  Rows crossings;  ///< for each edge the free edges that it crosses, ascending
  Rows faces;      ///< for each face with a free edge: its candidate triangles, ascending
};

/// Pre: `triangles` are valid, sorted, counter-clockwise. Throws: Error{SizeLimit} if so many edges cross
/// each other that memory would not do; {Cancelled}. Complexity: sorting; the faces of the ground that edges
/// cross, and pairs of edges that meet in one face.
Candidates find_candidates(const Tin& ground, std::vector<OrderTriangle> triangles, const Progress& progress);

}  // namespace thalweg::detail
