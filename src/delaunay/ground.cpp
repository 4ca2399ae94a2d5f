// The ground of a survey.
//
// 1. Merge equal positions; draw points and lines, noded, as one plan; settle the heights that points and
//    hard lines give.
// 2. Vertices that only soft lines have take the height of the base: the triangulation of all points and hard
//    lines, drawn by themselves.
// 3. Triangulate, under ids along a curve if that was asked for: what is close in the plane is then close in
//    memory, for all that follows. In polygon mode flood the triangles for those inside, and keep these and
//    their vertices. That equals dropping all that is outside first, because no empty circle has to heed what
//    is behind a constraint edge. Points beyond the box of the boundary are dropped before, which saves
//    triangulating them.
#include "base/large_pages.hpp"
#include "base/parallel.hpp"
#include "base/release.hpp"
#include "drawing.hpp"
#include "engine.hpp"
#include "heights.hpp"
#include "lakes.hpp"
#include "merge.hpp"
#include "provenance.hpp"
#include "region.hpp"
#include "spatial_order.hpp"

#include <thalweg/base/error.hpp>
#include <thalweg/delaunay/ground.hpp>
#include <thalweg/delaunay/surface.hpp>
#include <thalweg/delaunay/triangulate.hpp>
#include <thalweg/mesh/change_tin.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <tuple>
#include <type_traits>
#include <utility>

