// Heights inside a triangle as weighted means of its corners' heights, by areas in extended precision.
#include "verify/plain_reference.hpp"

#include "verify/exact.hpp"

#include <array>

namespace thalweg::verify {

namespace {

using Extended = long double;

Extended area(Point2 a, Point2 b, Point2 c) {
  return (Extended{b.x} - a.x) * (Extended{c.y} - a.y) - (Extended{b.y} - a.y) * (Extended{c.x} - a.x);
}

Box2 box_of(std::initializer_list<Point2> points) {
  Box2 box;
  for (const Point2 p : points) box.add(p);
  return box;
}

}  // namespace

PlainReference::PlainReference(std::span<const Point2> points, std::span<const double> heights)
    : points_(points), heights_(heights), grid_(bounding_box(points), points.size(), 2) {
  for (std::size_t i = 0; i < points.size(); ++i) grid_.file_box(box_of({points[i]}), static_cast<Index>(i));
}

template <class F>
void PlainReference::for_points_in(const Box2& box, const F& f) const {
  grid_.for_cells(box, [&](std::size_t cell, const Box2&) {
    for (const Index i : grid_.in(cell)) {
      if (box.contains(points_[i])) f(points_[i], heights_[i]);
    }
  });
}

long double PlainReference::squares(const PlainMesh& mesh, Index a, Index b, Index c) const {
  const std::array<Index, 3> corner = {a, b, c};
  Extended sum = 0;
  for_points_in(box_of({mesh.at(a), mesh.at(b), mesh.at(c)}), [&](Point2 p, double height) {
    int on_sides = 0;
    Extended distance = -Extended{height};
    for (std::size_t i = 0; i < 3; ++i) {
      const Point2 q = mesh.at(corner[(i + 1) % 3]), r = mesh.at(corner[(i + 2) % 3]);
      const int side = turn(q, r, p);
      if (side < 0) return;
      on_sides += side == 0 ? 1 : 0;
      distance += area(q, r, p) / area(mesh.at(a), mesh.at(b), mesh.at(c)) * mesh.z[corner[i]];
    }
    if (on_sides == 2) return;
    sum += distance * distance / (on_sides == 1 ? 2 : 1);
  });
  return sum;
}

long double PlainReference::squares_left(const PlainMesh& mesh) const {
  Extended sum = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::size_t i = 0; i < 3; ++i) {
      if (mesh.across[t][i] != kNone) continue;
      const Index u = mesh.triangles[t][i], v = mesh.triangles[t][(i + 1) % 3];
      const Point2 a = mesh.at(u), b = mesh.at(v);
      for_points_in(box_of({a, b}), [&](Point2 p, double height) {
        if (p == a || p == b || turn(a, b, p) != 0) return;
        const Extended x = Extended{b.x} - a.x, y = Extended{b.y} - a.y;
        const Extended at = ((p.x - a.x) * x + (p.y - a.y) * y) / (x * x + y * y);
        const Extended distance = mesh.z[u] + (Extended{mesh.z[v]} - mesh.z[u]) * at - height;
        sum += distance * distance / 2;
      });
    }
  }
  for (std::size_t v = 0; v < mesh.xy.size(); ++v) {
    for_points_in(box_of({mesh.xy[v]}), [&](Point2, double height) {
      sum += (Extended{mesh.z[v]} - height) * (Extended{mesh.z[v]} - height);
    });
  }
  return sum;
}

}  // namespace thalweg::verify
