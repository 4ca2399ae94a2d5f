// Two TINs of the same vertices, side by side.
//
// 1. The vertices of both are sorted by position; they must be the same to the last bit. The second TIN gets
//    the ids of the first, so that formats that number vertices anew can be compared, too.
// 2. An edge changed if the other TIN has no edge between the same vertices.
#include "base/lower_case.hpp"
#include "pipeline/loaded_tin.hpp"

#include <thalweg/base/error.hpp>
#include <thalweg/io/crs.hpp>
#include <thalweg/io/pending_outputs.hpp>
#include <thalweg/io/picture.hpp>
#include <thalweg/pipeline/inspect.hpp>
#include <thalweg/terrain/pit_changes.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <numeric>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace thalweg {

namespace {

std::vector<std::size_t> sorted_vertices(const LoadedTin& loaded) {
  const std::span<const Point2> xy = loaded.written_points();
  std::vector<std::size_t> order(xy.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::tuple(xy[a], loaded.tin.heights()[a], a) < std::tuple(xy[b], loaded.tin.heights()[b], b);
  });
  return order;
}

/// The second TIN with the ids of the first.
Tin renamed_after(const LoadedTin& before, const LoadedTin& after, const std::string& before_path,
                  const std::string& after_path) {
  const auto differ = [&](const std::string& how) {
    return Error(ErrorCode::Usage, before_path + " and " + after_path + " cannot be compared: " + how +
                                       "; give two TINs of the same vertices");
  };
  if (before.tin.vertex_count() != after.tin.vertex_count()) {
    throw differ(
        fmt::format("they have {} and {} vertices", before.tin.vertex_count(), after.tin.vertex_count()));
  }
  if (before.crs.known && after.crs.known && !means_same_crs(before.crs.wkt, after.crs.wkt)) {
    throw differ("one is in " + before.crs.name + ", the other in " + after.crs.name);
  }
  const std::vector<std::size_t> old_order = sorted_vertices(before);
  const std::vector<std::size_t> new_order = sorted_vertices(after);
  std::vector<VertexId> renamed(old_order.size());
  for (std::size_t i = 0; i < old_order.size(); ++i) {
    const Point2 p = before.written_points()[old_order[i]], q = after.written_points()[new_order[i]];
    const double z = before.tin.heights()[old_order[i]], w = after.tin.heights()[new_order[i]];
    if (p != q || z != w) {
      throw differ(
          fmt::format("vertex {} of the one is at ({}, {}, {}), where vertex {} of the other is at "
                      "({}, {}, {})",
                      old_order[i], p.x, p.y, z, new_order[i], q.x, q.y, w));
    }
    renamed[new_order[i]] = VertexId{old_order[i]};
  }
  std::vector<Triangle> triangles(after.tin.triangles().begin(), after.tin.triangles().end());
  for (Triangle& t : triangles) {
    for (VertexId& v : t) v = renamed[v.index()];
  }
  std::vector<ConstraintEdge> constraints = after.tin.constraint_edges();
  for (ConstraintEdge& edge : constraints) {
    edge.a = renamed[edge.a.index()];
    edge.b = renamed[edge.b.index()];
  }
  return {{before.tin.points().begin(), before.tin.points().end()},
          {before.tin.heights().begin(), before.tin.heights().end()},
          std::move(triangles),
          constraints};
}

std::vector<std::array<VertexId, 2>> missing_edges(const Tin& of, const Tin& in) {
  std::vector<std::array<VertexId, 2>> edges;
  for (std::size_t i = 0; i < of.halfedge_count(); ++i) {
    const HalfedgeId h{i};
    if (!of.represents_edge(h)) continue;
    const VertexId a = of.origin(h), b = of.target(h);
    if (!in.find_halfedge(a, b).valid() && !in.find_halfedge(b, a).valid()) edges.push_back({a, b});
  }
  return edges;
}

std::vector<std::uint8_t> marks_of(const std::vector<VertexId>& vertices, std::size_t count) {
  std::vector<std::uint8_t> marks(count, 0);
  for (const VertexId v : vertices) marks[v.index()] = 1;
  return marks;
}

}  // namespace

void view_comparison(const CompareConfig& config, Progress& progress) {
  PendingOutputs outputs({config.before, config.after});
  const std::string path = outputs.add(config.output, config.overwrite ? Overwrite::Yes : Overwrite::No);
  progress.start_phase("read");
  const LoadedTin before = load_tin(config.before, progress);
  const LoadedTin loaded_after = load_tin(config.after, progress);
  progress.start_phase("compare");
  const Tin after = renamed_after(before, loaded_after, config.before, config.after);
  const PitChanges pits = compare_pits(before.tin, after);
  const auto gone = missing_edges(before.tin, after);
  const auto come = missing_edges(after, before.tin);
  const std::size_t n = after.vertex_count();
  const std::vector<std::uint8_t> removed = marks_of(pits.removed, n), left = marks_of(pits.left, n),
                                  added = marks_of(pits.added, n);
  progress.start_phase("draw");
  PictureScene scene{.tin = before.tin,
                     .horizontal_metres_per_unit = before.plane.metres_per_unit(),
                     .vertical_metres_per_unit = before.plane.vertical_metres_per_unit(),
                     .pits_before = removed,
                     .pits_after = left,
                     .flipped = gone,
                     .title = "Before: " + std::filesystem::path(config.before).filename().string(),
                     .target = config.output,
                     .width_px = config.width_px};
  const PictureScene result{.tin = after,
                            .horizontal_metres_per_unit = scene.horizontal_metres_per_unit,
                            .vertical_metres_per_unit = scene.vertical_metres_per_unit,
                            .pits_after = left,
                            .pits_new = added,
                            .flipped = come,
                            .title = "After: " + std::filesystem::path(config.after).filename().string(),
                            .target = config.output,
                            .width_px = config.width_px};
  draw_comparison(path, extension_of(config.output), {scene, result}, progress);
  progress.advance(1);
  outputs.commit();
}

}  // namespace thalweg
