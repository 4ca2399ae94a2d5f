#pragma once

/// Orders along a Hilbert curve: what is near in the order is near in the plane.

#include <thalweg/base/progress.hpp>
#include <thalweg/geometry/point.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace thalweg {

struct CurveOrder {
  std::vector<std::uint32_t> indices;  ///< of the points along the curve
  /// Points that share a cell of the box's side by 2^-28 with another one: all that are at one position, and
  /// few more.
  std::vector<std::uint32_t> crowded;
};

/// Orders fewer than 2^31 points along a Hilbert curve through their bounding box. Complexity: linear, but
/// for points that are much closer together than the box is wide.
CurveOrder order_along_curve(std::span<const Point2> points, const Progress& progress);
/// Its indices alone.
inline std::vector<std::uint32_t> hilbert_order(std::span<const Point2> points, const Progress& progress) {
  return order_along_curve(points, progress).indices;
}

/// The same up to cells of a 2048th of the box's side, within which the order is that of the indices: enough
/// for memory, at half the cost.
std::vector<std::uint32_t> coarse_hilbert_order(std::span<const Point2> points, const Progress& progress);

/// Round of the vertex with that index along the curve: the last one holds 15 of 16 vertices, the one before
/// 15 of 16 of the rest, and so on. Incremental triangulation round by round takes few steps to locate a
/// point and, expected, few changes, whatever the points' pattern.
inline constexpr std::size_t kInsertionRounds = 8;
std::size_t insertion_round(std::uint32_t index);

/// The indices below `count` for which `belongs`, round by round, within a round ascending.
template <class Belongs>
std::vector<std::uint32_t> in_rounds(std::uint32_t count, const Belongs& belongs) {
  std::array<std::size_t, kInsertionRounds + 1> start{};
  for (std::uint32_t i = 0; i < count; ++i) start[insertion_round(i) + 1] += belongs(i) ? 1 : 0;
  for (std::size_t round = 0; round < kInsertionRounds; ++round) start[round + 1] += start[round];
  std::vector<std::uint32_t> indices(start[kInsertionRounds]);
  for (std::uint32_t i = 0; i < count; ++i) {
    if (belongs(i)) indices[start[insertion_round(i)]++] = i;
  }
  return indices;
}

}  // namespace thalweg
