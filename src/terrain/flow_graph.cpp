// Falls, channels, and how a triangle hands on what it takes in.
//
// A triangle that is not level takes in water over one or two sides (In), and hands it on over the others
// (Out, or Along where a side runs down the slope: no water comes to it from inside, so it counts as one over
// which nothing runs). The line of flow through the one corner between two sides of the same sort splits it:
//     two Out sides: the corner is the lowest; water left and right of the line runs over different sides;
//     two In sides: the corner is the highest; water left and right of the line came over different sides.
// Lines of flow are parallel, so between the line and an end of the side shares of the sides' ways map
// affinely.
#include "terrain/flow_graph.hpp"

#include <tuple>

namespace thalweg {

namespace {

struct Gradient {
  double x = 0;
  double y = 0;
};

// Of any length: the direction in which the triangle rises.
Gradient rise_of(const FlowMesh& mesh, TriangleId t) {
  const Triangle& c = mesh.triangle(t);
  const Point2 o = mesh.point(c[0]);
  const double x1 = mesh.point(c[1]).x - o.x, y1 = mesh.point(c[1]).y - o.y;
  const double x2 = mesh.point(c[2]).x - o.x, y2 = mesh.point(c[2]).y - o.y;
  const double z1 = mesh.height(c[1]) - mesh.height(c[0]), z2 = mesh.height(c[2]) - mesh.height(c[0]);
  return {z1 * y2 - z2 * y1, x1 * z2 - x2 * z1};
}

}  // namespace

VertexId FlowGraph::lower(VertexId a, VertexId b) const {
  const double za = mesh.height(a), zb = mesh.height(b);
  if (za != zb) return zb < za ? b : a;
  const auto key = [&](VertexId v) { return std::tuple(flats.rank[v.index()], mesh.point(v)); };
  return key(b) < key(a) ? b : a;
}

VertexId FlowGraph::low_corner(TriangleId t) const {
  const Triangle& corner = mesh.triangle(t);
  return lower(lower(corner[0], corner[1]), corner[2]);
}

double FlowGraph::share_of(TriangleId t, const Strip& strip, Point2 p) const {
  const Gradient g = rise_of(mesh, t);
  const Point2 o = mesh.point(mesh.origin(strip.split)), d = mesh.point(mesh.target(strip.split));
  const double whole = g.x * (d.y - o.y) - g.y * (d.x - o.x);
  const double part = g.x * (p.y - o.y) - g.y * (p.x - o.x);
  const double share = part / whole;
  return share >= 0 && share <= 1 ? share : share > 1 ? 1 : share < 0 ? 0 : 0.5;
}

}  // namespace thalweg
