#pragma once

/// The borders between the grounds of groups of sinks, piece by piece.

#include "base/prefetch.hpp"
#include "terrain/flow_graph.hpp"

#include <thalweg/base/progress.hpp>

#include <cstdint>
#include <limits>
#include <span>

namespace thalweg {

/// A piece of border with the ground of the group to its left. Its ends are points by number: vertices, and
/// after them the ends of pieces.
struct BorderSegment {
  std::uint32_t group = 0;
  std::uint32_t from = 0;
  std::uint32_t to = 0;
};

struct CatchmentBorders {
  /// Every border once for each of the grounds beside it; what is outside of the TIN has none.
  LargeVector<BorderSegment> segments;
  /// By piece, of those that are ends: its side.
  LargeVector<HalfedgeId> side_of_piece;

  [[nodiscard]] FlowPoint point(const FlowGraph& graph, std::uint32_t number) const;
  /// Asks for the memory that `point` needs.
  void ask_for(const FlowGraph& graph, std::uint32_t number) const {
    const auto n = static_cast<std::uint32_t>(graph.mesh.vertex_count());
    if (number >= n) prefetch(graph.pieces.at(number - n));
  }
  /// What puts points into an order that depends on the TIN alone: vertices by its numbers, then ends of
  /// pieces by its halfedges.
  [[nodiscard]] std::uint64_t rank(const FlowGraph& graph, std::uint32_t number) const {
    const auto n = static_cast<std::uint32_t>(graph.mesh.vertex_count());
    if (number < n) return std::uint64_t{graph.mesh.given(VertexId{number}).value()} << 32U;
    const std::uint64_t side = n + graph.mesh.given(side_of_piece[number - n]).value();
    return side << 32U | number;  // those of one side follow each other
  }
};

/// `group_of_sink`: not the largest number. Complexity: linear; on all threads.
CatchmentBorders find_borders(const FlowGraph& graph, std::span<const std::uint32_t> group_of_sink,
                              const Progress& progress);

}  // namespace thalweg
