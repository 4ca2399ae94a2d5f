#pragma once

/// The interior pits of a TIN one by one, and what became of them when its triangles changed.

#include <thalweg/mesh/tin.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace thalweg {

/// Interior pits of two TINs of the same vertices, each by one vertex: the one nearest to the middle of the
/// pit's vertices.
struct PitChanges {
  std::vector<VertexId> removed;  ///< pits before, none of whose vertices is in a pit after
  std::vector<VertexId> left;     ///< pits after that share a vertex with a pit before
  std::vector<VertexId> added;    ///< pits after that share none
};

/// Compares the interior pits, as find_pits counts them; so left and added together are the pits after.
/// Pre: both have the same vertices under the same ids. Complexity: linear.
PitChanges compare_pits(const Tin& before, const Tin& after);

/// For each vertex whether it stands for an interior pit: of each pit one does, the one nearest to the middle
/// of its vertices. `is_pit` as in PitSummary. Complexity: linear.
std::vector<std::uint8_t> mark_pits(const Tin& tin, std::span<const std::uint8_t> is_pit);

}  // namespace thalweg
