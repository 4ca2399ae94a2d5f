// A path from a vertex to the triangle, inside the open disc and off the constraint edges, goes from face to
// face of any triangulation that has these edges. Face and disc are convex, so what they have in common is
// connected: faces are entered, from those that the triangle overlaps, through every free side that meets the
// open disc. Outside of the hull there is one face for each side of the hull; from one to the next the path
// goes around their common vertex, inside the disc only if the vertex is. A vertex of a face that was entered
// is reached.
//
// Whether a side ab meets the open disc with centre o and radius r, exactly: a or b is inside, or
//   |a + s (b - a) - o|^2 - r^2 = A s^2 + B s + C  is negative for some s between 0 and 1.
#include "verify/plain_flood.hpp"

#include "verify/exact.hpp"

#include <boost/multiprecision/cpp_int.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>

namespace thalweg::verify {

namespace {

using Rational = boost::multiprecision::cpp_rational;

/// The sign of the least value of A s^2 + B s + C in between, given that it is nowhere negative at the ends.
template <class Number>
bool dips(const Number& a, const Number& b, const Number& c) {
  return b < 0 && -b < 2 * a && b * b > 4 * a * c;
}

template <class Number>
struct Parabola {
  Number a, b, c;
};

template <class Number>
Parabola<Number> parabola(const std::array<Point2, 3>& t, Point2 p, Point2 q) {
  const auto x = [&](Point2 v) { return Number(Number(v.x) - Number(t[0].x)); };
  const auto y = [&](Point2 v) { return Number(Number(v.y) - Number(t[0].y)); };
  const Number bx = x(t[1]), by = y(t[1]), cx = x(t[2]), cy = y(t[2]);
  const Number b2 = bx * bx + by * by, c2 = cx * cx + cy * cy, twice = 2 * (bx * cy - by * cx);
  const Number ox = (cy * b2 - by * c2) / twice, oy = (bx * c2 - cx * b2) / twice;
  const Number dx = x(q) - x(p), dy = y(q) - y(p), px = x(p), py = y(p);
  return {dx * dx + dy * dy, 2 * (dx * (px - ox) + dy * (py - oy)),
          px * px + py * py - 2 * (px * ox + py * oy)};
}

bool meets_disc(const std::array<Point2, 3>& t, Point2 p, Point2 q) {
  const auto inside = [&](Point2 v) {
    return v != t[0] && v != t[1] && v != t[2] && circle_side(t[0], t[1], t[2], v) > 0;
  };
  if (inside(p) || inside(q)) return true;
  using Extended = long double;
  const Parabola<Extended> f = parabola<Extended>(t, p, q);
  const Extended scale = std::abs(f.b) + f.a + std::abs(f.c);
  constexpr Extended kClear = 1e-6L;  // far more than rounding makes of triangles that are not nearly flat
  const Extended height = f.b * f.b - 4 * f.a * f.c;
  const bool flat = std::abs(turn(t[0], t[1], t[2])) == 0;
  const Extended bx = Extended{t[1].x} - t[0].x, by = Extended{t[1].y} - t[0].y,
                 cx = Extended{t[2].x} - t[0].x, cy = Extended{t[2].y} - t[0].y;
  const bool thin = std::abs(bx * cy - by * cx) < 1e-4L * (bx * bx + by * by + cx * cx + cy * cy);
  if (!flat && !thin && std::isfinite(scale)) {
    if (f.b > kClear * scale || -f.b > 2 * f.a + kClear * scale || height < -kClear * scale * scale) {
      return false;
    }
    if (f.b < -kClear * scale && -f.b < 2 * f.a - kClear * scale && height > kClear * scale * scale) {
      return true;
    }
  }
  const Parabola<Rational> exact = parabola<Rational>(t, p, q);
  return dips(exact.a, exact.b, exact.c);
}

/// The vertices of the rim, counter-clockwise about the mesh; empty if it has several loops or none.
std::vector<Index> rim_loop(const PlainMesh& mesh) {
  std::map<Index, Index> next;
  std::size_t sides = 0;
  for (Index t = 0; t < mesh.triangles.size(); ++t) {
    for (Index i = 0; i < 3; ++i) {
      if (mesh.across[t][i] != kNone) continue;
      next[mesh.triangles[t][i]] = mesh.triangles[t][(i + 1) % 3];
      ++sides;
    }
  }
  std::vector<Index> loop;
  if (next.empty() || next.size() != sides) return loop;
  const Index first = next.begin()->first;
  for (Index v = first; loop.empty() || v != first; v = next.at(v)) {
    loop.push_back(v);
    if (loop.size() > sides) return {};
  }
  if (loop.size() != sides) loop.clear();
  return loop;
}

/// Whether a pocket of the rim can be closed from its vertices a to c, over b: no other one is in between.
bool is_ear(const PlainMesh& mesh, const std::vector<Index>& loop, Index a, Index b, Index c) {
  const Point2 pa = mesh.at(a), pb = mesh.at(b), pc = mesh.at(c);
  if (turn(pa, pb, pc) >= 0) return false;
  return std::none_of(loop.begin(), loop.end(), [&](Index v) {
    const Point2 p = mesh.at(v);
    return v != a && v != b && v != c && turn(pa, pc, p) >= 0 && turn(pc, pb, p) >= 0 && turn(pb, pa, p) >= 0;
  });
}

/// The mesh with triangles in the pockets that it leaves of its convex hull (there is no vertex in them).
std::optional<PlainMesh> with_pockets_filled(PlainMesh mesh) {
  std::vector<Index> loop = rim_loop(mesh);
  if (loop.empty()) return std::nullopt;
  std::size_t idle = 0;
  for (std::size_t i = 0; idle < loop.size() && loop.size() > 3;) {
    const std::size_t n = loop.size();
    const Index a = loop[(i + n - 1) % n], b = loop[i % n], c = loop[(i + 1) % n];
    if (!is_ear(mesh, loop, a, b, c)) {
      ++idle;
      i = (i + 1) % n;
      continue;
    }
    mesh.triangles.push_back({a, c, b});
    loop.erase(loop.begin() + static_cast<std::ptrdiff_t>(i % n));
    idle = 0;
    i = (i + n - 2) % (n - 1);
  }
  if (link_sides(mesh)) return std::nullopt;
  return mesh;
}

}  // namespace

PlainFlood::PlainFlood(const PlainMesh& mesh, bool polygon)
    : filled_(polygon ? PlainMesh() : with_pockets_filled(mesh).value_or(PlainMesh())),
      mesh_(filled_.triangles.empty() ? mesh : filled_),
      polygon_(polygon),
      covers_ground_(polygon || is_convex()),
      fans_(mesh.xy.size()),
      rim_at_(mesh.xy.size()) {
  list_faces();
}

bool PlainFlood::is_convex() const {
  const std::vector<Index> loop = rim_loop(mesh_);
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Index a = loop[i], b = loop[(i + 1) % loop.size()], c = loop[(i + 2) % loop.size()];
    if (turn(mesh_.at(a), mesh_.at(b), mesh_.at(c)) < 0) return false;
  }
  return !loop.empty();
}

