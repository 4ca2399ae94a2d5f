// Inside and outside by flooding.
//
// 1. Each area (a feature) has a pattern of 64 bits that looks random, and a triangle has the exclusive or of
//    those of the areas that it is in, boundaries and holes apart. If it is in none, that is 0; if it is in
//    several, it would be 0 only by a coincidence of 64 bits. The patterns are the same in every run.
// 2. Rings are closed walks, so the exclusive or of the patterns that a path crosses depends only on its
//    ends: noding may bend a ring, or fold parts of it upon each other, which then cancel out.
// 3. Flood from the rim, outside of which the pattern is 0, from triangle to triangle.
#include "region.hpp"

#include "base/splitmix.hpp"
#include "provenance.hpp"

#include <thalweg/base/error.hpp>

#include <algorithm>
#include <map>
#include <tuple>
#include <utility>

namespace thalweg {

namespace {

bool is_ring(const SurveyLine& line) {
  return has(line.kind, EdgeKind::Boundary | EdgeKind::Hole);
}

bool is_area(const SurveyLine& line) {
  return is_ring(line) || has(line.kind, EdgeKind::Lake);
}

Membership toggles_at(std::span<const RingEdge> edges, VertexId a, VertexId b) {
  const std::pair<std::uint32_t, std::uint32_t> key = std::minmax(a.value(), b.value());
  const auto found =
      std::lower_bound(edges.begin(), edges.end(), key, [](const RingEdge& edge, const auto& k) {
        return std::tie(edge.low, edge.high) < std::tie(k.first, k.second);
      });
  return found != edges.end() && found->low == key.first && found->high == key.second ? found->toggles
                                                                                      : Membership{};
}

}  // namespace

bool has_region(const Survey& survey, std::span<const ConstraintEdge> edges) {
  return std::ranges::any_of(survey.lines,
                             [](const SurveyLine& line) { return has(line.kind, EdgeKind::Boundary); }) ||
         std::ranges::any_of(edges,
                             [](const ConstraintEdge& edge) { return has(edge.kind, EdgeKind::Hole); });
}

void check_rings(const Survey& survey, const MergedVertices& merged) {
  for (std::size_t l = 0; l < survey.lines.size(); ++l) {
    const SurveyLine& line = survey.lines[l];
    if (!is_area(line) || line.xy.empty()) continue;
    if (merged.of_line(l, 0) == merged.of_line(l, line.xy.size() - 1)) continue;
    throw Error(ErrorCode::WrongGeometry,
                describe_line(survey, l) +
                    " is used as a boundary, hole or lake, but is not closed: its first vertex " +
                    describe_place(survey, line.xy.front()) + " and its last " +
                    describe_place(survey, line.xy.back()) +
                    " differ; give polygons or closed lines, or close it with --snap DISTANCE");
  }
}

std::vector<RingEdge> ring_edges(const Survey& survey, const Drawing& drawing) {
  std::map<std::pair<std::uint32_t, std::int64_t>, std::uint64_t> area_numbers;
  std::vector<RingEdge> edges;
  for (std::size_t s = 0; s < drawing.pieces.size(); ++s) {
    const SurveyLine& line = survey.lines[drawing.pieces[s].line];
    if (!is_ring(line)) continue;
    const auto area = area_numbers.emplace(std::pair(line.source, line.feature), area_numbers.size()).first;
    const std::uint64_t pattern = splitmix64(area->second);
    const Membership toggles = {.boundaries = has(line.kind, EdgeKind::Boundary) ? pattern : 0,
                                .holes = has(line.kind, EdgeKind::Hole) ? pattern : 0};
    const auto chain = drawing.noding.chain(s);
    for (std::size_t i = 0; i + 1 < chain.size(); ++i) {
      const auto [low, high] = std::minmax(chain[i], chain[i + 1]);
      edges.push_back({low, high, toggles});
    }
  }
  std::sort(edges.begin(), edges.end(), [](const RingEdge& p, const RingEdge& q) {
    return std::tie(p.low, p.high) < std::tie(q.low, q.high);
  });
  std::size_t count = 0;
  for (const RingEdge& edge : edges) {
    if (count > 0 && edges[count - 1].low == edge.low && edges[count - 1].high == edge.high) {
      edges[count - 1].toggles ^= edge.toggles;
    } else {
      edges[count++] = edge;
    }
  }
  edges.resize(count);
  return edges;
}

std::vector<bool> inside_region(const Survey& survey, const Tin& tin, std::span<const RingEdge> edges) {
  const bool bounded = std::any_of(survey.lines.begin(), survey.lines.end(),
                                   [](const SurveyLine& line) { return has(line.kind, EdgeKind::Boundary); });
  std::vector<Membership> areas(tin.triangle_count());
  std::vector<bool> reached(tin.triangle_count());
  std::vector<TriangleId> stack;
  const auto reach = [&](TriangleId t, const Membership& from, HalfedgeId across) {
    if (reached[t.index()]) return;
    reached[t.index()] = true;
    areas[t.index()] = from;
    if (tin.constrained(across)) {
      areas[t.index()] ^= toggles_at(edges, tin.origin(across), tin.target(across));
    }
    stack.push_back(t);
  };
  for (std::size_t i = 0; i < tin.halfedge_count(); ++i) {
    const HalfedgeId h{i};
    if (tin.on_rim(h)) reach(Tin::triangle_of(h), {}, h);
  }
  while (!stack.empty()) {
    const TriangleId t = stack.back();
    stack.pop_back();
    for (std::size_t side = 0; side < 3; ++side) {
      const HalfedgeId h = Tin::halfedge(t, side);
      if (!tin.on_rim(h)) reach(Tin::triangle_of(tin.twin(h)), areas[t.index()], h);
    }
  }
  std::vector<bool> inside(areas.size());
  for (std::size_t t = 0; t < inside.size(); ++t) {
    inside[t] = (!bounded || areas[t].boundaries != 0) && areas[t].holes == 0;
  }
  return inside;
}

}  // namespace thalweg