namespace thalweg {

namespace {

// Vertices that a thread takes at once.
constexpr std::size_t kBlock = 8192;

std::vector<std::uint32_t> lines_to_draw(const Survey& survey, bool (*wanted)(const SurveyLine&)) {
  std::vector<std::uint32_t> lines;
  for (std::uint32_t l = 0; l < survey.lines.size(); ++l) {
    if (wanted(survey.lines[l])) lines.push_back(l);
  }
  return lines;
}

// The height of the nearest rim edge, if it is at most `reach` away.
std::optional<double> height_at_rim(const Tin& tin, Point2 p, double reach) {
  double nearest = reach;
  std::optional<double> height;
  for (std::size_t i = 0; i < tin.halfedge_count(); ++i) {
    const HalfedgeId h{i};
    if (!tin.on_rim(h)) continue;
    const Point2 a = tin.point(tin.origin(h)), b = tin.point(tin.target(h));
    const double dx = b.x - a.x, dy = b.y - a.y;
    const double t = std::clamp(((p.x - a.x) * dx + (p.y - a.y) * dy) / (dx * dx + dy * dy), 0.0, 1.0);
    const double distance = std::hypot(a.x + t * dx - p.x, a.y + t * dy - p.y);
    if (distance > nearest) continue;
    nearest = distance;
    height = interpolate_on_segment(a, tin.height(tin.origin(h)), b, tin.height(tin.target(h)), p);
  }
  return height;
}

const Passage& line_through(const Drawing& drawing, std::size_t v) {
  return *std::ranges::lower_bound(drawing.passages, v, {}, &Passage::vertex);
}

[[noreturn]] void refuse_outside(const Survey& survey, const Drawing& drawing, std::uint32_t v) {
  const Passage& passage = line_through(drawing, v);
  throw Error(
      ErrorCode::OutsideHull,
      fmt::format("{} at {} has no height and lies outside of the ground of points and lines with heights; "
                  "give it a height (3D geometry or --line-z-field), shorten the line, or add points there",
                  describe_line_vertex(survey, passage.line, passage.at),
                  describe_place(survey, drawing.vertices.xy[v])));
}

// Step 2. A vertex that rounding has put outside of the base's hull takes the height of the hull.
void drape(const Survey& survey, MergedVertices merged, const GroundOptions& options, const Drawing& drawing,
           Heights& heights, Progress& progress) {
  const auto unknown = std::find(heights.known.begin(), heights.known.end(), false);
  if (unknown == heights.known.end()) return;
  const auto hard = lines_to_draw(
      survey, [](const SurveyLine& line) { return !line.z.empty() && !has(line.kind, EdgeKind::Lake); });
  Drawing base = draw(survey, std::move(merged), hard, progress);
  if (base.vertices.xy.size() < 3) {
    throw Error(
        ErrorCode::TooFewPoints,
        fmt::format(
            "{} has no heights of its own, and three points with heights, from which it could get them, "
            "are not there",
            describe_line(
                survey,
                line_through(drawing, static_cast<std::size_t>(unknown - heights.known.begin())).line)));
  }
  Heights base_heights = resolve_heights(survey, base, options, progress);
  const std::vector<ConstraintEdge> edges = constraint_edges(survey, base);
  const Tin tin =
      triangulate(std::move(base.vertices.xy), std::move(base_heights.z), edges, progress, options.engine);
  const SurfaceLocator surface(tin);
  progress.start_phase("heights of lines without");
  TriangleId near;
  for (std::uint32_t v = 0; v < heights.z.size(); ++v) {
    if (heights.known[v]) continue;
    progress.check();
    const Point2 p = drawing.vertices.xy[v];
    if (const auto place = surface.locate(p, near)) {
      near = place->triangle;
      heights.z[v] = surface.height(*place, p);
    } else if (const auto z = height_at_rim(tin, p, drawing.noding.pixel)) {
      heights.z[v] = *z;
    } else {
      refuse_outside(survey, drawing, v);
    }
  }
  progress.advance(1);
}

// Vertices and what is known of each; the parts of a ground that is being built.
struct Plan {
  std::vector<Point2> xy;
  std::vector<double> z;
  std::vector<VertexOrigin> origins;
  std::vector<std::uint32_t> along_curve;  // the vertices along a curve; empty: that is not known
  std::vector<std::uint32_t> now_of;       // for each vertex of the drawing its number; kInvalid: dropped
};

// Drops all vertices that are not kept, and numbers the others in their order.
void keep_vertices(Plan& plan, const std::vector<bool>& keep) {
  std::vector<std::uint32_t> number(keep.size(), VertexId::kInvalid);
  std::uint32_t count = 0;
  for (std::size_t v = 0; v < keep.size(); ++v) {
    if (!keep[v]) continue;
    number[v] = count;
    plan.xy[count] = plan.xy[v];
    plan.z[count] = plan.z[v];
    plan.origins[count] = plan.origins[v];
    ++count;
  }
  plan.xy.resize(count);
  plan.z.resize(count);
  plan.origins.resize(count);
  if (count < keep.size()) plan.along_curve.clear();
  for (std::uint32_t& now : plan.now_of) now = now == VertexId::kInvalid ? now : number[now];
}

// Numbers all vertices by a space-filling curve.
void sort_along_curve(Plan& plan, const Progress& progress) {
  std::vector<std::uint32_t> order = std::move(plan.along_curve);
  if (order.empty()) order = hilbert_order(plan.xy, progress);
  const auto sorted = [&](const auto& values) {
    std::remove_cvref_t<decltype(values)> moved;
    reserve_large(moved, values.size());
    moved.resize(values.size());
    for_each_block(order.size(), kBlock, progress, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v) moved[v] = values[order[v]];
    });
    return moved;
  };
  plan.xy = sorted(plan.xy);
  plan.z = sorted(plan.z);
  plan.origins = sorted(plan.origins);
  RawVector<std::uint32_t> number(order.size());
  for_each_block(order.size(), kBlock, progress, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) number[order[v]] = static_cast<std::uint32_t>(v);
  });
  for_each_block(plan.now_of.size(), kBlock, progress, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      std::uint32_t& now = plan.now_of[v];
      if (now != VertexId::kInvalid) now = number[now];
    }
  });
}

// For each vertex that is left its rank among these in the order of the drawing.
std::vector<VertexId> numbers_in_order(std::span<const std::uint32_t> now_of) {
  std::vector<VertexId> number(now_of.size());
  std::size_t count = 0;
  for (const std::uint32_t now : now_of) {
    if (now != VertexId::kInvalid) number[now] = VertexId{count++};
  }
  number.resize(count);
  return number;
}

// For each point its vertex now; invalid if that was dropped.
std::vector<VertexId> vertices_of_points(std::span<const std::uint32_t> of_point,
                                         std::span<const std::uint32_t> now_of) {
  std::vector<VertexId> vertices;
  vertices.reserve(of_point.size());
  for (const std::uint32_t v : of_point) {
    vertices.push_back(now_of[v] == VertexId::kInvalid ? VertexId{} : VertexId{now_of[v]});
  }
  return vertices;
}

