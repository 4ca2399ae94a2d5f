// Is it a triangulation?
//
// 1. Every triangle is counter-clockwise, positions differ, every vertex is a corner.
// 2. All directed sides are sorted: no two are equal (two triangles on one side of an edge); a side and its
//    reverse join two triangles.
// 3. Triangles are filed in a grid. Two triangles of one cell have disjoint interiors exactly if a side of
//    one of them has the other wholly on its outer side: all six sides are tried. A vertex of the cell may
//    not lie in the closed triangle but as its corner. Both together say that the triangles tile what they
//    cover.
#include "verify/plain_mesh.hpp"

#include "verify/exact.hpp"
#include "verify/plain_grid.hpp"

#include <algorithm>
#include <tuple>

namespace thalweg::verify {

namespace {

std::string name_of(const Corners& t) {
  return std::to_string(t[0]) + "-" + std::to_string(t[1]) + "-" + std::to_string(t[2]);
}

bool separated_by_side_of(const PlainMesh& mesh, const Corners& s, const Corners& t) {
  for (std::size_t i = 0; i < 3; ++i) {
    const Index a = s[i], b = s[(i + 1) % 3];
    const auto outside = [&](Index v) {
      return v == a || v == b || turn(mesh.at(a), mesh.at(b), mesh.at(v)) <= 0;
    };
    if (outside(t[0]) && outside(t[1]) && outside(t[2])) return true;
  }
  return false;
}

Box2 box_of(const PlainMesh& mesh, const Corners& t) {
  Box2 box;
  for (const Index v : t) box.add(mesh.at(v));
  return box;
}

// Whether a cell lies wholly, and clearly, on the outer side of a side: rounding can only say no.
bool clearly_apart(const PlainMesh& mesh, const Corners& t, const Box2& cell) {
  for (std::size_t i = 0; i < 3; ++i) {
    const Point2 a = mesh.at(t[i]), b = mesh.at(t[(i + 1) % 3]);
    const double dx = b.x - a.x, dy = b.y - a.y;
    const Point2 innermost = {dy > 0 ? cell.x_min : cell.x_max, dx > 0 ? cell.y_max : cell.y_min};
    const double left = dx * (innermost.y - a.y), right = dy * (innermost.x - a.x);
    if (left - right <
        -1e-9 * (std::abs(left) + std::abs(right)) - 1e-9 * cell.width() * std::hypot(dx, dy)) {
      return true;
    }
  }
  return false;
}

bool holds_point(const PlainMesh& mesh, const Corners& t, Index v) {
  const Point2 p = mesh.at(v);
  return turn(mesh.at(t[0]), mesh.at(t[1]), p) >= 0 && turn(mesh.at(t[1]), mesh.at(t[2]), p) >= 0 &&
         turn(mesh.at(t[2]), mesh.at(t[0]), p) >= 0;
}

std::optional<std::string> find_same_position(const PlainMesh& mesh) {
  std::vector<Index> order(mesh.xy.size());
  for (std::size_t v = 0; v < order.size(); ++v) order[v] = static_cast<Index>(v);
  std::sort(order.begin(), order.end(), [&](Index a, Index b) { return mesh.at(a) < mesh.at(b); });
  for (std::size_t i = 1; i < order.size(); ++i) {
    if (mesh.at(order[i - 1]) == mesh.at(order[i])) {
      return "vertices " + std::to_string(order[i - 1]) + " and " + std::to_string(order[i]) +
             " are at the same position";
    }
  }
  return std::nullopt;
}

std::optional<std::string> find_overlap(const PlainMesh& mesh) {
  Box2 box;
  for (const Point2 p : mesh.xy) box.add(p);
  PlainGrid vertices(box, mesh.xy.size(), 2);
  PlainGrid triangles(box, mesh.xy.size(), 2);  // the same cells
  for (std::size_t v = 0; v < mesh.xy.size(); ++v) {
    Box2 point;
    point.add(mesh.xy[v]);
    vertices.file_box(point, static_cast<Index>(v));
  }
  std::vector<std::vector<Index>> in_cell(triangles.cell_count());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Corners& t = mesh.triangles[i];
    triangles.for_cells(box_of(mesh, t), [&](std::size_t cell, const Box2& where) {
      if (!clearly_apart(mesh, t, where)) in_cell[cell].push_back(static_cast<Index>(i));
    });
  }
  for (std::size_t cell = 0; cell < in_cell.size(); ++cell) {
    for (std::size_t i = 0; i < in_cell[cell].size(); ++i) {
      const Corners& t = mesh.triangles[in_cell[cell][i]];
      for (const Index v : vertices.in(cell)) {
        if (v != t[0] && v != t[1] && v != t[2] && holds_point(mesh, t, v)) {
          return "vertex " + std::to_string(v) + " lies in triangle " + name_of(t);
        }
      }
      for (std::size_t j = 0; j < i; ++j) {
        const Corners& s = mesh.triangles[in_cell[cell][j]];
        if (!separated_by_side_of(mesh, s, t) && !separated_by_side_of(mesh, t, s)) {
          return "triangles " + name_of(s) + " and " + name_of(t) + " overlap";
        }
      }
    }
  }
  return std::nullopt;
}

}  // namespace

std::optional<std::string> link_sides(PlainMesh& mesh) {
  struct Side {
    Index a, b, triangle, number;
  };
  std::vector<Side> sides;
  sides.reserve(3 * mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (Index i = 0; i < 3; ++i) {
      sides.push_back({mesh.triangles[t][i], mesh.triangles[t][(i + 1) % 3], static_cast<Index>(t), i});
    }
  }
  const auto ends = [](const Side& s) { return std::tuple(std::minmax(s.a, s.b), s.a); };
  std::sort(sides.begin(), sides.end(), [&](const Side& s, const Side& t) { return ends(s) < ends(t); });
  mesh.across.assign(mesh.triangles.size(), {kNone, kNone, kNone});
  for (std::size_t i = 1; i < sides.size(); ++i) {
    const Side &s = sides[i - 1], &t = sides[i];
    if (s.a == t.a && s.b == t.b) {
      return "triangles " + name_of(mesh.triangles[s.triangle]) + " and " +
             name_of(mesh.triangles[t.triangle]) + " are on the same side of edge " + std::to_string(s.a) +
             "-" + std::to_string(s.b);
    }
    if (s.a == t.b && s.b == t.a) {
      mesh.across[s.triangle][s.number] = t.triangle;
      mesh.across[t.triangle][t.number] = s.triangle;
    }
  }
  return std::nullopt;
}

std::optional<std::string> find_unsoundness(const PlainMesh& mesh) {
  std::vector<bool> used(mesh.xy.size(), false);
  for (const Corners& t : mesh.triangles) {
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) return "triangle " + name_of(t) + " repeats a vertex";
    if (turn(mesh.at(t[0]), mesh.at(t[1]), mesh.at(t[2])) <= 0) {
      return "triangle " + name_of(t) + " is flat or clockwise";
    }
    if (!mesh.written.empty() && turn(mesh.written[t[0]], mesh.written[t[1]], mesh.written[t[2]]) <= 0) {
      return "triangle " + name_of(t) + " is flat or clockwise in the written coordinates";
    }
    for (const Index v : t) used[v] = true;
  }
  const auto unused = std::find(used.begin(), used.end(), false);
  if (unused != used.end()) {
    return "vertex " + std::to_string(unused - used.begin()) + " is in no triangle";
  }
  if (auto same = find_same_position(mesh)) return same;
  return find_overlap(mesh);
}

}  // namespace thalweg::verify
