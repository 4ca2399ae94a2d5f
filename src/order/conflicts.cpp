// Conflicts.
//
// 1. A flip of uv takes away the triangles uvs and vut. Two flips of one triangle, of its sides uv and us,
//    say, put in two segments that start at s and at v, and that leave it through uv and us: they cross
//    inside.
// 2. Two that share no triangle have disjoint interiors, so their diagonals do not meet, and the sides of a
//    quadrilateral are crossed by no diagonal of another that is flipped: only one that shares a triangle has
//    a side of it as its own Delaunay diagonal. Hence laws 1 and 2.
// 3. Among all triangulations: those of a face are listed, and the pairs of its free edges that they hold are
//    struck off. Faces do not know of each other, and fixed edges exclude nothing.
#include "base/parallel.hpp"

#include <thalweg/order/conflicts.hpp>

#include <algorithm>
#include <array>
#include <atomic>
#include <span>

namespace thalweg {

namespace {

/// The free edges of a face, and which pairs of them there can be.
class FacePairs {
 public:
  FacePairs(const FixedFaces& faces, std::size_t face) : faces_(faces) {
    for (const std::uint32_t t : faces.faces.row(face)) {
      for (const std::uint32_t side : faces.sides[t]) {
        if (faces.edges[side / 2].free) edges_.push_back(side / 2);
      }
    }
    std::sort(edges_.begin(), edges_.end());
    edges_.erase(std::unique(edges_.begin(), edges_.end()), edges_.end());
    together_.assign(edges_.size() * edges_.size(), false);
  }

  /// Strikes off the pairs that a triangulation has, given by its triangles; an edge and itself as well.
  void strike(std::span<const std::uint32_t> triangles) {
    std::vector<std::size_t> held;
    for (const std::uint32_t t : triangles) {
      for (const std::uint32_t side : faces_.sides[t]) {
        const auto at = std::lower_bound(edges_.begin(), edges_.end(), side / 2);
        if (at != edges_.end() && *at == side / 2)
          held.push_back(static_cast<std::size_t>(at - edges_.begin()));
      }
    }
    for (const std::size_t i : held) {
      for (const std::size_t j : held) together_[i * edges_.size() + j] = true;
    }
  }

  /// What is left, of edges that some triangulation has.
  void list(std::vector<EdgeConflict>& pairs) const {
    for (std::size_t i = 0; i < edges_.size(); ++i) {
      for (std::size_t j = i + 1; j < edges_.size(); ++j) {
        if (held(i) && held(j) && !together_[i * edges_.size() + j]) pairs.push_back(pair(i, j));
      }
    }
  }

  /// All that cross.
  void list_crossings(std::vector<EdgeConflict>& pairs) const {
    for (std::size_t i = 0; i < edges_.size(); ++i) {
      for (std::size_t j = i + 1; j < edges_.size(); ++j) {
        if (cross(i, j)) pairs.push_back(pair(i, j));
      }
    }
  }

 private:
  [[nodiscard]] bool held(std::size_t i) const { return together_[i * edges_.size() + i]; }
  [[nodiscard]] bool cross(std::size_t i, std::size_t j) const {
    const auto crossed = faces_.crossings.row(edges_[i]);
    return std::binary_search(crossed.begin(), crossed.end(), edges_[j]);
  }
  [[nodiscard]] EdgeConflict pair(std::size_t i, std::size_t j) const {
    const CandidateEdge& one = faces_.edges[edges_[i]];
    const CandidateEdge& other = faces_.edges[edges_[j]];
    return {one.a, one.b, other.a, other.b, cross(i, j)};
  }

  const FixedFaces& faces_;
  std::vector<std::uint32_t> edges_;  // ascending, as their ends are
  std::vector<bool> together_;
};

}  // namespace

std::vector<QuadrilateralConflict> find_conflicts(const Tin& ground,
                                                  std::span<const Quadrilateral> quadrilaterals) {
  // For each triangle the quadrilaterals that it is half of, by the side that they would flip; plus one.
  std::vector<std::array<std::uint32_t, 3>> halves(ground.triangle_count(), {0, 0, 0});
  for (std::size_t i = 0; i < quadrilaterals.size(); ++i) {
    const HalfedgeId h = quadrilaterals[i].diagonal;
    for (const HalfedgeId side : {h, ground.twin(h)}) {
      halves[Tin::triangle_of(side).index()][side.index() % 3] = static_cast<std::uint32_t>(i + 1);
    }
  }
  std::vector<QuadrilateralConflict> conflicts;
  for (std::size_t t = 0; t < halves.size(); ++t) {
    std::array<std::uint32_t, 3> sides = halves[t];
    std::sort(sides.begin(), sides.end());
    for (std::size_t i = 0; i < sides.size(); ++i) {
      for (std::size_t j = i + 1; j < sides.size(); ++j) {
        if (sides[i] != 0) conflicts.push_back({sides[i] - 1, sides[j] - 1, TriangleId{t}});
      }
    }
  }
  std::sort(conflicts.begin(), conflicts.end());
  return conflicts;
}

EdgeConflicts find_edge_conflicts(const FixedFaces& faces, const TriangulationListOptions& options,
                                  const Progress& progress) {
  constexpr std::size_t kBlock = 64;
  const std::size_t count = faces.faces.size();
  std::vector<std::vector<EdgeConflict>> found(count / kBlock + 1);
  std::atomic<std::size_t> undecided{0};
  for_each_block(count, kBlock, progress, [&](std::size_t begin, std::size_t end) {
    std::vector<EdgeConflict>& here = found[begin / kBlock];
    for (std::size_t face = begin; face < end; ++face) {
      FacePairs pairs(faces, face);
      const auto triangulations = list_triangulations(faces, face, options);
      if (!triangulations) {
        ++undecided;
        pairs.list_crossings(here);
        continue;
      }
      for (std::size_t i = 0; i < triangulations->count(); ++i) pairs.strike((*triangulations)[i]);
      pairs.list(here);
    }
  });
  EdgeConflicts all{.pairs = {}, .undecided_faces = undecided};
  for (const auto& part : found) all.pairs.insert(all.pairs.end(), part.begin(), part.end());
  std::sort(all.pairs.begin(), all.pairs.end());
  return all;
}

}  // namespace thalweg
