// Counting by the definitions.
//
// 1. A grid gives the points near the circumcircle; whether one is inside is asked of the exact predicate.
// 2. A point inside lies beyond exactly one side. What else its definition asks is tried as it is written:
//    each sight against every constraint edge in the cells that it passes.
// 3. sees-triang: each constraint edge is cut down to the wedge in which p sees the side uv; the ends of its
//    shadow are rational numbers along uv. p sees the side unless the closed shadows cover all of it. An edge
//    that runs towards p has a shadow of no length, which covers nothing: what is left open is open.
#include "verify/plain_orders.hpp"

#include "verify/exact.hpp"

#include <boost/multiprecision/cpp_int.hpp>

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>

namespace thalweg::verify {

namespace {

using Rational = boost::multiprecision::cpp_rational;

struct RationalPoint {
  Rational x, y;
};

RationalPoint rational(Point2 p) {
  return {Rational(p.x), Rational(p.y)};
}

Rational area(const RationalPoint& a, const RationalPoint& b, const RationalPoint& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

struct Shadow {
  Rational from, to;
};

// The shadow of edge cd on the side from u (at 0) to v (at 1), seen from p; the wedge p, u, v turns counter-
// clockwise.
std::optional<Shadow> shadow_of(const RationalPoint& p, const RationalPoint& u, const RationalPoint& v,
                                const RationalPoint& c, const RationalPoint& d) {
  const std::array<Rational, 2> right = {area(p, u, c), area(p, u, d)};  // left of the ray pu: positive
  const std::array<Rational, 2> left = {area(p, c, v), area(p, d, v)};   // right of the ray pv: positive
  Rational low = 0, high = 1;                                            // the part of cd inside the wedge
  for (const auto& ends : {right, left}) {
    if (ends[0] <= 0 && ends[1] <= 0) return std::nullopt;
    if (ends[0] < 0) low = std::max(low, Rational(ends[0] / (ends[0] - ends[1])));
    if (ends[1] < 0) high = std::min(high, Rational(ends[0] / (ends[0] - ends[1])));
  }
  if (low >= high) return std::nullopt;
  const auto along = [](const std::array<Rational, 2>& ends, const Rational& at) {
    return Rational(ends[0] + (ends[1] - ends[0]) * at);
  };
  const Rational middle = (low + high) / 2;
  if (along(right, middle) + along(left, middle) >= area(p, u, v)) return std::nullopt;  // beyond uv
  const auto position = [&](const Rational& at) {
    const Rational r = along(right, at), l = along(left, at);
    return Rational(r / (r + l));
  };
  if (area(p, c, d) == 0) return std::nullopt;
  const Rational first = position(low), second = position(high);
  return Shadow{std::min(first, second), std::max(first, second)};
}

// Counter-clockwise; vertices within a side of the hull are ends of edges, too.
std::vector<std::pair<Index, Index>> hull_edges(const PlainMesh& mesh) {
  std::vector<Index> order(mesh.xy.size());
  std::iota(order.begin(), order.end(), Index{0});
  std::sort(order.begin(), order.end(), [&](Index v, Index w) { return mesh.at(v) < mesh.at(w); });
  std::vector<std::pair<Index, Index>> edges;
  for (int half = 0; half < 2; ++half) {
    std::vector<Index> chain;
    for (const Index v : order) {
      while (chain.size() > 1 &&
             turn(mesh.at(chain[chain.size() - 2]), mesh.at(chain.back()), mesh.at(v)) < 0) {
        chain.pop_back();
      }
      chain.push_back(v);
    }
    for (std::size_t i = 1; i < chain.size(); ++i) edges.emplace_back(chain[i - 1], chain[i]);
    std::reverse(order.begin(), order.end());
  }
  return edges;
}

bool cover(std::vector<Shadow> shadows) {
  std::sort(shadows.begin(), shadows.end(), [](const Shadow& a, const Shadow& b) { return a.from < b.from; });
  Rational reached = 0;
  for (const Shadow& shadow : shadows) {
    if (shadow.from > reached) return false;
    reached = std::max(reached, shadow.to);
  }
  return reached >= 1;
}

}  // namespace

PlainOrders::PlainOrders(const PlainMesh& mesh, OrderDefinition definition, bool polygon)
    : mesh_(mesh),
      definition_(definition),
      polygon_(polygon),
      points_(bounding_box(mesh.xy), mesh.xy.size(), 2),
      edges_(bounding_box(mesh.xy), mesh.xy.size(), 2) {
  for (std::size_t v = 0; v < mesh.xy.size(); ++v) {
    points_.file_box({mesh.xy[v].x, mesh.xy[v].y, mesh.xy[v].x, mesh.xy[v].y}, static_cast<Index>(v));
  }
  const auto add_edge = [&](const std::pair<Index, Index>& edge) {
    edges_.file_segment(mesh.at(edge.first), mesh.at(edge.second), static_cast<Index>(constraints_.size()));
    constraints_.push_back(edge);
  };
  for (const auto& [edge, kind] : mesh.constraints) add_edge(edge);
  if (definition == OrderDefinition::Pathcon) flood_.emplace(mesh, polygon);
  if (!polygon) return;
  for (const auto& edge : hull_edges(mesh)) {
    if (!mesh.constrained(edge.first, edge.second)) add_edge(edge);
  }
  fans_.resize(mesh.xy.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (const Index v : mesh.triangles[t]) fans_[v].push_back(static_cast<Index>(t));
  }
}

// Calls f(p) for every vertex but the corners that counts as inside the circle, until f returns false.
template <class F>
void PlainOrders::for_points_inside(const Corners& t, const F& f) const {
  const Point2 a = mesh_.at(t[0]), b = mesh_.at(t[1]), c = mesh_.at(t[2]);
  const double bx = b.x - a.x, by = b.y - a.y, cx = c.x - a.x, cy = c.y - a.y;
  const double b2 = bx * bx + by * by, c2 = cx * cx + cy * cy;
  const double twice = 2 * (bx * cy - by * cx);
  const Point2 centre = {a.x + (cy * b2 - by * c2) / twice, a.y + (bx * c2 - cx * b2) / twice};
  const double radius = std::hypot(centre.x - a.x, centre.y - a.y);
  // Rounding moves the centre by far less than this share of the radius unless the triangle is nearly flat.
  constexpr double kMargin = 1e-6;
  const bool trusted = std::isfinite(radius) && std::abs(twice) > 1e-9 * std::sqrt(b2 * c2);
  // Far from the origin coordinates are coarse: so are the centre and the corners of cells.
  const double coarse =
      8 * std::numeric_limits<double>::epsilon() * std::max(std::abs(a.x) + radius, std::abs(a.y) + radius);
  const double reach = trusted ? radius * (1 + kMargin) + coarse : std::numeric_limits<double>::max() / 4;
  const Point2 middle = trusted ? centre : a;
  // From the triangle outwards: what is near is seen most likely, and a count may stop early.
  points_.for_cells_outward({middle.x - reach, middle.y - reach, middle.x + reach, middle.y + reach}, a,
                            [&](std::size_t cell, const Box2& box) {
                              if (points_.in(cell).empty()) return true;
                              const double dx = std::max({box.x_min - middle.x, 0.0, middle.x - box.x_max});
                              const double dy = std::max({box.y_min - middle.y, 0.0, middle.y - box.y_max});
                              if (trusted && std::hypot(dx, dy) > reach + kMargin * box.width() + coarse)
                                return true;
                              for (const Index p : points_.in(cell)) {
                                if (p == t[0] || p == t[1] || p == t[2]) continue;
                                if (counts_as_inside(a, b, c, mesh_.at(p)) && !f(p)) return false;
                              }
                              return true;
                            });
}

std::size_t PlainOrders::count(const Corners& t, std::size_t most) const {
  if (flood_) return flood_->count(t, most);
  std::size_t counted = 0;
  for_points_inside(t, [&](Index p) {
    if (counts(t, p)) ++counted;
    return counted < most;
  });
  return counted;
}

bool PlainOrders::at_most(const Corners& t, std::size_t k) const {
  return count(t, k + 1) <= k;
}

bool PlainOrders::counts(const Corners& t, Index p) const {
  if (definition_ == OrderDefinition::Std) return true;
  std::size_t side = 0;
  while (turn(mesh_.at(t[side]), mesh_.at(t[(side + 1) % 3]), mesh_.at(p)) >= 0) {
    if (++side == 3) return true;  // in the triangle: it is not valid, and p counts under every definition
  }
  const Index u = t[side], v = t[(side + 1) % 3], w = t[(side + 2) % 3];
  if (mesh_.constrained(u, v)) return false;
  switch (definition_) {
    case OrderDefinition::SeesTriang:
      return sees_side(p, u, v);
    case OrderDefinition::SeesVtx:
      return (sees(p, u) || sees(p, v) || sees(p, w)) && sees_side(p, u, v);
    case OrderDefinition::ConfEdge:
      return in_conflict(t, p, u, v);
    case OrderDefinition::SeesOpp:
      return sees(p, w);
    case OrderDefinition::Sees3vtx:
      return sees(p, w) && sees(p, u) && sees(p, v);
    case OrderDefinition::EmptyQuad:
      return sees(p, w) && sees(p, u) && sees(p, v) && triangle_is_empty(u, v, p);
    case OrderDefinition::Std:
    case OrderDefinition::Pathcon:
      break;
  }
  return true;
}

bool PlainOrders::sees(Index p, Index q) const {
  if (mesh_.constrained(p, q)) return true;
  if (polygon_ && !looks_inside(p, q)) return false;
  bool blocked = false;
  // From q on: the callers ask for sights to corners, and what hides a point is mostly near the triangle.
  edges_.for_cells_on(mesh_.at(q), mesh_.at(p), [&](std::size_t cell) {
    for (const Index e : edges_.in(cell)) {
      const auto [c, d] = constraints_[e];
      const auto in_the_way = [&](Index end) {
        return end != p && end != q && inside_segment(mesh_.at(p), mesh_.at(q), mesh_.at(end));
      };
      blocked = blocked || in_the_way(c) || in_the_way(d) ||
                segments_cross(mesh_.at(p), mesh_.at(q), mesh_.at(c), mesh_.at(d));
    }
    return !blocked;
  });
  return !blocked;
}

// In a polygon: whether the ground begins between p and q at p.
bool PlainOrders::looks_inside(Index p, Index q) const {
  const Point2 at = mesh_.at(p), to = mesh_.at(q);
  return std::any_of(fans_[p].begin(), fans_[p].end(), [&](Index number) {
    const Corners& t = mesh_.triangles[number];
    const std::size_t i = t[0] == p ? 0 : t[1] == p ? 1 : 2;
    return turn(at, mesh_.at(t[(i + 1) % 3]), to) >= 0 && turn(at, to, mesh_.at(t[(i + 2) % 3])) >= 0;
  });
}

bool PlainOrders::sees_side(Index p, Index u, Index v) const {
  const RationalPoint from = rational(mesh_.at(p)), first = rational(mesh_.at(v)),
                      second = rational(mesh_.at(u));  // p lies right of uv: v is to the right, u to the left
  Box2 box;
  for (const Index corner : {p, u, v}) box.add(mesh_.at(corner));
  std::vector<Index> near;
  edges_.for_cells(box, [&](std::size_t cell, const Box2&) {
    near.insert(near.end(), edges_.in(cell).begin(), edges_.in(cell).end());
  });
  std::sort(near.begin(), near.end());
  near.erase(std::unique(near.begin(), near.end()), near.end());
  std::vector<Shadow> shadows;
  const Point2 at = mesh_.at(p), right = mesh_.at(v), left = mesh_.at(u);
  for (const Index e : near) {
    const Point2 c = mesh_.at(constraints_[e].first), d = mesh_.at(constraints_[e].second);
    const bool off_the_wedge = (turn(at, right, c) <= 0 && turn(at, right, d) <= 0) ||
                               (turn(at, c, left) <= 0 && turn(at, d, left) <= 0);
    const bool beyond_the_side = turn(left, right, c) >= 0 && turn(left, right, d) >= 0;
    if (off_the_wedge || beyond_the_side) continue;
    const auto shadow = shadow_of(from, first, second, rational(mesh_.at(constraints_[e].first)),
                                  rational(mesh_.at(constraints_[e].second)));
    if (shadow) shadows.push_back(*shadow);
  }
  return !cover(std::move(shadows));
}

bool PlainOrders::in_conflict(const Corners& t, Index p, Index u, Index v) const {
  const Index w = t[0] != u && t[0] != v ? t[0] : t[1] != u && t[1] != v ? t[1] : t[2];
  if (sees(p, w)) return true;
  bool found = false;
  for_points_inside(t, [&](Index r) {
    const bool across = r != p && segments_cross(mesh_.at(p), mesh_.at(r), mesh_.at(u), mesh_.at(v));
    found = across && sees(p, r);
    return !found;
  });
  return found;
}

bool PlainOrders::triangle_is_empty(Index u, Index v, Index p) const {
  Box2 box;
  for (const Index corner : {p, u, v}) box.add(mesh_.at(corner));
  bool empty = true;
  points_.for_cells(box, [&](std::size_t cell, const Box2&) {
    for (const Index r : points_.in(cell)) {
      if (r == p || r == u || r == v) continue;
      const Point2 at = mesh_.at(r);  // p lies right of uv: v, u, p turn counter-clockwise
      if (turn(mesh_.at(v), mesh_.at(u), at) >= 0 && turn(mesh_.at(u), mesh_.at(p), at) >= 0 &&
          turn(mesh_.at(p), mesh_.at(v), at) >= 0) {
        empty = false;
      }
    }
  });
  return empty;
}

}  // namespace thalweg::verify
