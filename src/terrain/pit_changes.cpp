// Pits before and after, matched by their vertices.
//
// 1. A pit's vertices are connected by level edges, all of whose ends are marked as parts of a pit: a walk
//    over marked vertices of equal height gathers each pit.
// 2. A pit whose vertices the other TIN does not mark at all is gone, or new.
#include <thalweg/terrain/pit_changes.hpp>
#include <thalweg/terrain/pits.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace thalweg {

namespace {

bool interior(std::span<const std::uint8_t> is_pit, VertexId v) {
  return is_pit[v.index()] == static_cast<std::uint8_t>(PitKind::Interior);
}

std::vector<std::vector<VertexId>> gather(const Tin& tin, std::span<const std::uint8_t> is_pit) {
  std::vector<std::vector<VertexId>> gathered;
  std::vector<bool> seen(tin.vertex_count(), false);
  for (std::size_t i = 0; i < tin.vertex_count(); ++i) {
    if (seen[i] || !interior(is_pit, VertexId{i})) continue;
    std::vector<VertexId> pit = {VertexId{i}};
    seen[i] = true;
    for (std::size_t next = 0; next < pit.size(); ++next) {
      for (const HalfedgeId out : tin.outgoing(pit[next])) {  // no pit vertex is on the rim: all its edges
        const VertexId other = tin.target(out);
        if (seen[other.index()] || tin.height(other) != tin.height(pit[next])) continue;
        seen[other.index()] = true;
        pit.push_back(other);
      }
    }
    gathered.push_back(std::move(pit));
  }
  return gathered;
}

VertexId middle_of(const Tin& tin, const std::vector<VertexId>& pit) {
  Point2 sum;
  for (const VertexId v : pit) {
    sum.x += tin.point(v).x - tin.point(pit.front()).x;
    sum.y += tin.point(v).y - tin.point(pit.front()).y;
  }
  const auto count = static_cast<double>(pit.size());
  const Point2 middle = {tin.point(pit.front()).x + sum.x / count, tin.point(pit.front()).y + sum.y / count};
  const auto distance = [&](VertexId v) {
    return std::hypot(tin.point(v).x - middle.x, tin.point(v).y - middle.y);
  };
  return *std::min_element(pit.begin(), pit.end(), [&](VertexId a, VertexId b) {
    return std::pair(distance(a), tin.point(a)) < std::pair(distance(b), tin.point(b));
  });
}

}  // namespace

std::vector<std::uint8_t> mark_pits(const Tin& tin, std::span<const std::uint8_t> is_pit) {
  std::vector<std::uint8_t> marks(tin.vertex_count(), 0);
  for (const auto& pit : gather(tin, is_pit)) marks[middle_of(tin, pit).index()] = 1;
  return marks;
}

PitChanges compare_pits(const Tin& before, const Tin& after) {
  const PitSummary pits_before = find_pits(before);
  const PitSummary pits_after = find_pits(after);
  PitChanges changes;
  const auto shared = [](const std::vector<VertexId>& pit, const PitSummary& other) {
    return std::any_of(pit.begin(), pit.end(), [&](VertexId v) { return interior(other.is_pit, v); });
  };
  for (const auto& pit : gather(before, pits_before.is_pit)) {
    if (!shared(pit, pits_after)) changes.removed.push_back(middle_of(before, pit));
  }
  for (const auto& pit : gather(after, pits_after.is_pit)) {
    (shared(pit, pits_before) ? changes.left : changes.added).push_back(middle_of(after, pit));
  }
  return changes;
}

}  // namespace thalweg
