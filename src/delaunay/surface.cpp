// Point location and interpolation.
//
// 1. Start: a grid of about one cell a triangle-dozen remembers a triangle near each cell.
// 2. Walk: from triangle to triangle across an edge that has p strictly on its far side; the edge that is
//    tried first is chosen pseudo-randomly, which ends with probability one in every triangulation
//    (Devillers, Pion, Teillaud, Walking in a triangulation, 2002). The choice is seeded by the walk itself,
//    so that equal calls take equal steps; the supports found do not depend on it.
// 3. A walk that leaves through the rim proves p outside if the surface is convex. Else a tree of the
//    triangles' boxes answers.
// 4. Interpolation sorts its supports by position first, so rounding is the same whatever the order of ids.
#include "box_tree.hpp"

#include <thalweg/delaunay/surface.hpp>
#include <thalweg/geometry/predicates.hpp>

#include <cmath>
#include <numeric>
#include <utility>

namespace thalweg {

namespace {

constexpr std::size_t kTrianglesPerCell = 12;

double cross(Point2 from, Point2 p, Point2 q) {
  return (p.x - from.x) * (q.y - from.y) - (p.y - from.y) * (q.x - from.x);
}

// True if the rim is one loop that never turns right.
bool is_convex(const Tin& tin) {
  std::vector<HalfedgeId> rim_from(tin.vertex_count());
  std::size_t rim_count = 0;
  HalfedgeId first;
  for (std::size_t i = 0; i < tin.halfedge_count(); ++i) {
    const HalfedgeId h{i};
    if (!tin.on_rim(h)) continue;
    if (rim_from[tin.origin(h).index()].valid()) return false;
    rim_from[tin.origin(h).index()] = first = h;
    ++rim_count;
  }
  if (!first.valid()) return false;
  HalfedgeId h = first;
  std::size_t steps = 0;
  do {
    const HalfedgeId next = rim_from[tin.target(h).index()];
    if (orientation(tin.point(tin.origin(h)), tin.point(tin.target(h)), tin.point(tin.target(next))) < 0) {
      return false;
    }
    h = next;
    ++steps;
  } while (h != first);
  return steps == rim_count;
}

// The place of p in triangle t, or none.
std::optional<SurfacePlace> place_in(const Tin& tin, TriangleId t, Point2 p) {
  const Triangle& corners = tin.triangle(t);
  std::array<int, 3> side{};
  for (std::size_t i = 0; i < 3; ++i) {
    side[i] = orientation(tin.point(corners[i]), tin.point(corners[(i + 1) % 3]), p);
    if (side[i] < 0) return std::nullopt;
  }
  SurfacePlace place{.triangle = t, .supports = {}, .support_count = 0};
  for (std::size_t i = 0; i < 3; ++i) {
    // A corner is a support unless p lies on the side opposite to it.
    if (side[(i + 1) % 3] == 0) continue;
    std::size_t at = place.support_count++;
    for (; at > 0 && tin.point(corners[i]) < tin.point(place.supports[at - 1]); --at) {
      place.supports[at] = place.supports[at - 1];
    }
    place.supports[at] = corners[i];
  }
  return place;
}

}  // namespace

double interpolate_on_segment(Point2 a, double z_a, Point2 b, double z_b, Point2 p) {
  if (z_a == z_b) return z_a;
  if (b < a) {
    std::swap(a, b);
    std::swap(z_a, z_b);
  }
  const double dx = b.x - a.x;
  const double dy = b.y - a.y;
  const double squared = dx * dx + dy * dy;
  const double t = squared > 0 ? ((p.x - a.x) * dx + (p.y - a.y) * dy) / squared : 0;
  return std::clamp(std::lerp(z_a, z_b, std::clamp(t, 0.0, 1.0)), std::min(z_a, z_b), std::max(z_a, z_b));
}

double interpolate_on_triangle(const std::array<Point2, 3>& corners, const std::array<double, 3>& z,
                               Point2 p) {
  std::array<std::size_t, 3> order{0, 1, 2};
  std::sort(order.begin(), order.end(), [&](auto i, auto j) { return corners[i] < corners[j]; });
  const auto [i, j, k] = order;
  const auto [low, high] = std::minmax({z[0], z[1], z[2]});
  if (low == high) return low;
  const double at_i = std::abs(cross(p, corners[j], corners[k]));
  const double at_j = std::abs(cross(p, corners[k], corners[i]));
  const double at_k = std::abs(cross(p, corners[i], corners[j]));
  const double sum = at_i + at_j + at_k;
  const double rise = sum > 0 ? (at_j * (z[j] - z[i]) + at_k * (z[k] - z[i])) / sum : 0;
  return std::clamp(z[i] + rise, low, high);
}

struct SurfaceLocator::Index {
  Box2 box;
  std::size_t cells = 1;  // a side
  std::vector<TriangleId> starts;
  bool convex = false;
  BoxTree tree;  // only if not convex

