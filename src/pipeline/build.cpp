// The main job.
//
// 1. Reserve the outputs, read the sources in one CRS; refuse what the memory cannot hold.
// 2. A geographic survey: points on a line become its vertices, pieces that bend are densified, everything is
//    projected to the metric plane, and lines get vertices where the plane has a point on their wrong side.
//    What is written back are the coordinates that came in.
// 3. Node and triangulate: the ground, with ids along a curve until the outputs are written.
// 4. Take from the surface what is outside of the data (nodata), rim triangles with long edges, and rim
//    triangles that are flat or turned over as written. Vertices that lose all triangles are out; the ground
//    is then that of the vertices that stay. (Every triangle that stays is constrained Delaunay among fewer
//    vertices too, so it is a triangle of the new ground.)
// 5. If asked for, leave out the vertices that few others stand for (reduce_terrain.cpp).
// 6. Optimise and write (surface.cpp).
#include "pipeline/condition_tin.hpp"
#include "pipeline/higher_order.hpp"
#include "pipeline/memory_estimate.hpp"
#include "pipeline/outlets.hpp"
#include "pipeline/plane_survey.hpp"
#include "pipeline/reduce_terrain.hpp"
#include "pipeline/surface.hpp"

#include <thalweg/base/error.hpp>
#include <thalweg/delaunay/trim.hpp>
#include <thalweg/mesh/change_tin.hpp>
#include <thalweg/pipeline/build.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

