#pragma once

/// Which vertices triangles have as corners.

#include <thalweg/mesh/tin.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace thalweg {

/// For each vertex: 1 if it is in one of the triangles, else 0. Pre: corners are vertices. Complexity:
/// linear; runs on all threads.
std::vector<std::uint8_t> used_vertices(std::span<const Triangle> triangles, std::size_t vertex_count);

}  // namespace thalweg