[[noreturn]] void refuse_empty_region() {
  throw Error(ErrorCode::EmptyInput, "no ground lies inside of the boundary and outside of the holes");
}

// Drops points beyond the box of the boundary that are on no line.
void drop_far_points(const Survey& survey, const Drawing& drawing, Plan& plan) {
  Box2 box;
  std::vector<bool> keep(plan.xy.size());
  for (const Passage& passage : drawing.passages) {
    keep[passage.vertex] = true;
    if (has(survey.lines[passage.line].kind, EdgeKind::Boundary)) box.add(plan.xy[passage.vertex]);
  }
  if (box.empty()) return;
  if (!(box.width() > 0 && box.height() > 0)) refuse_empty_region();
  for (std::size_t v = 0; v < keep.size(); ++v) keep[v] = keep[v] || box.contains(plan.xy[v]);
  keep_vertices(plan, keep);
}

Tin keep_region(const Survey& survey, const Drawing& drawing, const Tin& hull, Plan& plan) {
  std::vector<RingEdge> rings = ring_edges(survey, drawing);
  for (RingEdge& edge : rings) {
    std::tie(edge.low, edge.high) = std::minmax(plan.now_of[edge.low], plan.now_of[edge.high]);
  }
  std::ranges::sort(rings, {}, [](const RingEdge& edge) { return std::pair(edge.low, edge.high); });
  const std::vector<bool> inside = inside_region(survey, hull, rings);
  std::vector<bool> keep(plan.xy.size());
  std::vector<Triangle> triangles;
  std::vector<ConstraintEdge> constraints;
  for (std::size_t t = 0; t < inside.size(); ++t) {
    if (!inside[t]) continue;
    triangles.push_back(hull.triangle(TriangleId{t}));
    for (std::size_t side = 0; side < 3; ++side) {
      const HalfedgeId h = Tin::halfedge(TriangleId{t}, side);
      keep[hull.origin(h).index()] = true;
      if (hull.constrained(h)) constraints.push_back({hull.origin(h), hull.target(h), hull.kind(h)});
    }
  }
  if (triangles.empty()) refuse_empty_region();
  std::vector<std::uint32_t> number(keep.size());
  std::uint32_t count = 0;
  for (std::size_t v = 0; v < keep.size(); ++v) number[v] = keep[v] ? count++ : VertexId::kInvalid;
  const auto renumber = [&](VertexId& v) { v = VertexId{number[v.index()]}; };
  for (Triangle& triangle : triangles) std::for_each(triangle.begin(), triangle.end(), renumber);
  for (ConstraintEdge& edge : constraints) {
    renumber(edge.a);
    renumber(edge.b);
  }
  keep_vertices(plan, keep);
  return {std::move(plan.xy), std::move(plan.z), std::move(triangles), constraints};
}

// Levels the lakes; conflicts stay in order of vertices.
void level(const Survey& survey, const Drawing& drawing, std::span<const std::uint32_t> now_of,
           Heights& heights, Ground& ground, const Progress& progress) {
  LevelledLakes levelled = level_lakes(survey, drawing, ground.tin, now_of, progress);
  ground.lakes = levelled.lakes;
  ground.points_in_lakes = levelled.points;
  for (std::size_t i = 0; i < heights.conflicts.size(); ++i) {
    const std::uint32_t v = now_of[heights.conflict_vertices[i]];
    if (v != VertexId::kInvalid) heights.conflicts[i].z_used = levelled.z[v];
  }
  heights.conflict_vertices.insert(heights.conflict_vertices.end(), levelled.conflict_vertices.begin(),
                                   levelled.conflict_vertices.end());
  std::move(levelled.conflicts.begin(), levelled.conflicts.end(), std::back_inserter(heights.conflicts));
  std::vector<std::size_t> order(heights.conflicts.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return heights.conflict_vertices[i]; });
  Heights sorted;
  for (const std::size_t i : order) {
    sorted.conflicts.push_back(std::move(heights.conflicts[i]));
    sorted.conflict_vertices.push_back(heights.conflict_vertices[i]);
  }
  heights.conflicts = std::move(sorted.conflicts);
  heights.conflict_vertices = std::move(sorted.conflict_vertices);
  ground.tin = ground.tin.with_heights(std::move(levelled.z));
}

