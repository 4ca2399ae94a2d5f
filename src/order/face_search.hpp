#pragma once

/// All triangulations of one face by candidate triangles, without listing them.

#include "order/candidates.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace thalweg::detail {

/// The smallest order of a triangulation of the face, and of one that holds each of its triangles: the
/// largest order of its triangles. `unreachable` where there is none.
struct FaceOrders {
  static constexpr std::uint32_t kUnreachable = 0xffffffffU;
  std::uint32_t any = kUnreachable;
  std::vector<std::uint32_t> with_triangle;  ///< as the face's triangles
};

/// The triangulations of a face as the paths of a graph without cycles, from front 0 to the empty front; each
/// once. Arcs ascend by `from`, and lead to higher numbers.
struct FrontGraph {
  struct Arc {
    std::uint32_t from = 0;
    std::uint32_t to = 0;
    std::uint32_t triangle = 0;  ///< index in the face
  };
  std::uint32_t front_count = 0;
  std::optional<std::uint32_t> empty_front;  ///< none: the face has no triangulation
  std::vector<Arc> arcs;
};

/// What of a face is searched.
struct FrontLimits {
  std::size_t work_limit = 500'000;       ///< edges of fronts
  std::uint32_t max_order = 0xffffffffU;  ///< of the triangles
};

/// None if the fronts that come up have more edges together than the limit.
std::optional<FrontGraph> find_fronts(const Candidates& candidates, std::size_t face,
                                      const FrontLimits& limits);

/// None if the fronts that come up have more than `work_limit` edges together: a count, so the answer is the
/// same everywhere.
std::optional<FaceOrders> search_face(const Candidates& candidates, std::size_t face, std::size_t work_limit);

}  // namespace thalweg::detail
