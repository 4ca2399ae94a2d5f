#pragma once

/// The fixed-edge subdivision: what all triangulations of an order have in common, and where they differ.

#include <thalweg/base/progress.hpp>
#include <thalweg/mesh/tin.hpp>
#include <thalweg/order/face_fronts.hpp>
#include <thalweg/order/order_triangles.hpp>

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace thalweg {

/// Lists of numbers, one a row, end to end.
struct Rows {
  std::vector<std::uint32_t> first = {0};
  std::vector<std::uint32_t> items;
  [[nodiscard]] std::span<const std::uint32_t> row(std::size_t i) const {
    return std::span(items).subspan(first[i], first[i + 1] - first[i]);
  }
  [[nodiscard]] std::size_t size() const { return first.size() - 1; }
};

/// An edge of candidate triangles; a < b.
struct CandidateEdge {
  VertexId a;
  VertexId b;
  HalfedgeId ground;  ///< a halfedge of it in the ground; invalid: it is no edge there
  bool free = false;  ///< some candidate edge crosses it
};

/// Candidate triangles, of which triangulations are made, and the faces into which edges that no candidate
/// edge crosses cut the ground. Such an edge is fixed: every triangulation made of candidates has it, for one
/// without it would have an edge that crosses it. Each triangulation is one of each face, and these do not
/// know of each other. A face may touch itself in a vertex, hold fixed edges that dangle, and hold vertices.
struct FixedFaces {
  std::vector<Point2> points;            ///< by vertex
  std::vector<OrderTriangle> triangles;  ///< candidates, sorted
  std::vector<CandidateEdge> edges;      ///< sorted by ends
  /// For each triangle its sides from corner i to corner i + 1: twice the edge, plus 1 if it runs from b to
  /// a.
  std::vector<std::array<std::uint32_t, 3>> sides;
  Rows crossings;  ///< for each edge the free edges that it crosses, ascending
  Rows faces;      ///< for each face with a free edge: its candidate triangles, ascending
  /// By face: what find_fronts gives, or no fronts where that was more work than allowed, or its triangles
  /// were others at first.
  std::vector<FrontGraph> fronts;
};

struct FixedFaceOptions {
  /// Work allowed on each face, in edges of fronts: a count, so the answer is the same everywhere. A face
  /// beyond it keeps candidates that may be in no triangulation, and edges may be free that need not be.
  std::size_t work_limit = 500'000;
};

/// The subdivision for the triangulations that can be made of the given triangles; none if there are none.
///
/// With the triangles that find_order_triangles gives for k these are the triangulations of order at most k.
/// Laws (tests): (1) a triangle is a candidate exactly if some triangulation has it; (2) an edge of
/// candidates is fixed exactly if every triangulation has it; (3) one triangulation of each face and the
/// triangles without free side are a triangulation, and each is such a choice. Pre: `surface` is a
/// triangulation of all vertices in it; the triangles are valid, sorted, counter-clockwise from the smallest
/// id, and lie on the surface. Throws: Error{SizeLimit} if too many edges cross each other; {Cancelled}.
/// Complexity: sorting, pairs of edges that cross, fronts of faces. Parallel; deterministic.
std::optional<FixedFaces> find_fixed_faces(const Tin& surface, std::vector<OrderTriangle> triangles,
                                           const FixedFaceOptions& options, const Progress& progress);

/// Those of the triangles that lie on the surface, a part of the ground on which they are valid.
/// Complexity: the triangles of the surface that they overlap.
std::vector<OrderTriangle> keep_on_surface(const Tin& surface, std::vector<OrderTriangle> triangles,
                                           const Progress& progress);

struct TriangulationListOptions {
  std::size_t most = 4096;             ///< triangulations
  std::size_t work_limit = 2'000'000;  ///< edges of fronts
};

/// All triangulations of one face.
struct FaceTriangulations {
  std::uint32_t size = 0;                ///< triangles in each
  std::vector<std::uint32_t> triangles;  ///< for each triangulation its candidates, ascending, end to end
  [[nodiscard]] std::size_t count() const { return size == 0 ? 0 : triangles.size() / size; }
  [[nodiscard]] std::span<const std::uint32_t> operator[](std::size_t i) const {
    return std::span(triangles).subspan(i * size, size);
  }
};

/// Each once, sorted; none if there are more than the options allow. Complexity: what is listed, and the
/// fronts of the face.
std::optional<FaceTriangulations> list_triangulations(const FixedFaces& faces, std::size_t face,
                                                      const TriangulationListOptions& options);

/// No triangulation of the face has a smaller sum of weights, given for each of its candidates, and one has
/// just this; none if that takes more than `work_limit` edges of fronts. Complexity: the fronts of the face.
std::optional<std::int64_t> find_least_sum(const FixedFaces& faces, std::size_t face,
                                           std::span<const std::int64_t> weights, std::size_t work_limit);

}  // namespace thalweg
