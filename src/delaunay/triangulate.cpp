// The constrained Delaunay triangulation of vertices that are fit for it.
//
// 1. Vertices are numbered anew along a Hilbert curve: what is close in the plane is close in memory.
// 2. Delaunay triangulation of the vertices (flat_delaunay.cpp), then constraint edges (edge_insertion.cpp).
//    Both decide by the tie rule, which makes the outcome unique: no order matters.
// 3. Finite cells become triangles of the vertices as they were given.
#include "base/parallel.hpp"
#include "base/release.hpp"
#include "edge_insertion.hpp"
#include "engine.hpp"
#include "flat_delaunay.hpp"
#include "spatial_order.hpp"

#include <thalweg/base/error.hpp>
#include <thalweg/delaunay/triangulate.hpp>

#include <algorithm>
#include <limits>
#include <numeric>
#include <string>
#include <utility>

namespace thalweg {

namespace detail {

namespace {

constexpr std::size_t kBlock = 8192;

void fill_finite(std::span<const Cell> cells, std::uint32_t infinity, LinkedTriangles& finite) {
  const auto is_finite = [&](const Cell& cell) {
    const auto [u, v, w] = cell.vertex;
    return u != infinity && v != infinity && w != infinity;
  };
  const auto in_blocks = [&](const auto& body) { for_each_block(cells.size(), kBlock, Progress(), body); };
  std::vector<std::uint32_t> first(cells.size() / kBlock + 2, 0);  // for each block: how many lie before it
  in_blocks([&](std::size_t begin, std::size_t end) {
    first[begin / kBlock + 1] =
        static_cast<std::uint32_t>(std::ranges::count_if(cells.subspan(begin, end - begin), is_finite));
  });
  std::partial_sum(first.begin(), first.end(), first.begin());
  RawVector<TriangleId> place(cells.size());
  in_blocks([&](std::size_t begin, std::size_t end) {
    std::uint32_t next = first[begin / kBlock];
    for (std::size_t c = begin; c < end; ++c)
      place[c] = is_finite(cells[c]) ? TriangleId{next++} : TriangleId{};
  });
  finite.corners.resize(first.back());
  finite.twins.resize(3 * std::size_t{first.back()});
  in_blocks([&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c) {
      if (!place[c].valid()) continue;
      for (std::uint32_t corner = 0; corner < 3; ++corner) {
        finite.corners[place[c].index()][corner] = VertexId{cells[c].vertex[corner]};
        const std::uint32_t across = cells[c].neighbour[before(corner)];
        const TriangleId twin = place[cell_of(across)];
        finite.twins[Tin::halfedge(place[c], corner).index()] =
            twin.valid() ? Tin::halfedge(twin, after(corner_of(across))) : HalfedgeId{};
      }
    }
  });
}

}  // namespace

Triangulated triangulate_flat(std::span<const Point2> points, std::span<const VertexPair> edges,
                              Progress& progress) {
  Triangulated result;
  std::vector<std::uint32_t> order = hilbert_order(points, progress);
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  RawVector<Point2> positions(points.size() + 1);
  for_each_block(order.size(), kBlock, progress, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) positions[v] = points[order[v]];
  });
  positions.back() = {kNaN, kNaN};
  const Positions at{positions};
  const std::uint32_t infinity = at.infinity();
  RawVector<Cell> cells = delaunay_cells(at, progress);
  progress.advance(0.9);
  if (!edges.empty() && !cells.empty()) {
    std::vector<std::uint32_t> number(points.size());
    for (std::size_t v = 0; v < order.size(); ++v) number[order[v]] = static_cast<std::uint32_t>(v);
    std::vector<VertexPair> renumbered;
    renumbered.reserve(edges.size());
    for (const VertexPair& edge : edges) {
      renumbered.emplace_back(std::minmax(number[edge.first], number[edge.second]));
    }
    std::sort(renumbered.begin(), renumbered.end());
    if (const auto fault = insert_edges(at, cells, renumbered, progress)) {
      result.crossing = std::minmax(order[fault->edge.first], order[fault->edge.second]);
      return result;
    }
  }
  release(positions);
  if (!std::is_sorted(order.begin(), order.end())) {
    result.triangles.number.reserve(order.size());
    for (const std::uint32_t v : order) result.triangles.number.emplace_back(v);
  }
  release(order);
  fill_finite(cells, infinity, result.triangles);
  return result;
}

}  // namespace detail

namespace {

std::string describe(Point2 p) {
  return "(" + std::to_string(p.x) + ", " + std::to_string(p.y) + ")";
}

std::vector<detail::VertexPair> pairs_of(std::span<const ConstraintEdge> constraints) {
  std::vector<detail::VertexPair> edges;
  edges.reserve(constraints.size());
  for (const ConstraintEdge& edge : constraints) {
    edges.emplace_back(std::minmax(edge.a.value(), edge.b.value()));
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

}  // namespace

std::string_view engine_name(TriangulationEngine engine) {
  return engine == TriangulationEngine::Flat ? "flat" : "cgal";
}

Tin triangulate(std::vector<Point2> points, std::vector<double> heights,
                std::span<const ConstraintEdge> constraints, Progress& progress, TriangulationEngine engine) {
  if (points.size() < 3) {
    throw Error(ErrorCode::TooFewPoints,
                "a triangulation needs three distinct points, there are " + std::to_string(points.size()));
  }
  progress.start_phase("triangulating");
  const std::vector<detail::VertexPair> edges = pairs_of(constraints);
  detail::Triangulated result = engine == TriangulationEngine::Flat
                                    ? detail::triangulate_flat(points, edges, progress)
                                    : detail::triangulate_by_cgal(points, edges, progress);
  if (result.crossing) {
    throw Error(ErrorCode::InvalidTin,
                "the constraint edge from " + describe(points[result.crossing->first]) + " to " +
                    describe(points[result.crossing->second]) + " crosses another one, or a vertex");
  }
  if (result.triangles.corners.empty()) {
    throw Error(ErrorCode::Collinear, "all " + std::to_string(points.size()) +
                                          " points lie on one line, from " + describe(points.front()) +
                                          "; a triangulation needs a point beside it");
  }
  progress.advance(1);
  if (result.triangles.twins.empty()) {
    const RawVector<Triangle>& corners = result.triangles.corners;
    return {std::move(points), std::move(heights), {corners.begin(), corners.end()}, constraints};
  }
  return {std::move(points), std::move(heights), std::move(result.triangles), constraints, progress};
}

}  // namespace thalweg
