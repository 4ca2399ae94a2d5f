#pragma once

/// Noding: lines become pieces that meet only at vertices.

#include "segments.hpp"

#include <thalweg/base/progress.hpp>

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace thalweg {

/// A segment between two vertices, which may be one.
using SegmentEnds = std::array<std::uint32_t, 2>;

/// For each segment the chain of vertices that it has become; a new vertex is numbered after the given ones.
///
/// Laws: (1) given vertices do not move; (2) the links of all chains meet only at common vertices, and no
/// vertex, on a chain or not, lies inside a link, in exact arithmetic; (3) each point of a chain is less than
/// `pixel` from its segment; (4) the result depends on the vertices and segments as sets.
struct Noding {
  std::vector<Point2> crossings;        ///< new vertices, in order of (x, y)
  std::vector<std::size_t> first_node;  ///< chain of segment s: nodes [first_node[s], first_node[s + 1])
  std::vector<std::uint32_t> nodes;     ///< from the segment's first vertex to its second
  double pixel = 0;                     ///< of the snapping grid: a power of two
  /// Two segments that could not be brought to obey law (2), and where: vertices there are closer together
  /// than double arithmetic allows. The rest of the result means nothing then.
  struct Failure {
    std::uint32_t segment = 0;
    std::uint32_t other_segment = 0;  ///< equal to `segment` where the other part is a lone vertex
    Point2 place;
  };
  std::optional<Failure> failure;

  [[nodiscard]] std::span<const std::uint32_t> chain(std::size_t segment) const {
    return std::span(nodes).subspan(first_node[segment], first_node[segment + 1] - first_node[segment]);
  }
};

/// Side of the snapping grid: a fixed part of the power of two above the largest coordinate, but not below
/// `least`. Pre: `least` is 0 or a power of two.
double snapping_pixel(std::span<const Point2> positions, double least);

/// Nodes segments among themselves and with all vertices. Pre: vertices are distinct and within 1e15;
/// `least_pixel` as in `snapping_pixel`. Throws: Error{SizeLimit} where lines cross or overlap 2^26 times;
/// {Cancelled}. Complexity: about (vertices + segments) log segments, and the number of pieces.
Noding node_segments(std::span<const Point2> vertices, std::span<const SegmentEnds> segments,
                     Progress& progress, double least_pixel = 0);

}  // namespace thalweg
