// The constrained Delaunay triangulation of vertices that are fit for it.
//
// 1. Vertices are numbered anew along a Hilbert curve: what is close in the plane is close in memory.
// 2. Delaunay triangulation of the vertices (flat_delaunay.cpp), then constraint edges (edge_insertion.cpp).
//    Both decide by the tie rule, which makes the outcome unique: no order matters.
// 3. Finite cells become triangles of the vertices as they were given, sorted where they lie.
#include "base/large_pages.hpp"
#include "base/parallel.hpp"
#include "base/release.hpp"
#include "edge_insertion.hpp"
#include "engine.hpp"
#include "flat_delaunay.hpp"
#include "mesh/link_triangles.hpp"
#include "spatial_order.hpp"

#include <thalweg/base/error.hpp>
#include <thalweg/delaunay/triangulate.hpp>

#include <algorithm>
#include <limits>
#include <string>
#include <utility>

namespace thalweg {

namespace detail {

namespace {

constexpr std::size_t kBlock = 8192;

/// Cells that are no ghosts, as a source for sorting.
struct FiniteCells {
  std::span<Cell> cells;
  std::uint32_t infinity = 0;

  [[nodiscard]] std::size_t size() const { return cells.size(); }
  [[nodiscard]] bool exists(std::size_t c) const {
    const auto& [u, v, w] = cells[c].vertex;
    return u != infinity && v != infinity && w != infinity;
  }
  [[nodiscard]] VertexId corner(std::size_t c, std::size_t i) const { return VertexId{cells[c].vertex[i]}; }
  [[nodiscard]] SourceSide across(std::size_t c, std::uint32_t i) const {
    const std::uint32_t side = cells[c].neighbour[before(i)];
    return {cell_of(side), after(corner_of(side))};
  }
  [[nodiscard]] EdgeKind kind(std::size_t c, std::uint32_t i) const { return cells[c].kind[before(i)]; }
  void forget(std::size_t begin) const { discard_pages(cells.subspan(begin)); }
};

/// The same between vertices of other numbers, sorted.
std::vector<DrawnEdge> renumbered(std::span<const DrawnEdge> edges, std::span<const std::uint32_t> order) {
  std::vector<std::uint32_t> number(order.size());
  for (std::size_t v = 0; v < order.size(); ++v) number[order[v]] = static_cast<std::uint32_t>(v);
  std::vector<DrawnEdge> moved;
  moved.reserve(edges.size());
  for (const auto& [ends, kind] : edges) {
    moved.push_back({std::minmax(number[ends.first], number[ends.second]), kind});
  }
  std::ranges::sort(moved, {}, &DrawnEdge::ends);
  return moved;
}

}  // namespace

Triangulated triangulate_flat(std::span<const Point2> points, std::span<const DrawnEdge> edges,
                              PointOrder points_are, Progress& progress) {
  Triangulated result;
  std::vector<std::uint32_t> order;  // empty if it is that of the points
  if (points_are != PointOrder::AlongCurve) order = hilbert_order(points, progress);
  if (std::is_sorted(order.begin(), order.end())) release(order);
  const auto given = [&order](std::uint32_t v) { return order.empty() ? v : order[v]; };
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  RawVector<Point2> positions(points.size() + 1);
  for_each_block(points.size(), kBlock, progress, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      positions[v] = points[given(static_cast<std::uint32_t>(v))];
    }
  });
  positions.back() = {kNaN, kNaN};
  const Positions at{positions};
  const std::uint32_t infinity = at.infinity();
  RawVector<Cell> cells = delaunay_cells(at, progress);
  progress.advance(0.9);
  if (!edges.empty() && !cells.empty()) {
    const auto drawn = order.empty() ? std::vector(edges.begin(), edges.end()) : renumbered(edges, order);
    if (insert_edges(at, cells, drawn, range_count(points.size()), progress)) {
      // Of all that cannot be, name the first, whatever the number of threads.
      cells = delaunay_cells(at, progress);
      const auto fault = insert_edges(at, cells, drawn, 1, progress).value();
      result.crossing = std::minmax(given(fault.first), given(fault.second));
      return result;
    }
  }
  release(positions);
  std::vector<VertexId> number;
  number.reserve(order.size());
  for (const std::uint32_t v : order) number.emplace_back(v);
  release(order);
  const FiniteCells finite{cells, infinity};
  const TriangleOrder sorted = sort_triangles(finite, number, points.size(), progress);
  result.linked = link_triangles(finite, sorted, number, progress);
  return result;
}

