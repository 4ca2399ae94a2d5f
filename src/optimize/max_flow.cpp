// Maximum flow by blocking flows: Dinic, Algorithm for solution of a problem of maximum flow in networks with
// power estimation, 1970; without recursion, because paths can be long.
#include "optimize/max_flow.hpp"

#include <algorithm>
#include <limits>

namespace thalweg {

void FlowNetwork::add_arc(std::uint32_t from, std::uint32_t to, std::int64_t capacity) {
  arcs_.push_back({to, head_[from], capacity});
  head_[from] = static_cast<std::uint32_t>(arcs_.size() - 1);
  arcs_.push_back({from, head_[to], 0});
  head_[to] = static_cast<std::uint32_t>(arcs_.size() - 1);
}

bool FlowNetwork::rank_nodes(std::uint32_t source, std::uint32_t sink) {
  level_.assign(head_.size(), kEnd);
  std::vector<std::uint32_t> queue = {source};
  level_[source] = 0;
  for (std::size_t i = 0; i < queue.size(); ++i) {
    for (std::uint32_t a = head_[queue[i]]; a != kEnd; a = arcs_[a].next) {
      if (arcs_[a].residual == 0 || level_[arcs_[a].to] != kEnd) continue;
      level_[arcs_[a].to] = level_[queue[i]] + 1;
      queue.push_back(arcs_[a].to);
    }
  }
  return level_[sink] != kEnd;
}

/// Sends flow along one path of the ranked network; 0 if there is none left.
std::int64_t FlowNetwork::augment(std::uint32_t source, std::uint32_t sink) {
  path_.clear();
  std::uint32_t node = source;
  while (node != sink) {
    std::uint32_t& a = current_[node];
    while (a != kEnd && (arcs_[a].residual == 0 || level_[arcs_[a].to] != level_[node] + 1))
      a = arcs_[a].next;
    if (a != kEnd) {
      path_.push_back(a);
      node = arcs_[a].to;
    } else if (path_.empty()) {
      return 0;
    } else {
      node = arcs_[path_.back() ^ 1U].to;
      path_.pop_back();
      current_[node] = arcs_[current_[node]].next;
    }
  }
  std::int64_t flow = std::numeric_limits<std::int64_t>::max();
  for (const std::uint32_t a : path_) flow = std::min(flow, arcs_[a].residual);
  for (const std::uint32_t a : path_) {
    arcs_[a].residual -= flow;
    arcs_[a ^ 1U].residual += flow;
  }
  return flow;
}

std::int64_t FlowNetwork::maximise(std::uint32_t source, std::uint32_t sink, const Progress& progress) {
  std::int64_t total = 0;
  while (rank_nodes(source, sink)) {
    current_ = head_;
    for (std::int64_t flow = augment(source, sink); flow != 0; flow = augment(source, sink)) {
      total += flow;
      progress.check();
    }
  }
  return total;
}

}  // namespace thalweg
