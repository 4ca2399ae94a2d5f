// Conflicts.
//
// 1. A flip of uv takes away the triangles uvs and vut. Two flips of one triangle, of its sides uv and us,
// say, put
//    in two segments that start at s and at v, and that leave it through uv and us: they cross inside.
// 2. Two that share no triangle have disjoint interiors, so their diagonals do not meet, and the sides of a
//    quadrilateral are crossed by no diagonal of another that is flipped: only one that shares a triangle
//    has a side of it as its own Delaunay diagonal. Hence laws 1 and 2.
#include <thalweg/order/conflicts.hpp>

#include <algorithm>
#include <array>

namespace thalweg {

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

}  // namespace thalweg
