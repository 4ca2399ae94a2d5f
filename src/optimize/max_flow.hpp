#pragma once

/// Maximum flow with integer capacities.

#include <thalweg/base/progress.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace thalweg {

class FlowNetwork {
 public:
  explicit FlowNetwork(std::size_t node_count) : head_(node_count, kEnd) {}

  /// Adds an arc and its reverse, which has no capacity of its own.
  void add_arc(std::uint32_t from, std::uint32_t to, std::int64_t capacity);

  /// Complexity: n^2 m at most, in practice far less. Throws: Error{Cancelled}.
  std::int64_t maximise(std::uint32_t source, std::uint32_t sink, const Progress& progress);

  /// Calls visit(other, residual there, residual back) for the arcs between a node and others.
  template <class Visit>
  void for_each_arc(std::uint32_t node, const Visit& visit) const {
    for (std::uint32_t a = head_[node]; a != kEnd; a = arcs_[a].next) {
      visit(arcs_[a].to, arcs_[a].residual, arcs_[a ^ 1U].residual);
    }
  }

 private:
  static constexpr std::uint32_t kEnd = 0xffffffffU;
  struct Arc {
    std::uint32_t to, next;
    std::int64_t residual;
  };

  bool rank_nodes(std::uint32_t source, std::uint32_t sink);
  std::int64_t augment(std::uint32_t source, std::uint32_t sink);

  std::vector<std::uint32_t> head_;
  std::vector<Arc> arcs_;  ///< an arc and its reverse stand together: a and a ^ 1
  std::vector<std::uint32_t> level_, current_, path_;
};

}  // namespace thalweg
