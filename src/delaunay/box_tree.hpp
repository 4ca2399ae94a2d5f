#pragma once

/// A static tree of boxes: which of many boxes meet a given one.

#include "segments.hpp"

#include <thalweg/base/progress.hpp>
#include <thalweg/geometry/point.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace thalweg {

inline bool meet(const Box2& p, const Box2& q) {
  return p.x_min <= q.x_max && q.x_min <= p.x_max && p.y_min <= q.y_max && q.y_min <= p.y_max;
}

/// The box of all positions at most `margin` from p in x and in y (rounded to nearest).
inline Box2 box_around(Point2 p, double margin) {
  return {p.x - margin, p.y - margin, p.x + margin, p.y + margin};
}

/// Squares of the plane, and which of them segments touch: for queries far from all of them. Made for none,
/// every query may meet some.
class TouchedSquares {
 public:
  TouchedSquares() = default;
  /// About 64 squares a segment, which is as wide as the margin on either side. If segments touch too many of
  /// them, it is as if made for none.
  TouchedSquares(std::span<const Segment> segments, double margin);
  /// False only if no segment meets the query.
  [[nodiscard]] bool may_meet(const Box2& query) const {
    if (touched_.empty()) return true;
    const std::size_t column = column_of(query.x_min), row = row_of(query.y_min);
    const std::size_t last_column = column_of(query.x_max), last_row = row_of(query.y_max);
    if (last_column - column > 1 || last_row - row > 1) return true;
    return touched_[row * side_ + column] || touched_[row * side_ + last_column] ||
           touched_[last_row * side_ + column] || touched_[last_row * side_ + last_column];
  }

 private:
  /// The column or row of a place in units of squares.
  [[nodiscard]] std::size_t square_at(double place) const {
    return static_cast<std::size_t>(std::clamp(place, 0.0, static_cast<double>(side_ - 1)));
  }
  [[nodiscard]] std::size_t column_of(double x) const { return square_at((x - box_.x_min) * x_scale_); }
  [[nodiscard]] std::size_t row_of(double y) const { return square_at((y - box_.y_min) * y_scale_); }
  std::size_t touch(const Segment& segment, double margin);

  Box2 box_;
  double x_scale_ = 0, y_scale_ = 0;
  std::size_t side_ = 1;
  std::vector<bool> touched_;
};

/// Packed R-tree over boxes along a Hilbert curve; nodes have eight children. Memory: 41 bytes a box, 8 more
/// over segments, 9 more where their ends are noted.
class BoxTree {
 public:
  using Ends = std::array<std::uint32_t, 2>;

  BoxTree() = default;
  /// `items[i]` is what a visitor of `boxes[i]` is given; several boxes may have the same item.
  BoxTree(std::span<const Box2> boxes, std::span<const std::uint32_t> items, const Progress& progress);

  [[nodiscard]] std::size_t size() const { return items_.size(); }
  /// Boxes and items in the tree's order: neighbours in it are close in the plane.
  [[nodiscard]] const Box2& box(std::size_t i) const { return levels_.front()[i]; }
  [[nodiscard]] std::uint32_t item(std::size_t i) const { return items_[i]; }

  /// False only if nothing in the tree meets the query; asks no box.
  [[nodiscard]] bool may_meet(const Box2& query) const {
    return !levels_.empty() && squares_.may_meet(query);
  }
  /// Calls `visitor(item)` for each box that meets the query (closed), in the tree's order; over segments it
  /// may leave out those that do not meet the query themselves.
  template <class Visitor>
  void visit(const Box2& query, const Visitor& visitor) const {
    visit_unless([](std::size_t, std::size_t) { return false; }, query, visitor);
  }

  /// Notes the two ends of each item.
  void note_ends(std::span<const Ends> of_item);
  /// The same, but may leave out items that share an end with `ends`: where very many do, as in a fan, it
  /// asks few of them. Pre: ends are noted.
  template <class Visitor>
  void visit_apart(const Ends& ends, const Box2& query, const Visitor& visitor) const {
    const auto all_share = [&](std::size_t level, std::size_t i) {
      const auto [a, b] = shared_[level][i];
      return (a != kNone && (a == ends[0] || a == ends[1])) || (b != kNone && (b == ends[0] || b == ends[1]));
    };
    visit_unless(all_share, query, visitor);
  }

 private:
  friend BoxTree segment_tree(std::span<const Segment> segments, const Progress& progress);
  static constexpr std::size_t kChildren = 8;
  static constexpr std::uint32_t kNone = 0xffffffffU;

  template <class Leave, class Visitor>
  void visit_unless(const Leave& leave, const Box2& query, const Visitor& visitor) const {
    if (!may_meet(query)) return;
    visit_range(levels_.size() - 1, 0, levels_.back().size(), leave, query, visitor);
  }
  template <class Leave, class Visitor>
  void visit_range(std::size_t level, std::size_t begin, std::size_t end, const Leave& leave,
                   const Box2& query, const Visitor& visitor) const {
    const std::vector<Box2>& boxes = levels_[level];
    for (std::size_t i = begin; i < end; ++i) {
      if (!meet(boxes[i], query) || leave(level, i)) continue;
      if (level == 0) {
        visitor(items_[i]);
      } else {
        const std::size_t first = i * kChildren;
        visit_range(level - 1, first, std::min(first + kChildren, levels_[level - 1].size()), leave, query,
                    visitor);
      }
    }
  }

  std::vector<std::vector<Box2>> levels_;  // from the leaves up
  std::vector<std::uint32_t> items_;
  std::vector<std::vector<Ends>> shared_;  // as levels: the ends that all items below have, or kNone
  TouchedSquares squares_;                 ///< over segments: between them lies much where no box is
};

/// The tree of segments, by index; a long one is covered by several boxes, so a visitor may meet an item more
/// than once. Boxes are wider than the segments by a few units in the last place, never narrower.
BoxTree segment_tree(std::span<const Segment> segments, const Progress& progress);

}  // namespace thalweg
