// The outline: from a rim halfedge a -> b, turn about b within the fan until the next rim halfedge, which
// starts at b.
#include "base/ordered_blocks.hpp"

#include <thalweg/mesh/rim.hpp>

#include <algorithm>
#include <utility>

namespace thalweg {

namespace {

HalfedgeId next_on_rim(const Tin& tin, HalfedgeId h) {
  HalfedgeId next = Tin::next(h);
  while (!tin.on_rim(next)) next = Tin::next(tin.twin(next));
  return next;
}

}  // namespace

std::vector<std::vector<VertexId>> rim_loops(const Tin& tin) {
  std::vector<std::vector<VertexId>> loops;
  std::vector<bool> visited(tin.halfedge_count(), false);
  for (std::size_t i = 0; i < tin.halfedge_count(); ++i) {
    const HalfedgeId start{i};
    if (visited[i] || !tin.on_rim(start)) continue;
    std::vector<VertexId> loop;
    for (HalfedgeId h = start; !visited[h.index()]; h = next_on_rim(tin, h)) {
      visited[h.index()] = true;
      loop.push_back(tin.origin(h));
    }
    std::rotate(loop.begin(), std::min_element(loop.begin(), loop.end()), loop.end());
    loops.push_back(std::move(loop));
  }
  std::sort(loops.begin(), loops.end());
  return loops;
}

std::vector<HalfedgeId> rim_halfedges(const Tin& tin) {
  constexpr std::size_t kBlock = 1 << 16;
  const Progress uncancelled;
  auto rim =
      list_in_order<HalfedgeId>(tin.halfedge_count(), kBlock, uncancelled,
                                [&tin](std::size_t begin, std::size_t end, std::vector<HalfedgeId>& found) {
                                  for (std::size_t h = begin; h < end; ++h) {
                                    if (tin.on_rim(HalfedgeId{h})) found.emplace_back(h);
                                  }
                                });
  std::ranges::sort(rim, {}, [&](HalfedgeId h) { return std::pair(tin.origin(h), h); });
  return rim;
}

}  // namespace thalweg
