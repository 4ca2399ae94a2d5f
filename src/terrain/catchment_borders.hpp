#pragma once

/// The borders between the grounds of groups of sinks, segment by segment.

#include "base/prefetch.hpp"
#include "terrain/flow_graph.hpp"

#include <thalweg/base/progress.hpp>

#include <cstdint>
#include <limits>
#include <span>

namespace thalweg {

/// The group of what is outside of the TIN.
constexpr std::uint32_t kOutside = std::numeric_limits<std::uint32_t>::max();

/// A part of a border, with a group on each side. Its ends are points by number: vertices, and after them
/// those on edges.
struct BorderSegment {
  std::uint32_t from = 0, to = 0;
  std::uint32_t left = kOutside, right = kOutside;
};

/// Where a border crosses or meets an edge.
struct BorderPoint {
  double share = 0;  ///< of the side's way, more than 0, less than 1
  HalfedgeId side;
};

struct CatchmentBorders {
  std::vector<BorderSegment> segments;
  std::vector<BorderPoint> points;

  [[nodiscard]] FlowPoint point(const FlowGraph& graph, std::uint32_t number) const;
  /// Asks for the memory that `point` needs.
  void ask_for(const FlowGraph& graph, std::uint32_t number) const {
    const auto n = static_cast<std::uint32_t>(graph.mesh.vertex_count());
    if (number >= n) prefetch(&points[number - n]);
  }
  /// An order of points that depends on the TIN alone: vertices by its numbers, then others by its
  /// halfedges, then along them.
  [[nodiscard]] bool is_before(const FlowGraph& graph, std::uint32_t p, std::uint32_t q) const;
};

/// `group_of_sink`: none is kOutside. Throws: Error{SizeLimit} from 2^32 points on. Complexity: linear in
/// triangles, and in the edges that borders cross; on all threads.
CatchmentBorders find_borders(const FlowGraph& graph, std::span<const std::uint32_t> group_of_sink,
                              const Progress& progress);

}  // namespace thalweg
