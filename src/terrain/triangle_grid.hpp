#pragma once

/// Which triangle holds a point, for TINs of any outline.

#include <thalweg/mesh/tin.hpp>

#include <cstdint>
#include <optional>
#include <vector>

namespace thalweg {

/// Buckets of triangles by a grid of about as many cells as triangles. The TIN must outlive it.
class TriangleGrid {
 public:
  /// Complexity: linear for triangles that are not much longer than others.
  explicit TriangleGrid(const Tin& tin);
  /// A triangle that holds p, the first by id if p lies on an edge; none outside. Exact.
  [[nodiscard]] std::optional<TriangleId> find(Point2 p) const;

 private:
  struct Range {
    std::size_t first = 0;
    std::size_t last = 0;
  };
  [[nodiscard]] Range columns(double low, double high) const;
  [[nodiscard]] Range rows(double low, double high) const;

  const Tin& tin_;
  Box2 box_;
  std::size_t columns_ = 1;
  std::size_t rows_ = 1;
  std::vector<std::uint32_t> first_;
  std::vector<TriangleId> triangles_;
};

}  // namespace thalweg
