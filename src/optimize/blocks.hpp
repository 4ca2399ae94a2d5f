#pragma once

/// Biconnected parts of a multigraph.

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace thalweg {

using NodePair = std::pair<std::uint32_t, std::uint32_t>;

struct Blocks {
  std::vector<std::uint32_t> block;  ///< by edge
  std::vector<std::uint32_t> size;   ///< by block: its number of edges; 1 means a bridge
};

/// Splits the edges into blocks: a choice of edges connects the graph's components if and only if it does so
/// in each block. Pre: no edge joins a node to itself; nodes are less than `node_count`. Complexity: linear.
Blocks find_blocks(std::span<const NodePair> edges, std::size_t node_count);

}  // namespace thalweg
