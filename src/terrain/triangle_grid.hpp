#pragma once

/// Which triangle holds a point, for TINs of any outline.

#include <thalweg/mesh/tin.hpp>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

namespace thalweg {

/// Buckets of triangles by a grid of at most about as many cells as triangles. The TIN must outlive it.
class TriangleGrid {
 public:
  /// Memory: linear. Complexity: linear, times a logarithm where triangles are much longer than others.
  explicit TriangleGrid(const Tin& tin);
  /// A triangle that holds p, the first by id if p lies on an edge; none outside. Exact.
  [[nodiscard]] std::optional<TriangleId> find(Point2 p) const;

  /// Calls visitor(t) once for each triangle whose box meets that of a and b, both closed.
  template <class Visitor>
  void visit(Point2 a, Point2 b, const Visitor& visitor) const {
    Box2 query;
    query.add(a);
    query.add(b);
    const Range x = columns(query.x_min, query.x_max), y = rows(query.y_min, query.y_max);
    for (std::size_t row = y.first; row <= y.last; ++row) {
      for (std::size_t column = x.first; column <= x.last; ++column) {
        const std::size_t c = row * columns_ + column;
        for (std::size_t i = first_[c]; i < first_[c + 1]; ++i) {
          const Box2 box = box_of(triangles_[i]);
          if (box.x_min > query.x_max || box.x_max < query.x_min || box.y_min > query.y_max ||
              box.y_max < query.y_min) {
            continue;
          }
          // Of the cells that both meet, the first one tells.
          const bool first = column == std::max(x.first, columns(box.x_min, box.x_min).first) &&
                             row == std::max(y.first, rows(box.y_min, box.y_min).first);
          if (first) visitor(triangles_[i]);
        }
      }
    }
  }

 private:
  struct Range {
    std::size_t first = 0;
    std::size_t last = 0;
  };
  [[nodiscard]] Box2 box_of(TriangleId t) const {
    Box2 box;
    for (const VertexId v : tin_.triangle(t)) box.add(tin_.point(v));
    return box;
  }
  [[nodiscard]] std::size_t count_entries() const;
  [[nodiscard]] Range columns(double low, double high) const;
  [[nodiscard]] Range rows(double low, double high) const;

  const Tin& tin_;
  Box2 box_;
  std::size_t columns_ = 1;
  std::size_t rows_ = 1;
  std::vector<std::size_t> first_;
  std::vector<TriangleId> triangles_;
};

}  // namespace thalweg
