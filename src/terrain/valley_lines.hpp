#pragma once

/// Drawn valleys as lines that run downstream.

#include <thalweg/mesh/tin.hpp>

#include <cstdint>
#include <vector>

namespace thalweg {

struct ValleyLines {
  std::vector<std::uint8_t> on_valley;       ///< by vertex
  std::vector<std::vector<VertexId>> lines;  ///< from the higher end to the lower one
};

/// From one end or meeting of drawn valley edges to the next; closed lines and those with level ends are left
/// out. No vertex comes after itself along lines. Complexity: linear.
ValleyLines trace_valleys(const Tin& tin);

}  // namespace thalweg