void PlainFlood::list_faces() {
  for (Index t = 0; t < mesh_.triangles.size(); ++t) {
    for (Index i = 0; i < 3; ++i) {
      fans_[mesh_.triangles[t][i]].push_back(t);
      if (mesh_.across[t][i] != kNone) continue;
      for (const Index v : ends(t, i)) rim_at_[v].push_back({t, i});
    }
  }
}

/// The triangle of the mesh just left of the side from t[0] to t[1], at t[0].
Index PlainFlood::first_triangle(const Corners& t) const {
  for (const Index number : fans_[t[0]]) {
    const Corners& corner = mesh_.triangles[number];
    const std::size_t i = corner[0] == t[0] ? 0 : corner[1] == t[0] ? 1 : 2;
    const Point2 at = mesh_.at(t[0]), to = mesh_.at(t[1]), right = mesh_.at(corner[(i + 1) % 3]),
                 left = mesh_.at(corner[(i + 2) % 3]);
    if (turn(at, right, to) >= 0 && turn(at, to, left) > 0) return number;
  }
  return kNone;
}

template <class Enter>
void PlainFlood::for_faces_beside(const Corners& t, const Face& face, const Enter& enter) const {
  const std::array<Point2, 3> at = {mesh_.at(t[0]), mesh_.at(t[1]), mesh_.at(t[2])};
  const auto passable = [&](Index triangle, Index side) {
    const auto [a, b] = ends(triangle, side);
    return !mesh_.constrained(a, b) && meets_disc(at, mesh_.at(a), mesh_.at(b));
  };
  if (face.outside_of == kNone) {
    for (Index i = 0; i < 3; ++i) {
      const Index across = mesh_.across[face.triangle][i];
      if ((across == kNone && polygon_) || !passable(face.triangle, i)) continue;
      enter(across == kNone ? Face{face.triangle, i} : Face{across});
    }
    return;
  }
  if (passable(face.triangle, face.outside_of)) enter(Face{face.triangle});
  for (const Index v : ends(face.triangle, face.outside_of)) {
    const bool corner = v == t[0] || v == t[1] || v == t[2];
    if (corner || circle_side(at[0], at[1], at[2], mesh_.at(v)) <= 0) continue;
    for (const Face& other : rim_at_[v]) enter(other);
  }
}

std::size_t PlainFlood::count(const Corners& t, std::size_t most) const {
  std::set<Face> entered;
  std::vector<Face> queue;
  std::set<Index> counted;
  const auto enter = [&](const Face& face) {
    if (entered.insert(face).second) queue.push_back(face);
  };
  const Index first = first_triangle(t);
  if (first != kNone) enter({first});
  for (std::size_t i = 0; i < queue.size() && counted.size() < most; ++i) {
    const Face face = queue[i];
    for (const Index v : mesh_.triangles[face.triangle]) {
      if (v == t[0] || v == t[1] || v == t[2]) continue;
      if (face.outside_of != kNone) {
        const auto [a, b] = ends(face.triangle, face.outside_of);
        if (v != a && v != b) continue;
      }
      if (counts_as_inside(mesh_.at(t[0]), mesh_.at(t[1]), mesh_.at(t[2]), mesh_.at(v))) counted.insert(v);
    }
    for_faces_beside(t, face, enter);
  }
  return std::min(counted.size(), most);
}

}  // namespace thalweg::verify
