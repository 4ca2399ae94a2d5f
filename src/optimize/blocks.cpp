// Blocks by one depth-first search with an explicit stack.
// Based on: Hopcroft, Tarjan, Algorithm 447: efficient algorithms for graph manipulation, 1973.
// Parallel edges are told apart by their index, so that two of them are no bridge.
#include "optimize/blocks.hpp"

#include <algorithm>

namespace thalweg {

namespace {

constexpr std::uint32_t kNoEdge = 0xffffffffU;

class Search {
 public:
  Search(std::span<const NodePair> edges, std::size_t node_count)
      : edges_(edges), first_(node_count + 1, 0), order_(node_count, 0), low_(node_count, 0) {
    for (const auto& [a, b] : edges) ++first_[a + 1], ++first_[b + 1];
    for (std::size_t i = 0; i < node_count; ++i) first_[i + 1] += first_[i];
    incident_.resize(first_.back());
    std::vector<std::uint32_t> fill(first_.begin(), first_.end() - 1);
    for (std::uint32_t e = 0; e < edges.size(); ++e) {
      incident_[fill[edges[e].first]++] = e;
      incident_[fill[edges[e].second]++] = e;
    }
    out_.block.resize(edges.size());
  }

  Blocks run() {
    for (const auto& [root, end] : edges_) {
      if (order_[root] != 0) continue;
      enter(root, kNoEdge);
      while (!path_.empty()) step();
    }
    return std::move(out_);
  }

 private:
  struct Frame {
    std::uint32_t node, entered_by, next;
  };

  void enter(std::uint32_t node, std::uint32_t edge) {
    order_[node] = low_[node] = ++visited_;
    path_.push_back({node, edge, first_[node]});
  }

  void step() {
    Frame& frame = path_.back();
    if (frame.next == first_[frame.node + 1]) {
      leave();
      return;
    }
    const std::uint32_t edge = incident_[frame.next++];
    if (edge == frame.entered_by) return;
    const std::uint32_t node = frame.node;
    const std::uint32_t across = edges_[edge].first == node ? edges_[edge].second : edges_[edge].first;
    if (order_[across] == 0) {
      open_.push_back(edge);
      enter(across, edge);
    } else if (order_[across] < order_[node]) {
      open_.push_back(edge);
      low_[node] = std::min(low_[node], order_[across]);
    }
  }

  void leave() {
    const Frame done = path_.back();
    path_.pop_back();
    if (path_.empty()) return;
    const std::uint32_t parent = path_.back().node;
    low_[parent] = std::min(low_[parent], low_[done.node]);
    if (low_[done.node] < order_[parent]) return;
    const std::uint32_t block = static_cast<std::uint32_t>(out_.size.size());
    out_.size.push_back(0);
    std::uint32_t edge = kNoEdge;
    do {
      edge = open_.back();
      open_.pop_back();
      out_.block[edge] = block;
      ++out_.size[block];
    } while (edge != done.entered_by);
  }

  std::span<const NodePair> edges_;
  std::vector<std::uint32_t> first_, incident_;
  std::vector<std::uint32_t> order_, low_;  ///< by node: 0 is unvisited
  std::vector<Frame> path_;
  std::vector<std::uint32_t> open_;  ///< edges whose block is not complete
  std::uint32_t visited_ = 0;
  Blocks out_;
};

}  // namespace

Blocks find_blocks(std::span<const NodePair> edges, std::size_t node_count) {
  return Search(edges, node_count).run();
}

}  // namespace thalweg
