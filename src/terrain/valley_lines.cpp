// Neighbours along drawn valleys, then a walk from each vertex where there are not two of them. A line's
// higher end is strictly higher than its lower one, so lines that follow each other never come back.
#include "terrain/valley_lines.hpp"

namespace thalweg {

ValleyLines trace_valleys(const Tin& tin) {
  std::vector<std::vector<VertexId>> neighbours(tin.vertex_count());
  ValleyLines valleys{std::vector<std::uint8_t>(tin.vertex_count(), 0), {}};
  for (std::size_t i = 0; i < tin.halfedge_count(); ++i) {
    const HalfedgeId h{i};
    if (!tin.represents_edge(h) || !has(tin.kind(h), EdgeKind::Valley)) continue;
    const VertexId a = tin.origin(h), b = tin.target(h);
    neighbours[a.index()].push_back(b);
    neighbours[b.index()].push_back(a);
    valleys.on_valley[a.index()] = valleys.on_valley[b.index()] = 1;
  }
  for (std::size_t i = 0; i < neighbours.size(); ++i) {
    if (neighbours[i].empty() || neighbours[i].size() == 2) continue;
    for (const VertexId first : neighbours[i]) {
      std::vector<VertexId> line = {VertexId{i}, first};
      while (neighbours[line.back().index()].size() == 2) {
        const std::vector<VertexId>& on = neighbours[line.back().index()];
        line.push_back(on[0] == line[line.size() - 2] ? on[1] : on[0]);
      }
      // Else it is seen from the other end.
      if (tin.height(line.back()) < tin.height(line.front())) valleys.lines.push_back(std::move(line));
    }
  }
  return valleys;
}

}  // namespace thalweg