namespace {

std::string describe(Point2 p) {
  return "(" + std::to_string(p.x) + ", " + std::to_string(p.y) + ")";
}

/// Each pair of vertices once, with all its kinds; sorted.
std::vector<DrawnEdge> drawn_edges(std::span<const ConstraintEdge> constraints, std::size_t vertex_count) {
  std::vector<DrawnEdge> all;
  all.reserve(constraints.size());
  for (const ConstraintEdge& edge : constraints) {
    if (edge.a == edge.b || edge.a.index() >= vertex_count || edge.b.index() >= vertex_count) {
      throw Error(ErrorCode::InvalidTin, "the constraint edge between vertices " +
                                             std::to_string(edge.a.value()) + " and " +
                                             std::to_string(edge.b.value()) + " does not join two of the " +
                                             std::to_string(vertex_count));
    }
    all.push_back({std::minmax(edge.a.value(), edge.b.value()), edge.kind});
  }
  std::ranges::sort(all, {}, &DrawnEdge::ends);
  std::size_t count = 0;
  for (const DrawnEdge& edge : all) {
    if (count > 0 && all[count - 1].ends == edge.ends) {
      all[count - 1].kind = all[count - 1].kind | edge.kind;
    } else {
      all[count++] = edge;
    }
  }
  all.resize(count);
  return all;
}

}  // namespace

Tin triangulate(std::vector<Point2> points, std::vector<double> heights,
                std::span<const ConstraintEdge> constraints, PointOrder points_are, Progress& progress,
                TriangulationEngine engine) {
  if (points.size() < 3) {
    throw Error(ErrorCode::TooFewPoints,
                "a triangulation needs three distinct points, there are " + std::to_string(points.size()));
  }
  check_counts(2 * points.size(), points.size());
  progress.start_phase("triangulating");
  const std::vector<DrawnEdge> edges = drawn_edges(constraints, points.size());
  Triangulated result = engine == TriangulationEngine::Flat
                            ? triangulate_flat(points, edges, points_are, progress)
                            : triangulate_by_cgal(points, edges, progress);
  if (result.crossing) {
    throw Error(ErrorCode::InvalidTin,
                "the constraint edge from " + describe(points[result.crossing->first]) + " to " +
                    describe(points[result.crossing->second]) + " crosses another one, or a vertex");
  }
  if (result.linked.corners.empty() && result.plain.empty()) {
    throw Error(ErrorCode::Collinear, "all " + std::to_string(points.size()) +
                                          " points lie on one line, from " + describe(points.front()) +
                                          "; a triangulation needs a point beside it");
  }
  progress.advance(1);
  if (result.linked.corners.empty()) {
    return {std::move(points), std::move(heights), std::move(result.plain), constraints};
  }
  return {std::move(points), std::move(heights), std::move(result.linked)};
}

}  // namespace detail

std::string_view engine_name(TriangulationEngine engine) {
  return engine == TriangulationEngine::Flat ? "flat" : "cgal";
}

Tin triangulate(std::vector<Point2> points, std::vector<double> heights,
                std::span<const ConstraintEdge> constraints, Progress& progress, TriangulationEngine engine) {
  return detail::triangulate(std::move(points), std::move(heights), constraints, detail::PointOrder::Any,
                             progress, engine);
}

}  // namespace thalweg
