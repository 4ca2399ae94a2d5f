// The optimisation of a TIN that exists.
//
// Vertices are numbered along a curve until the outputs are written.
// The vertices and constraint edges are triangulated anew (constrained Delaunay); an edge of the outline that
// is missing there is added as a boundary constraint and the triangulation repeated. The surface is what lies
// inside of the outline: a flood from the inner side of every outline edge that does not cross the outline.
#include "delaunay/spatial_order.hpp"
#include "pipeline/condition_tin.hpp"
#include "pipeline/higher_order.hpp"
#include "pipeline/loaded_tin.hpp"
#include "pipeline/outlets.hpp"
#include "pipeline/plane.hpp"
#include "pipeline/surface.hpp"

#include <thalweg/base/error.hpp>
#include <thalweg/delaunay/triangulate.hpp>
#include <thalweg/delaunay/trim.hpp>
#include <thalweg/io/read_tin.hpp>
#include <thalweg/mesh/change_tin.hpp>
#include <thalweg/pipeline/build.hpp>

#include <algorithm>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace thalweg {

namespace {

/// The TIN file without the vertices that are in no triangle, nor at a constraint edge; the others are along
/// a curve, so that what is close in the plane is close in memory. For each its rank in the file is returned.
std::vector<VertexId> order_vertices(TinFile& file, const std::string& path, Report& report,
                                     Progress& progress) {
  std::vector<bool> used(file.points.size());
  for (const Triangle& t : file.triangles) {
    for (const VertexId v : t) used[v.index()] = true;
  }
  for (const ConstraintEdge& edge : file.constraints) used[edge.a.index()] = used[edge.b.index()] = true;
  std::vector<std::uint32_t> ids;  // in the file, by rank
  std::vector<Point2> points;
  for (std::size_t v = 0; v < used.size(); ++v) {
    if (!used[v]) continue;
    ids.push_back(static_cast<std::uint32_t>(v));
    points.push_back(file.points[v]);
  }
  report.tin.vertices_left_out = used.size() - ids.size();
  // One beside the surface may be left out; inside of it there must be none.
  if (report.tin.vertices_left_out > 0) refuse_broken(load_tin(file, path, progress).tin, path);
  const std::vector<std::uint32_t> order = hilbert_order(points, progress);
  const auto sorted = [&](const auto& values) {
    std::remove_cvref_t<decltype(values)> moved;
    moved.reserve(order.size());
    for (const std::uint32_t rank : order) moved.push_back(values[ids[rank]]);
    return moved;
  };
  file.points = sorted(file.points);
  file.heights = sorted(file.heights);
  if (!file.vertex_source.empty()) file.vertex_source = sorted(file.vertex_source);
  std::vector<VertexId> now(used.size());
  for (std::size_t v = 0; v < order.size(); ++v) now[ids[order[v]]] = VertexId{v};
  for (Triangle& t : file.triangles) {
    for (VertexId& v : t) v = now[v.index()];
  }
  for (ConstraintEdge& edge : file.constraints) {
    edge.a = now[edge.a.index()];
    edge.b = now[edge.b.index()];
  }
  return {order.begin(), order.end()};
}

std::vector<std::pair<VertexId, VertexId>> outline_of(const Tin& tin) {
  std::vector<std::pair<VertexId, VertexId>> outline;
  for (std::size_t i = 0; i < tin.halfedge_count(); ++i) {
    const HalfedgeId h{i};
    if (tin.on_rim(h)) outline.emplace_back(tin.origin(h), tin.target(h));
  }
  return outline;
}

bool bounds(EdgeKind kind) {
  return has(kind, EdgeKind::Boundary | EdgeKind::Hole);
}

/// Where the outline is not all edges of the Delaunay triangulation, or some of it is drawn, it bounds the
/// ground, and all of it is constrained.
Terrain triangulate_again(const TinFile& file, std::vector<Point2> plane_points, const std::string& path,
                          Progress& progress) {
  const Tin given = [&]() -> Tin {
    try {
      Tin tin(plane_points, file.heights, file.triangles, file.constraints);
      refuse_broken(tin, path);
      return tin;
    } catch (const Error&) {
      refuse_broken(load_tin(path, progress).tin, path);  // by the numbers of the file
      throw;
    }
  }();
  const auto outline = outline_of(given);
  std::vector<ConstraintEdge> constraints = given.constraint_edges();
  Terrain terrain;
  terrain.ground = triangulate(plane_points, file.heights, constraints, progress);
  const bool bounded = std::any_of(constraints.begin(), constraints.end(),
                                   [](const ConstraintEdge& edge) { return bounds(edge.kind); }) ||
                       std::any_of(outline.begin(), outline.end(), [&](const auto& edge) {
                         return !terrain.ground.find_halfedge(edge.first, edge.second).valid() &&
                                !terrain.ground.find_halfedge(edge.second, edge.first).valid();
                       });
  if (bounded) {
    for (const auto& [a, b] : outline) {
      if (!bounds(given.kind(given.find_halfedge(a, b)))) constraints.push_back({a, b, EdgeKind::Boundary});
    }
    terrain.ground = triangulate(std::move(plane_points), file.heights, constraints, progress);
  }
  terrain.keep = inside_outline(terrain.ground, outline);
  if (bounded) {
    terrain.mode = GroundMode::Polygon;
    terrain.ground = keep_triangles(terrain.ground, terrain.keep);
    terrain.keep.assign(terrain.ground.triangle_count(), true);
  }
  return terrain;
}

std::vector<std::string> sources_of(const OptimizeConfig& config) {
  std::vector<std::string> sources = {config.input};
  for (const SourceSpec& outlets : config.condition.outlets) sources.push_back(outlets.path);
  if (config.labelling.reference) sources.push_back(config.labelling.reference->path);
  return sources;
}

}  // namespace

BuiltTin optimized_tin(const OptimizeConfig& config, Progress& progress) {
  Stopwatch watch;
  BuiltTin built;
  Report& report = built.report;
  report.command = "optimize";
  report.engine = engine_name(TriangulationEngine::Flat);
  check_condition(config.condition, config.labelling, config.output);
  check_choice_by_faces(config.labelling, config.output, false);
  RunOutputs outputs(config.output, sources_of(config));

  progress.start_phase("read");
  TinFile file = read_tin(config.input, progress);
  std::vector<VertexId> number = order_vertices(file, config.input, report, progress);
  const CrsInfo crs = describe_crs(file.crs);
  report.notes = file.notes;
  note_assumptions(crs, file.points, report);
  const Plane plane(crs, file.points);
  report.input.points_read = file.points.size() + report.tin.vertices_left_out;
  report.input.points_used = file.points.size();
  std::vector<Point2> outlets = read_places(config.condition.outlets, crs, progress);
  progress.advance(1);
  report.timings_s.read = watch.lap();

  progress.start_phase("triangulate");
  Terrain terrain = triangulate_again(file, plane.to_plane(file.points, progress), config.input, progress);
  terrain.vertex_source = std::move(file.vertex_source);
  terrain.number = std::move(number);
  if (plane.projected()) {
    terrain.written = file.points;
    terrain.continuous = plane.to_lonlat(file.points);
  }
  progress.advance(1);

  finish_run(
      std::move(terrain),
      {plane, crs, config.labelling, config.condition, config.output, outputs, watch, std::move(outlets), {}},
      built, progress);
  return built;
}

Report optimize_tin(const OptimizeConfig& config, Progress& progress) {
  return optimized_tin(config, progress).report;
}

}  // namespace thalweg
