// The subdivision, face by face.
//
// 1. candidates.cpp: candidates as far as sides tell, edges that cross, faces.
// 2. In each face, a triangle on no path of its graph of fronts (face_search.cpp) is in no triangulation, and
//    goes. An edge that only such triangles crossed is fixed now, and may divide its face.
// 3. The triangulations of a face are the paths of its graph. Those that go on from a front to the empty one
//    are counted backwards; no path that is followed leads to a dead end.
#include "base/parallel.hpp"
#include "order/candidates.hpp"
#include "order/face_search.hpp"

#include <thalweg/geometry/predicates.hpp>
#include <thalweg/order/face_fronts.hpp>
#include <thalweg/order/fixed_faces.hpp>

#include <algorithm>
#include <atomic>
#include <limits>

namespace thalweg {

namespace {

constexpr std::size_t kFaces = 64;
constexpr std::size_t kTriangles = 4096;
constexpr std::uint32_t kNone = 0xffffffffU;

/// Whether the edge from a to b runs on the surface: it leaves a into a triangle, and each that it enters by
/// a side has the next one, up to b.
bool on_surface(const Tin& surface, VertexId a, VertexId b) {
  if (surface.find_halfedge(a, b).valid() || surface.find_halfedge(b, a).valid()) return true;
  const Point2 from = surface.point(a), to = surface.point(b);
  HalfedgeId crossed;
  for (const HalfedgeId h : surface.outgoing(a)) {
    if (orientation(from, surface.point(surface.target(h)), to) > 0 &&
        orientation(from, to, surface.point(surface.apex(h))) > 0) {
      crossed = Tin::next(h);
      break;
    }
  }
  while (crossed.valid()) {
    const HalfedgeId entry = surface.twin(crossed);
    if (!entry.valid()) return false;
    const VertexId apex = surface.apex(entry);
    if (apex == b) return true;
    crossed = orientation(from, to, surface.point(apex)) > 0 ? Tin::next(entry) : Tin::previous(entry);
  }
  return false;
}

/// Triangulations from each front on, up to a limit.
std::vector<std::uint64_t> count_paths(const FrontGraph& graph) {
  constexpr std::uint64_t kMost = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint64_t> paths(graph.front_count, 0);
  if (graph.empty_front) paths[*graph.empty_front] = 1;
  std::for_each(graph.arcs.rbegin(), graph.arcs.rend(),
                [&](const auto& arc) { paths[arc.from] = std::min(kMost, paths[arc.from] + paths[arc.to]); });
  return paths;
}

/// Marks the triangles of a face that no path of its graph has; false if there is no path.
bool mark_dead(const FrontGraph& graph, std::span<const std::uint32_t> triangles,
               std::vector<std::uint8_t>& dead) {
  std::vector<std::uint8_t> ends(graph.front_count, 0);
  if (graph.empty_front) ends[*graph.empty_front] = 1;
  for (const std::uint32_t t : triangles) dead[t] = 1;
  std::for_each(graph.arcs.rbegin(), graph.arcs.rend(), [&](const auto& arc) {
    if (ends[arc.to] == 0) return;
    ends[arc.from] = 1;
    dead[triangles[arc.triangle]] = 0;
  });
  return ends[0] != 0;
}

/// Drops dead triangles; faces of which all are alive keep their graphs.
void drop_dead(FixedFaces& faces, const std::vector<std::uint8_t>& dead, const Progress& progress) {
  std::vector<FrontGraph> fronts = std::move(faces.fronts);
  const Rows before = std::move(faces.faces);
  std::vector<std::uint32_t> number(dead.size() + 1, 0);  // of a triangle that stays
  for (std::size_t t = 0; t < dead.size(); ++t) number[t + 1] = number[t] + (dead[t] == 0 ? 1 : 0);
  detail::drop_triangles(faces, dead);
  detail::cut_into_faces(faces, progress);
  std::vector<std::uint32_t> face_at(faces.triangles.size(), kNone);  // by its first triangle
  for (std::uint32_t f = 0; f < faces.faces.size(); ++f) face_at[faces.faces.row(f)[0]] = f;
  faces.fronts.assign(faces.faces.size(), {});
  for (std::size_t f = 0; f < before.size(); ++f) {
    const auto row = before.row(f);
    if (std::any_of(row.begin(), row.end(), [&](std::uint32_t t) { return dead[t] != 0; })) continue;
    const std::uint32_t now = face_at[number[row[0]]];
    if (now != kNone) faces.fronts[now] = std::move(fronts[f]);
  }
}

}  // namespace

std::optional<FixedFaces> find_fixed_faces(const Tin& surface, std::vector<OrderTriangle> triangles,
                                           const FixedFaceOptions& options, const Progress& progress) {
  FixedFaces found = detail::find_candidates(surface, std::move(triangles), progress);
  if (!detail::cover_ground(found, surface)) return std::nullopt;
  found.fronts.assign(found.faces.size(), {});
  std::vector<std::uint8_t> dead(found.triangles.size(), 0);
  std::atomic<bool> none{false};
  for_each_block(found.faces.size(), kFaces, progress, [&](std::size_t begin, std::size_t end) {
    detail::FrontFinder finder(found);
    for (std::size_t face = begin; face < end; ++face) {
      auto graph = finder.find(face, {.work_limit = options.work_limit});
      if (!graph) continue;
      if (!mark_dead(*graph, found.faces.row(face), dead)) none = true;
      found.fronts[face] = std::move(*graph);
    }
  });
  if (none) return std::nullopt;
  if (std::find(dead.begin(), dead.end(), 1) != dead.end()) drop_dead(found, dead, progress);
  return found;
}

std::vector<OrderTriangle> keep_on_surface(const Tin& surface, std::vector<OrderTriangle> triangles,
                                           const Progress& progress) {
  std::vector<std::uint8_t> kept(triangles.size(), 0);
  for_each_block(triangles.size(), kTriangles, progress, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      const auto& [a, b, c] = triangles[t].corners;
      if (!on_surface(surface, a, b) || !on_surface(surface, b, c) || !on_surface(surface, c, a)) continue;
      // With all sides on the surface, only a missing triangle of the ground can be what is inside.
      const HalfedgeId ab = surface.find_halfedge(a, b), bc = surface.find_halfedge(b, c),
                       ca = surface.find_halfedge(c, a);
      const auto is_side = [&](HalfedgeId h, VertexId from, VertexId to) {
        return h.valid() || surface.find_halfedge(to, from).valid();
      };
      const bool all_sides = is_side(ab, a, b) && is_side(bc, b, c) && is_side(ca, c, a);
      kept[t] = !all_sides || (ab.valid() && surface.apex(ab) == c) ? 1 : 0;
    }
  });
  std::size_t next = 0;
  for (std::size_t t = 0; t < kept.size(); ++t) {
    if (kept[t] != 0) triangles[next++] = triangles[t];
  }
  triangles.resize(next);
  return triangles;
}

