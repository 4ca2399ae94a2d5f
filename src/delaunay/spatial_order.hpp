#pragma once

/// Orders along a Hilbert curve: what is near in the order is near in the plane.

#include <thalweg/base/progress.hpp>
#include <thalweg/geometry/point.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace thalweg {

/// Indices of the points along a Hilbert curve through their bounding box.
std::vector<std::uint32_t> hilbert_order(std::span<const Point2> points, const Progress& progress);

/// Indices of the points in rounds, each along the Hilbert curve: the last round holds three quarters of
/// them, the one before three quarters of the rest, and so on. Incremental triangulation in this order takes
/// few steps to locate a point and, expected, few flips, whatever the points' pattern.
std::vector<std::uint32_t> insertion_order(std::span<const Point2> points, const Progress& progress);

}  // namespace thalweg