  explicit Index(const Tin& tin) : box(bounding_box(tin.points())), convex(is_convex(tin)) {
    const double wanted = static_cast<double>(tin.triangle_count()) / kTrianglesPerCell;
    cells = std::max<std::size_t>(1, static_cast<std::size_t>(std::sqrt(wanted)));
    starts.resize(cells * cells);
    for (std::size_t t = tin.triangle_count(); t-- > 0;) {
      starts[cell(tin.point(tin.triangle(TriangleId{t})[0]))] = TriangleId{t};
    }
    TriangleId last{0};
    for (TriangleId& start : starts) last = start = start.valid() ? start : last;
    if (!convex) build_tree(tin);
  }

  void build_tree(const Tin& tin) {
    std::vector<Box2> boxes(tin.triangle_count());
    std::vector<std::uint32_t> items(tin.triangle_count());
    std::iota(items.begin(), items.end(), 0U);
    for (std::size_t t = 0; t < boxes.size(); ++t) {
      for (const VertexId v : tin.triangle(TriangleId{t})) boxes[t].add(tin.point(v));
    }
    tree = BoxTree(boxes, items, Progress());
  }

  [[nodiscard]] std::size_t cell(Point2 p) const {
    const auto step = [&](double offset, double extent) {
      const double scaled = extent > 0 ? offset / extent * static_cast<double>(cells) : 0;
      return std::min(cells - 1, static_cast<std::size_t>(std::max(0.0, scaled)));
    };
    return step(p.y - box.y_min, box.height()) * cells + step(p.x - box.x_min, box.width());
  }
};

SurfaceLocator::SurfaceLocator(const Tin& tin) : tin_(tin), index_(std::make_unique<Index>(tin)) {}
SurfaceLocator::~SurfaceLocator() = default;

std::optional<SurfacePlace> SurfaceLocator::locate(Point2 p, TriangleId hint) const {
  if (tin_.triangle_count() == 0 || !index_->box.contains(p)) return std::nullopt;
  TriangleId t = hint.valid() ? hint : index_->starts[index_->cell(p)];
  std::uint32_t choice = 1;
  HalfedgeId entered;
  for (bool inside = false; !inside;) {
    choice = choice * 1664525U + 1013904223U;  // Numerical Recipes' generator; its top bits are used
    inside = true;
    for (std::size_t i = 0; i < 3 && inside; ++i) {
      const HalfedgeId h = Tin::halfedge(t, (i + (choice >> 30U)) % 3);
      if (h == entered) continue;
      if (orientation(tin_.point(tin_.origin(h)), tin_.point(tin_.target(h)), p) >= 0) continue;
      inside = false;
      entered = tin_.twin(h);
      if (entered.valid()) t = Tin::triangle_of(entered);
    }
    if (inside) return place_in(tin_, t, p);
    if (!entered.valid()) break;
  }
  if (index_->convex) return std::nullopt;
  std::optional<SurfacePlace> found;
  index_->tree.visit(box_around(p, 0), [&](std::uint32_t item) {
    if (!found || TriangleId{item} < found->triangle) {
      if (const auto place = place_in(tin_, TriangleId{item}, p)) found = place;
    }
  });
  return found;
}

std::optional<double> SurfaceLocator::height_at(Point2 p, TriangleId hint) const {
  const auto place = locate(p, hint);
  if (!place) return std::nullopt;
  return height(*place, p);
}

double SurfaceLocator::height(const SurfacePlace& place, Point2 p) const {
  const auto& [a, b, c] = place.supports;
  if (place.support_count == 1) return tin_.height(a);
  if (place.support_count == 2) {
    return interpolate_on_segment(tin_.point(a), tin_.height(a), tin_.point(b), tin_.height(b), p);
  }
  return interpolate_on_triangle({tin_.point(a), tin_.point(b), tin_.point(c)},
                                 {tin_.height(a), tin_.height(b), tin_.height(c)}, p);
}

}  // namespace thalweg