std::optional<std::int64_t> find_least_sum(const FixedFaces& faces, std::size_t face,
                                           std::span<const std::int64_t> weights, std::size_t work_limit) {
  const auto graph = find_fronts(faces, face, {.work_limit = work_limit});
  if (!graph || !graph->empty_front) return std::nullopt;
  std::vector<std::optional<std::int64_t>> behind(graph->front_count);
  behind[*graph->empty_front] = 0;
  std::for_each(graph->arcs.rbegin(), graph->arcs.rend(), [&](const auto& arc) {
    if (!behind[arc.to]) return;
    const std::int64_t sum = *behind[arc.to] + weights[arc.triangle];
    behind[arc.from] = behind[arc.from] ? std::min(*behind[arc.from], sum) : sum;
  });
  return behind[0];
}

std::optional<FaceTriangulations> list_triangulations(const FixedFaces& faces, std::size_t face,
                                                      const TriangulationListOptions& options) {
  const auto graph = find_fronts(faces, face, {.work_limit = options.work_limit});
  if (!graph) return std::nullopt;
  const std::vector<std::uint64_t> paths = count_paths(*graph);
  if (paths[0] > options.most) return std::nullopt;
  FaceTriangulations list;
  const std::span<const std::uint32_t> triangles = faces.faces.row(face);
  std::vector<std::uint32_t> chosen;  // arcs of the path
  const auto first_arc = [&](std::uint32_t front) {
    return static_cast<std::uint32_t>(
        std::lower_bound(graph->arcs.begin(), graph->arcs.end(), front,
                         [](const auto& arc, std::uint32_t from) { return arc.from < from; }) -
        graph->arcs.begin());
  };
  std::vector<std::vector<std::uint32_t>> found;
  std::uint32_t next = paths[0] == 0 ? kNone : first_arc(0), from = 0;
  while (next != kNone) {
    if (next < graph->arcs.size() && graph->arcs[next].from == from) {
      if (paths[graph->arcs[next].to] == 0) {
        ++next;
        continue;
      }
      chosen.push_back(next);
      from = graph->arcs[next].to;
      if (from != graph->empty_front) {
        next = first_arc(from);
        continue;
      }
      std::vector<std::uint32_t>& row = found.emplace_back();
      for (const std::uint32_t arc : chosen) row.push_back(triangles[graph->arcs[arc].triangle]);
      std::sort(row.begin(), row.end());
    } else if (chosen.empty()) {
      break;
    }
    next = chosen.back() + 1;
    from = graph->arcs[chosen.back()].from;
    chosen.pop_back();
  }
  std::sort(found.begin(), found.end());
  for (const auto& row : found) {
    list.size = static_cast<std::uint32_t>(row.size());
    list.triangles.insert(list.triangles.end(), row.begin(), row.end());
  }
  return list;
}

}  // namespace thalweg
