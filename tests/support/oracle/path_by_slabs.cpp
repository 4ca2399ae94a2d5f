// Vertical slabs.
//
// 1. Turn and scale the plane by a Gaussian integer, so that no two sites share an abscissa; clip each
//    constraint edge to the open disc. Cut the disc at the abscissas of all ends of clipped edges, of p and
//    of the circle's two extremes.
// 2. In a slab the clipped edges that span it do not meet: they and the two arcs bound a stack of cells.
// Cells of neighbouring slabs are joined where their sides overlap in more than a point.
// 3. p is joined to the triangle if a cell whose closure holds p is joined to the cell of a point of the
//    triangle. Numbers have 100 digits; those that differ do so by far more than kTolerance at the
//    coordinates of scenes.
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <support/oracle/path_by_slabs.hpp>

#include <algorithm>
#include <numeric>
#include <vector>

namespace thalweg::oracle {

namespace {

using Real =
    boost::multiprecision::number<boost::multiprecision::cpp_bin_float<100>, boost::multiprecision::et_off>;
const Real kTolerance("1e-50");

struct Place {
  Real x, y;
};

Place turned(const Spot& s) {
  constexpr std::int64_t kReal = 16411,
                         kImaginary = 8209;  // distinct abscissas: kReal > 2 * 2 * kCoordinateLimit
  const Real w(static_cast<std::int64_t>(s.w));
  const Real x = Real(static_cast<std::int64_t>(s.x)) / w, y = Real(static_cast<std::int64_t>(s.y)) / w;
  return {x * kReal - y * kImaginary, y * kReal + x * kImaginary};
}

struct Circle {
  Real x, y, radius;
  [[nodiscard]] Real height(const Real& at) const {
    const Real square = radius * radius - (at - x) * (at - x);
    return square > 0 ? Real(sqrt(square)) : Real(0);
  }
};

Circle circle_through(const Place& a, const Place& b, const Place& c) {
  const Real bx = b.x - a.x, by = b.y - a.y, cx = c.x - a.x, cy = c.y - a.y;
  const Real d = 2 * (bx * cy - by * cx), b2 = bx * bx + by * by, c2 = cx * cx + cy * cy;
  const Real ux = (cy * b2 - by * c2) / d, uy = (bx * c2 - cx * b2) / d;
  return {a.x + ux, a.y + uy, sqrt(ux * ux + uy * uy)};
}

// The part of a constraint edge in the disc, from left to right.
struct Piece {
  Place left, right;
  [[nodiscard]] Real height(const Real& at) const {
    return left.y + (right.y - left.y) * (at - left.x) / (right.x - left.x);
  }
};

// Appends the piece of ab in the open disc, if there is one.
std::vector<Piece> clipped(const Circle& circle, const Place& a, const Place& b) {
  const Real dx = b.x - a.x, dy = b.y - a.y, ax = a.x - circle.x, ay = a.y - circle.y;
  const Real square = dx * dx + dy * dy, half = ax * dx + ay * dy;
  const Real rest = ax * ax + ay * ay - circle.radius * circle.radius;
  const Real discriminant = half * half - square * rest;
  if (discriminant <= kTolerance) return {};
  const Real root = sqrt(discriminant);
  const Real first = std::max(Real(0), Real((-half - root) / square));
  const Real last = std::min(Real(1), Real((-half + root) / square));
  if (last - first <= kTolerance) return {};
  Piece piece{{a.x + first * dx, a.y + first * dy}, {a.x + last * dx, a.y + last * dy}};
  if (piece.right.x < piece.left.x) std::swap(piece.left, piece.right);
  return {piece};
}

// Between two curves of a slab; a missing piece stands for the circle's lower or upper arc.
struct Cell {
  const Piece* below = nullptr;
  const Piece* above = nullptr;
  std::size_t slab = 0;
  [[nodiscard]] Real low(const Circle& c, const Real& at) const {
    return below ? below->height(at) : c.y - c.height(at);
  }
  [[nodiscard]] Real high(const Circle& c, const Real& at) const {
    return above ? above->height(at) : c.y + c.height(at);
  }
};

struct Decomposition {
  Circle circle;
  std::vector<Piece> pieces;
  std::vector<Real> cuts;
  std::vector<Cell> cells;
  std::vector<std::size_t> group;

