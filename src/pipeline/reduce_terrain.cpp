// Fewer vertices.
//
// 1. Without lonely ones: the ground is triangulated again from those that stay.
// 2. Simplified: the vertices that `simplify` keeps. Where the outline is not convex it becomes the boundary
//    of the ground: what lies outside would be triangulated differently with fewer vertices, and paths there
//    would mean nothing.
#include "pipeline/reduce_terrain.hpp"

#include <thalweg/base/error.hpp>
#include <thalweg/delaunay/simplify.hpp>
#include <thalweg/delaunay/triangulate.hpp>
#include <thalweg/mesh/change_tin.hpp>

#include <algorithm>
#include <numeric>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace thalweg {

namespace {

/// The ranks of some numbers below `limit`, all different.
std::vector<VertexId> ranks_of(std::span<const VertexId> numbers, std::size_t limit) {
  std::vector<std::uint32_t> rank(limit, 0);
  for (const VertexId number : numbers) rank[number.index()] = 1;
  std::exclusive_scan(rank.begin(), rank.end(), rank.begin(), 0U);
  std::vector<VertexId> ranks;
  ranks.reserve(numbers.size());
  for (const VertexId number : numbers) ranks.emplace_back(rank[number.index()]);
  return ranks;
}

/// What a terrain knows of some of its vertices, besides the ground.
Terrain attributes_of(const Terrain& terrain, std::span<const VertexId> vertices) {
  Terrain part;
  part.mode = terrain.mode;
  for (const VertexId v : vertices) {
    if (!terrain.written.empty()) part.written.push_back(terrain.written[v.index()]);
    if (!terrain.continuous.empty()) part.continuous.push_back(terrain.continuous[v.index()]);
    part.vertex_source.push_back(terrain.vertex_source[v.index()]);
    part.number.push_back(terrain.number[v.index()]);
  }
  part.number = ranks_of(part.number, terrain.number.size());
  return part;
}

std::string_view name_of(SimplifyStop stop) {
  switch (stop) {
    case SimplifyStop::MaxError:
      return "max-error";
    case SimplifyStop::MaxVertices:
      return "max-points";
    case SimplifyStop::Exact:
      break;
  }
  return "exact";
}

/// Which vertices are in a triangle of the surface.
std::vector<bool> used_vertices(const Terrain& terrain) {
  const Tin& ground = terrain.ground;
  std::vector<bool> used(ground.vertex_count(), false);
  for (std::size_t t = 0; t < ground.triangle_count(); ++t) {
    if (!terrain.keep[t]) continue;
    for (const VertexId v : ground.triangle(TriangleId{t})) used[v.index()] = true;
  }
  return used;
}

}  // namespace

Terrain without_lonely_vertices(Terrain terrain, TriangulationEngine engine, Progress& progress) {
  if (terrain.whole()) return terrain;  // every vertex is in a triangle of the ground
  const Tin& ground = terrain.ground;
  const std::vector<bool> used = used_vertices(terrain);
  if (std::find(used.begin(), used.end(), false) == used.end()) return terrain;

  std::vector<VertexId> renamed(ground.vertex_count()), stay;
  std::vector<Point2> points;
  std::vector<double> heights;
  for (std::size_t v = 0; v < ground.vertex_count(); ++v) {
    if (!used[v]) continue;
    renamed[v] = VertexId{points.size()};
    points.push_back(ground.points()[v]);
    heights.push_back(ground.heights()[v]);
    stay.emplace_back(v);
  }
  Terrain result = attributes_of(terrain, stay);
  std::vector<Triangle> kept;
  for (std::size_t t = 0; t < ground.triangle_count(); ++t) {
    if (!terrain.keep[t]) continue;
    const Triangle& corner = ground.triangle(TriangleId{t});
    kept.push_back({renamed[corner[0].index()], renamed[corner[1].index()], renamed[corner[2].index()]});
  }
  std::vector<ConstraintEdge> constraints;
  for (const ConstraintEdge& edge : ground.constraint_edges()) {
    const ConstraintEdge moved{renamed[edge.a.index()], renamed[edge.b.index()], edge.kind};
    if (moved.a.valid() && moved.b.valid()) constraints.push_back(moved);
  }
  if (terrain.mode == GroundMode::Polygon) {
    result.ground = Tin(std::move(points), std::move(heights), std::move(kept), constraints);
    result.keep.assign(result.ground.triangle_count(), true);
    return result;
  }
  result.ground = triangulate(std::move(points), std::move(heights), constraints, progress, engine);
  result.keep.assign(result.ground.triangle_count(), false);
  std::sort(kept.begin(), kept.end());
  std::size_t found = 0;
  for (std::size_t t = 0; t < result.ground.triangle_count() && found < kept.size(); ++t) {
    if (result.ground.triangle(TriangleId{t}) != kept[found]) continue;
    result.keep[t] = true;
    ++found;
  }
  if (found < kept.size()) {
    throw Error(ErrorCode::Internal,
                "a triangle is lost when vertices outside of the surface are taken away");
  }
  return result;
}

Terrain simplified(Terrain terrain, const SimplifyLimits& limits, const Plane& plane, Report& report,
                   Progress& progress) {
  const Tin dense = keep_triangles(std::move(terrain.ground), terrain.keep);
  SimplifyOptions options{
      .max_vertices = limits.max_points, .written = terrain.continuous, .engine = limits.engine};
  const double unit = plane.vertical_metres_per_unit();
  if (limits.max_error_m) options.max_error = *limits.max_error_m / unit;
  Simplified simple = simplify(dense, options, progress);

  ReportSimplification& told = report.simplification.emplace();
  told.max_error_m = limits.max_error_m;
  told.max_points = limits.max_points;
  told.stopped_by = name_of(simple.stop);
  told.source_points = dense.vertex_count();
  told.fixed_vertices = simple.fixed;
  told.inserted_vertices = simple.kept.size() - simple.fixed;
  if (limits.max_points && simple.fixed > *limits.max_points) {
    report.notes.push_back("lines and outline alone have " + std::to_string(simple.fixed) +
                           " vertices, more than --max-points");
  }
  Terrain result = attributes_of(terrain, simple.kept);
  if (simple.outlined) result.mode = GroundMode::Polygon;
  result.ground = std::move(simple.tin);
  result.keep.assign(result.ground.triangle_count(), true);
  LeftOutPoints& left_out = result.left_out;
  for (const VertexId v : simple.left_out) {
    left_out.xy.push_back(dense.point(v));
    left_out.z.push_back(dense.height(v));
  }
  left_out.triangle = std::move(simple.left_out_in);
  result.error_limit = std::max(options.max_error.value_or(0), simple.max_error);
  return result;
}

}  // namespace thalweg
