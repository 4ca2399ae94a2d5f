#pragma once

/// What orders the triangulations of one face have, without listing them.

#include "order/candidates.hpp"

#include <thalweg/order/face_fronts.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace thalweg::detail {

/// The smallest order of a triangulation of the face, and of one that holds each of its triangles: the
/// largest order of its triangles. `unreachable` where there is none.
struct FaceOrders {
  static constexpr std::uint32_t kUnreachable = 0xffffffffU;
  std::uint32_t any = kUnreachable;
  std::vector<std::uint32_t> with_triangle;  ///< as the face's triangles
};

/// Searches faces one by one: memory is reused from face to face. The candidates outlive it, unchanged.
class FrontFinder {
 public:
  explicit FrontFinder(const Candidates& candidates);
  ~FrontFinder();
  FrontFinder(const FrontFinder&) = delete;
  FrontFinder& operator=(const FrontFinder&) = delete;

  /// As find_fronts.
  std::optional<FrontGraph> find(std::size_t face, const FrontOptions& options);
  /// None if the fronts that come up have more than `work_limit` edges together: a count, so the answer is
  /// the same everywhere.
  std::optional<FaceOrders> find_orders(std::size_t face, std::size_t work_limit);

 private:
  class Search;
  std::unique_ptr<Search> search_;
};

}  // namespace thalweg::detail
