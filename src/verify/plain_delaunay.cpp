// Lawson's flips.
//
// A stack holds the sides whose local condition may be broken. A flip replaces the two triangles in place and
// puts the four sides around them on the stack. Each flip lowers the lifted surface, so it ends.
#include "verify/plain_delaunay.hpp"

#include "base/parallel.hpp"
#include "verify/exact.hpp"

#include <thalweg/base/error.hpp>

namespace thalweg::verify {

namespace {

struct Side {
  Index triangle;
  Index number;
};

Index corner(const PlainMesh& mesh, Side side, Index offset) {
  return mesh.triangles[side.triangle][(side.number + offset) % 3];
}

Index number_of(const PlainMesh& mesh, Index triangle, Index across) {
  const auto& neighbours = mesh.across[triangle];
  return neighbours[0] == across ? 0 : neighbours[1] == across ? 1 : 2;
}

// The side seen from the other triangle. (Two triangles can share more than one side only if they lie on each
// other, which a sound mesh excludes.)
Side other_side(const PlainMesh& mesh, Side side) {
  const Index other = mesh.across[side.triangle][side.number];
  return {other, number_of(mesh, other, side.triangle)};
}

void relink(PlainMesh& mesh, Index triangle, Index from, Index to) {
  if (triangle != kNone) mesh.across[triangle][number_of(mesh, triangle, from)] = to;
}

// Replaces diagonal uv (the side) by st: triangles u, t, s and v, s, t.
void flip(PlainMesh& mesh, Side side) {
  const Side other = other_side(mesh, side);
  const Index u = corner(mesh, side, 0), v = corner(mesh, side, 1), s = corner(mesh, side, 2),
              t = corner(mesh, other, 2);
  const Index vs = mesh.across[side.triangle][(side.number + 1) % 3];
  const Index su = mesh.across[side.triangle][(side.number + 2) % 3];
  const Index ut = mesh.across[other.triangle][(other.number + 1) % 3];
  const Index tv = mesh.across[other.triangle][(other.number + 2) % 3];
  relink(mesh, vs, side.triangle, other.triangle);
  relink(mesh, ut, other.triangle, side.triangle);
  mesh.triangles[side.triangle] = {u, t, s};
  mesh.across[side.triangle] = {ut, other.triangle, su};
  mesh.triangles[other.triangle] = {v, s, t};
  mesh.across[other.triangle] = {vs, side.triangle, tv};
}

bool strictly_convex(std::span<const Point2> xy, Index s, Index u, Index t, Index v) {
  return turn(xy[s], xy[u], xy[t]) > 0 && turn(xy[t], xy[v], xy[s]) > 0;
}

}  // namespace

PlainMesh flip_to_delaunay(PlainMesh mesh, Progress& progress) {
  constexpr std::size_t kStep = 4096;
  std::vector<Side> stack;
  for (Index t = 0; t < mesh.triangles.size(); ++t) {
    for (Index i = 0; i < 3; ++i) {
      if (mesh.across[t][i] != kNone && t < mesh.across[t][i]) stack.push_back({t, i});
    }
  }
  for (std::size_t steps = 0; !stack.empty(); ++steps) {
    if (steps % kStep == 0) progress.check();
    const Side side = stack.back();
    stack.pop_back();
    if (mesh.across[side.triangle][side.number] == kNone) continue;
    const Side other = other_side(mesh, side);
    const Index u = corner(mesh, side, 0), v = corner(mesh, side, 1), s = corner(mesh, side, 2),
                t = corner(mesh, other, 2);
    if (mesh.constrained(u, v)) continue;
    if (!counts_as_inside(mesh.at(u), mesh.at(v), mesh.at(s), mesh.at(t))) continue;
    if (!strictly_convex(mesh.xy, s, u, t, v)) continue;  // only a tie on a rim of collinear points
    flip(mesh, side);
    for (const Index triangle : {side.triangle, other.triangle}) {
      for (Index i = 0; i < 3; ++i) stack.push_back({triangle, i});
    }
  }
  return mesh;
}

std::vector<PlainQuadrilateral> find_quadrilaterals(const PlainMesh& delaunay, const PlainOrders& orders,
                                                    Progress& progress) {
  constexpr std::size_t kBlock = 512;
  std::vector<Side> sides;
  for (Index t = 0; t < delaunay.triangles.size(); ++t) {
    for (Index i = 0; i < 3; ++i) {
      const Index across = delaunay.across[t][i];
      if (across == kNone || across < t) continue;
      const Side side{t, i};
      if (!delaunay.constrained(corner(delaunay, side, 0), corner(delaunay, side, 1))) sides.push_back(side);
    }
  }
  std::vector<std::uint8_t> found(sides.size(), 0);
  const auto quadrilateral = [&](Side side) {
    const Side other = other_side(delaunay, side);
    return PlainQuadrilateral{corner(delaunay, side, 2),
                              corner(delaunay, side, 0),
                              corner(delaunay, other, 2),
                              corner(delaunay, side, 1),
                              side.triangle,
                              other.triangle};
  };
  for_each_block(sides.size(), kBlock, progress, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto [s, u, t, v, left, right] = quadrilateral(sides[i]);
      found[i] = strictly_convex(delaunay.xy, s, u, t, v) &&
                 (delaunay.written.empty() || strictly_convex(delaunay.written, s, u, t, v)) &&
                 orders.at_most({s, u, t}, 1) && orders.at_most({t, v, s}, 1);
    }
  });
  std::vector<PlainQuadrilateral> quadrilaterals;
  for (std::size_t i = 0; i < sides.size(); ++i) {
    if (found[i] != 0) quadrilaterals.push_back(quadrilateral(sides[i]));
  }
  return quadrilaterals;
}

PlainMesh with_diagonals(PlainMesh delaunay, const std::vector<PlainQuadrilateral>& quadrilaterals,
                         const std::vector<bool>& flipped) {
  for (std::size_t q = 0; q < quadrilaterals.size(); ++q) {
    if (!flipped[q]) continue;
    flip(delaunay,
         {quadrilaterals[q].left, number_of(delaunay, quadrilaterals[q].left, quadrilaterals[q].right)});
  }
  return delaunay;
}

}  // namespace thalweg::verify