// What has become of points, conflicts and crossings.
void tell_fates(const Drawing& drawing, std::span<const std::uint32_t> now_of, Heights& heights,
                Ground& ground) {
  ground.point_vertices = vertices_of_points(drawing.vertices.of_point, now_of);
  for (std::size_t v = 0; v < drawing.vertices.point_count; ++v) {
    ground.outside_boundary += now_of[v] == VertexId::kInvalid ? 1 : 0;
  }
  for (std::size_t i = 0; i < heights.conflicts.size(); ++i) {
    if (now_of[heights.conflict_vertices[i]] == VertexId::kInvalid) continue;
    ground.conflicts.push_back(std::move(heights.conflicts[i]));
  }
  for (const VertexOrigin& origin : ground.origins) {
    ground.crossings += origin.kind == VertexOrigin::Kind::Crossing ? 1 : 0;
  }
}

/// `points_are_placed` is called when the survey's points are needed no more.
template <class Release>
Ground build(const Survey& survey, const GroundOptions& options, const Release& points_are_placed,
             Progress& progress) {
  MergedVertices merged = merge_vertices(survey, options, progress);
  check_rings(survey, merged);
  const auto every = lines_to_draw(survey, [](const SurveyLine&) { return true; });
  const bool some_lack_heights =
      std::ranges::any_of(survey.lines, [](const SurveyLine& line) { return line.z.empty(); });
  MergedVertices to_drape;
  if (some_lack_heights) to_drape = merged;
  Drawing drawing = draw(survey, std::move(merged), every, progress);
  Heights heights = resolve_heights(survey, drawing, options, progress);
  if (some_lack_heights) drape(survey, std::move(to_drape), options, drawing, heights, progress);

  Ground ground;
  ground.pixel = drawing.noding.pixel;
  ground.duplicates_merged = survey.points.xy.size() - drawing.vertices.point_count;
  points_are_placed();
  std::vector<ConstraintEdge> edges = constraint_edges(survey, drawing);
  ground.mode = has_region(survey, edges) ? GroundMode::Polygon : GroundMode::Hull;

  Plan plan{.xy = std::move(drawing.vertices.xy),
            .z = std::move(heights.z),
            .origins = std::move(drawing.vertices.origins),
            .along_curve = std::move(drawing.vertices.along_curve),
            .now_of = {}};
  plan.now_of.resize(plan.xy.size());
  for (std::size_t v = 0; v < plan.now_of.size(); ++v) plan.now_of[v] = static_cast<std::uint32_t>(v);
  if (ground.mode == GroundMode::Polygon) drop_far_points(survey, drawing, plan);
  const bool along_curve = options.numbering == Numbering::AlongCurve;
  if (along_curve) sort_along_curve(plan, progress);
  for (ConstraintEdge& edge : edges) {
    edge.a = VertexId{plan.now_of[edge.a.index()]};
    edge.b = VertexId{plan.now_of[edge.b.index()]};
  }
  if (ground.mode == GroundMode::Hull && !has_lakes(survey)) {
    // Nobody asks any more where lines pass.
    release(drawing.passages);
    release(drawing.pieces);
    drawing.noding = {};
  }
  ground.tin = detail::triangulate(std::move(plan.xy), std::move(plan.z), edges,
                                   along_curve ? detail::PointOrder::AlongCurve : detail::PointOrder::Any,
                                   progress, options.engine);
  if (has_lakes(survey)) level(survey, drawing, plan.now_of, heights, ground, progress);
  if (ground.mode == GroundMode::Polygon) {
    plan.xy.assign(ground.tin.points().begin(), ground.tin.points().end());
    plan.z.assign(ground.tin.heights().begin(), ground.tin.heights().end());
    ground.tin = keep_region(survey, drawing, ground.tin, plan);
  }
  ground.origins = std::move(plan.origins);
  if (along_curve) ground.number = numbers_in_order(plan.now_of);
  tell_fates(drawing, plan.now_of, heights, ground);
  return ground;
}

}  // namespace

Ground build_ground(const Survey& survey, const GroundOptions& options, Progress& progress) {
  return build(
      survey, options, [] {}, progress);
}

Ground build_ground(Survey&& survey, const GroundOptions& options, Progress& progress) {
  const auto release_points = [&survey] {
    release(survey.points.xy);
    release(survey.points.z);
  };
  return build(survey, options, release_points, progress);
}

}  // namespace thalweg