namespace thalweg {

namespace {

std::vector<std::uint8_t> origin_kinds(const Ground& ground) {
  std::vector<std::uint8_t> sources(ground.origins.size());
  std::transform(ground.origins.begin(), ground.origins.end(), sources.begin(),
                 [](const VertexOrigin& origin) { return static_cast<std::uint8_t>(origin.kind); });
  return sources;
}

/// Narrows a mask to the triangles that stay when the TIN of those kept so far loses some.
void narrow(std::vector<bool>& keep, const std::vector<bool>& stays) {
  std::size_t next = 0;
  for (auto&& kept : keep) {
    if (kept) kept = stays[next++];
  }
}

/// Around a pole there is a triangle that longitudes cannot hold: its corners lie on both sides of the line
/// opposite to the data's centre.
void refuse_pole(const Terrain& terrain, const std::vector<bool>& keep, const Plane& plane) {
  if (!plane.about_pole()) return;
  for (std::size_t t = 0; t < keep.size(); ++t) {
    if (!keep[t]) continue;
    const Triangle& corner = terrain.ground.triangle(TriangleId{t});
    const auto longitude = [&](std::size_t i) { return terrain.continuous[corner[i].index()].x; };
    const auto [low, high] = std::minmax({longitude(0), longitude(1), longitude(2)});
    if (high - low <= 180) continue;
    const bool north = terrain.continuous[corner[0].index()].y > 0;
    throw Error(ErrorCode::BadCoordinate,
                std::string("the TIN goes around the ") + (north ? "north" : "south") +
                    " pole, where longitude and latitude cannot hold its triangles; take a polar plane with "
                    "--t-crs, as EPSG:" +
                    (north ? "3413" : "3031") +
                    ", or cut the data with --bbox, or rim triangles with --max-edge");
  }
}

/// Meshes keep the longitudes that came in, which jump at the antimeridian, and most programs know no globe.
void note_antimeridian(const Terrain& terrain, const Plane& plane, Report& report) {
  if (!plane.projected()) return;
  const auto by_longitude = [](Point2 a, Point2 b) { return a.x < b.x; };
  const auto [west, east] = std::minmax_element(terrain.written.begin(), terrain.written.end(), by_longitude);
  if (west == terrain.written.end() || east->x - west->x <= plane.x_period() / 2) return;
  report.notes.emplace_back(
      "the TIN crosses the antimeridian: a mesh keeps the longitudes that came in, and QGIS and others draw "
      "its "
      "triangles there around the whole map; a projected CRS (--t-crs), longitudes from 0 to 360, or vector "
      "layers do not jump");
}

/// Which triangles of the ground are surface.
std::vector<bool> surface_triangles(const Terrain& terrain, const NodataRegion& nodata, const Plane& plane,
                                    std::optional<double> max_edge_m, const Progress& progress) {
  const Tin& ground = terrain.ground;
  std::vector<bool> keep(ground.triangle_count(), true);
  if (!nodata.empty()) {
    keep = drop_outside_triangles(ground, [&](TriangleId t) {
      if (t.index() % 4096 == 0) progress.check();
      const Triangle& corner = ground.triangle(t);
      const Point2 a = ground.point(corner[0]), b = ground.point(corner[1]), c = ground.point(corner[2]);
      return nodata.outside(plane.to_written({(a.x + b.x + c.x) / 3, (a.y + b.y + c.y) / 3}));
    });
  }
  if (max_edge_m) {
    narrow(keep,
           drop_long_rim_triangles(keep_triangles(ground, keep), *max_edge_m / plane.metres_per_unit()));
  }
  if (plane.projected()) {
    refuse_pole(terrain, keep, plane);
    narrow(keep, drop_turned_rim_triangles(keep_triangles(ground, keep), terrain.continuous));
  }
  if (std::ranges::find(keep, true) == keep.end()) {
    throw Error(ErrorCode::EmptyInput,
                "no triangle is left of the surface; look at --max-edge, --boundary, --nodata");
  }
  return keep;
}

/// Constraint edges that lie wholly outside of the surface go with its triangles: the report says how many.
void note_lost_edges(const Terrain& terrain, Report& report) {
  if (terrain.whole()) return;
  const Tin& ground = terrain.ground;
  const auto kept = [&](HalfedgeId h) { return h.valid() && terrain.keep[Tin::triangle_of(h).index()]; };
  const auto lost = std::ranges::count_if(ground.constraint_edges(), [&](const ConstraintEdge& edge) {
    return !kept(ground.find_halfedge(edge.a, edge.b)) && !kept(ground.find_halfedge(edge.b, edge.a));
  });
  if (lost == 0) return;
  report.notes.push_back(std::to_string(lost) +
                         " edges of lines lie where the surface ends (no data at a raster's frame, "
                         "--max-edge); they are left out");
}

void describe_input(const ReadResult& read, const Ground& ground, Report& report) {
  report.input.points_read = read.points_read;
  report.input.outside_bbox = read.outside_bbox;
  report.input.nodata_skipped = read.nodata_skipped;
  report.input.nodata_holes_bridged = read.nodata_holes;
  report.input.nodata_cells_bridged = read.bridged_cells;
  report.input.breaklines_read = read.breaklines_read;
  report.input.breakline_vertices = read.breakline_vertices;
  report.input.lines_outside_bbox = read.lines_outside_bbox;
  report.input.duplicates_merged = ground.duplicates_merged;
  report.input.outside_boundary = ground.outside_boundary;
  report.input.crossings = ground.crossings;
  report.input.lakes = ground.lakes;
  report.input.points_in_lakes = ground.points_in_lakes;
  report.input.snapping_pixel = ground.pixel;
  report.input.points_used = static_cast<std::size_t>(
      std::count_if(ground.origins.begin(), ground.origins.end(),
                    [](const VertexOrigin& origin) { return origin.kind == VertexOrigin::Kind::Point; }));
}

void check_changes(const BuildConfig& config, const OutputConfig& output) {
  check_condition(config.condition, config.labelling, output);
  const bool simplified = config.max_error_m || config.max_points;
  check_choice_by_faces(config.labelling, output, simplified);
  if (config.condition.steps.empty() || !simplified) return;
  throw Error(ErrorCode::Usage,
              "--condition changes heights, so that no error of a simplification could be told; simplify "
              "first, then condition what is left with thalweg optimize --condition");
}

GroundOptions ground_options(const BuildConfig& config, const Plane& plane) {
  GroundOptions options = config.ground;
  options.snap = config.snap_m / plane.metres_per_unit();
  if (plane.projected()) options.resolution = kGeographicResolutionM;
  options.numbering = Numbering::AlongCurve;
  return options;
}

/// At written coordinates.
std::vector<Conflict> conflicts_of(std::vector<Conflict> conflicts, const Plane& plane) {
  if (!plane.projected()) return conflicts;
  for (Conflict& conflict : conflicts) conflict.xy = plane.to_written(conflict.xy);
  return conflicts;
}

std::vector<std::string> sources_of(const BuildConfig& config) {
  std::vector<std::string> sources;
  for (const SourceSpec& points : config.points) sources.push_back(points.path);
  for (const LineSource& lines : config.lines) sources.push_back(lines.source.path);
  for (const SourceSpec& outlets : config.condition.outlets) sources.push_back(outlets.path);
  if (config.labelling.reference) sources.push_back(config.labelling.reference->path);
  return sources;
}

BuiltTin run_job(const BuildConfig& config, const MemorySource& memory, const OutputConfig& output,
                 Progress& progress) {
  Stopwatch watch;
  BuiltTin built;
  Report& report = built.report;
  report.command = "build";
  report.engine = engine_name(config.ground.engine);
  check_changes(config, output);
  RunOutputs outputs(output, sources_of(config));

  progress.start_phase("read");
  MemoryEstimate estimate(config);
  ReadOptions read_options = config.read;
  read_options.admit = [&estimate](std::size_t points) { estimate.require(points); };
  auto [read, plane, survey] = read_into_plane(config.points, config.lines, read_options, progress, memory);
  if (plane.projected()) estimate.add_projection();
  estimate.require(survey.survey.points.xy.size() + read.breakline_vertices);
  report.notes = read.notes;
  report.input.vertices_inserted_on_lines = survey.vertices_inserted_on_lines;
  note_crs(read.crs, survey.survey.points.xy, report.notes);  // what reading assumed it noted itself
  std::vector<Point2> outlets = read_places(config.condition.outlets, read.crs, progress);
  progress.advance(1);
  report.timings_s.read = watch.lap();

  progress.start_phase("triangulate");
  if (plane.projected()) survey.survey.to_source = [&back = plane](Point2 p) { return back.to_written(p); };
  Survey valleys = drawn_valleys(survey.survey, config.condition);
  Ground ground = build_ground(std::move(survey.survey), ground_options(config, plane), progress);
  describe_input(read, ground, report);
  report.conflicts = conflicts_of(std::move(ground.conflicts), plane);
  Terrain terrain{.written = written_of(ground, survey, plane),
                  .vertex_source = origin_kinds(ground),
                  .number = std::move(ground.number)};
  if (plane.projected()) terrain.continuous = plane.to_lonlat(terrain.written);
  terrain.mode = ground.mode;
  survey = {};
  terrain.ground = std::move(ground.tin);
  ground = {};
  terrain.keep = surface_triangles(terrain, read.nodata, plane, config.max_edge_m, progress);
  note_lost_edges(terrain, report);
  note_antimeridian(terrain, plane, report);
  report.tin.dropped_rim_triangles =
      static_cast<std::size_t>(std::count(terrain.keep.begin(), terrain.keep.end(), false));
  const std::size_t vertices = terrain.ground.vertex_count();
  terrain = without_lonely_vertices(std::move(terrain), config.ground.engine, progress);
  report.tin.vertices_left_out = vertices - terrain.ground.vertex_count();
  report.timings_s.triangulate = watch.lap();
  if (config.max_error_m || config.max_points) {
    terrain = simplified(std::move(terrain), {config.max_error_m, config.max_points, config.ground.engine},
                         plane, report, progress);
    report.timings_s.simplify = watch.lap();
  }

  finish_run(std::move(terrain),
             {plane, read.crs, config.labelling, config.condition, output, outputs, watch, std::move(outlets),
              std::move(valleys)},
             built, progress);
  return built;
}

}  // namespace

BuiltTin build_tin(const BuildConfig& config, const MemorySource& memory, Progress& progress) {
  return run_job(config, memory, {}, progress);
}

Report build(const BuildConfig& config, Progress& progress) {
  return run_job(config, {}, config.output, progress).report;
}

void write_built(const BuiltTin& built, const OutputConfig& output, Progress& progress) {
  PendingOutputs pending;
  write_tin_of(built, output, pending, progress);
  progress.check();
  pending.commit();
}

}  // namespace thalweg