  [[nodiscard]] std::size_t root(std::size_t cell) const {
    while (group[cell] != cell) cell = group[cell];
    return cell;
  }
  void cut_at_ends(const Real& p_x) {
    cuts = {circle.x - circle.radius, circle.x + circle.radius, p_x};
    for (const Piece& piece : pieces) cuts.insert(cuts.end(), {piece.left.x, piece.right.x});
    std::sort(cuts.begin(), cuts.end());
    cuts.erase(std::unique(cuts.begin(), cuts.end(),
                           [](const Real& a, const Real& b) { return b - a < kTolerance; }),
               cuts.end());
  }
  void stack_cells() {
    for (std::size_t slab = 0; slab + 1 < cuts.size(); ++slab) {
      const Real middle = (cuts[slab] + cuts[slab + 1]) / 2;
      std::vector<const Piece*> spanning{nullptr};
      for (const Piece& piece : pieces) {
        if (piece.left.x < middle && middle < piece.right.x) spanning.push_back(&piece);
      }
      std::sort(spanning.begin() + 1, spanning.end(),
                [&](const Piece* a, const Piece* b) { return a->height(middle) < b->height(middle); });
      spanning.push_back(nullptr);
      for (std::size_t i = 0; i + 1 < spanning.size(); ++i)
        cells.push_back({spanning[i], spanning[i + 1], slab});
    }
  }
  void join_neighbours() {
    group.resize(cells.size());
    std::iota(group.begin(), group.end(), std::size_t{0});
    for (std::size_t a = 0; a < cells.size(); ++a) {
      for (std::size_t b = a + 1; b < cells.size(); ++b) {
        if (cells[b].slab != cells[a].slab + 1) continue;
        const Real& at = cuts[cells[b].slab];
        const Real low = std::max(cells[a].low(circle, at), cells[b].low(circle, at));
        const Real high = std::min(cells[a].high(circle, at), cells[b].high(circle, at));
        if (high - low > kTolerance) group[root(a)] = root(b);
      }
    }
  }
  [[nodiscard]] bool closure_holds(const Cell& cell, const Place& at) const {
    return cuts[cell.slab] - at.x < kTolerance && at.x - cuts[cell.slab + 1] < kTolerance &&
           cell.low(circle, at.x) - at.y < kTolerance && at.y - cell.high(circle, at.x) < kTolerance;
  }
};

}  // namespace

bool path_joins_by_slabs(const Scene& scene, Corners t, int p) {
  const Site u = scene.at(t[0]), v = scene.at(t[1]), w = scene.at(t[2]);
  Decomposition plan;
  plan.circle = circle_through(turned(spot_of(u)), turned(spot_of(v)), turned(spot_of(w)));
  for (const auto& [a, b] : scene.constraints) {
    const auto piece = clipped(plan.circle, turned(spot_of(scene.at(a))), turned(spot_of(scene.at(b))));
    plan.pieces.insert(plan.pieces.end(), piece.begin(), piece.end());
  }
  const Place end = turned(spot_of(scene.at(p)));
  plan.cut_at_ends(end.x);
  plan.stack_cells();
  plan.join_neighbours();
  const Place start = turned({u.x + v.x + w.x, u.y + v.y + w.y, 3});
  for (std::size_t a = 0; a < plan.cells.size(); ++a) {
    if (!plan.closure_holds(plan.cells[a], start)) continue;
    for (std::size_t b = 0; b < plan.cells.size(); ++b) {
      if (plan.root(a) == plan.root(b) && plan.closure_holds(plan.cells[b], end)) return true;
    }
  }
  return false;
}

}  // namespace thalweg::oracle
