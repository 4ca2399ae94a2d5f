#pragma once

/// All triangulations of one face as the paths of a graph, without listing them.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace thalweg {

struct FixedFaces;

/// A front is what uncovered ground of a face has on its border. Paths from front 0 to the empty one are the
/// triangulations of the face, each once: an arc covers what is left of its front's lowest edge by a
/// triangle. In a large face the lowest edge is the one that comes first along it. Arcs ascend by `from`, and
/// lead to higher numbers.
struct FrontGraph {
  struct Arc {
    std::uint32_t from = 0;
    std::uint32_t to = 0;
    std::uint32_t triangle = 0;  ///< index in the face
  };
  std::uint32_t front_count = 0;
  std::optional<std::uint32_t> empty_front;  ///< none: the face has no triangulation
  std::vector<Arc> arcs;
  std::size_t work = 0;  ///< of its fronts, as FrontOptions::work_limit counts
};

struct FrontOptions {
  /// Of fronts, in edges: a count, so the answer is the same everywhere.
  std::size_t work_limit = 500'000;
  /// By triangle of the face: 1 if it may be used; empty: all may.
  std::span<const std::uint8_t> usable;
};

/// None if the fronts that come up have more edges together than the limit. Some arcs may lead to no
/// triangulation. Complexity: the fronts.
std::optional<FrontGraph> find_fronts(const FixedFaces& faces, std::size_t face, const FrontOptions& options);

}  // namespace thalweg
