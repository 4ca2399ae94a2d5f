// A packed R-tree.
//
// 1. Boxes are laid out along the Hilbert order of their centres, and eight successive ones make a node
//    (Kamel, Faloutsos, On packing R-trees, 1993). Clusters and outliers do not hurt, as they would a grid.
// 2. A query far from all segments ends at a grid of squares, without the tree.
// 3. The box of a long oblique segment is mostly empty. Segments are cut into parts of equal length such that
//    no part spans more than L in both x and y; L is chosen so that n segments have at most 2 n parts, or at
//    most 16 n where they are few.
#include "box_tree.hpp"

#include "spatial_order.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace thalweg {

namespace {

constexpr double kManyParts = 30000;
constexpr double kPartsOfFew = 15;
// A point of a segment computed as a + t (b - a) is off by less than four units in the last place.
constexpr double kRounding = 0x1p-50;

double narrow_extent(const Segment& s) {
  return std::min(std::abs(s.b.x - s.a.x), std::abs(s.b.y - s.a.y));
}

}  // namespace

TouchedSquares::TouchedSquares(std::span<const Segment> segments, double margin) {
  constexpr double kSquaresASegment = 64, kMostTouchedASegment = 64;
  for (const Segment& segment : segments) {
    for (const Point2 p : {segment.a, segment.b}) {
      box_.add({p.x - margin, p.y - margin});
      box_.add({p.x + margin, p.y + margin});
    }
  }
  const auto count = static_cast<double>(segments.size());
  side_ = static_cast<std::size_t>(std::sqrt(kSquaresASegment * count)) + 1;
  x_scale_ = box_.width() > 0 ? static_cast<double>(side_) / box_.width() : 0;
  y_scale_ = box_.height() > 0 ? static_cast<double>(side_) / box_.height() : 0;
  if (!std::isfinite(x_scale_) || !std::isfinite(y_scale_)) return;
  touched_.assign(side_ * side_, false);
  std::size_t touched = 0;
  for (const Segment& segment : segments) {
    touched += touch(segment, margin);
    if (static_cast<double>(touched) <= kMostTouchedASegment * count) continue;
    touched_.clear();
    return;
  }
}

// Row by row, what lies between the row's borders. Everything is a part of a square wider than it is, far
// more than what rounding moves it.
std::size_t TouchedSquares::touch(const Segment& segment, double margin) {
  constexpr double kWider = 0x1p-6;
  double x = (segment.a.x - box_.x_min) * x_scale_, y = (segment.a.y - box_.y_min) * y_scale_;
  double x_end = (segment.b.x - box_.x_min) * x_scale_, y_end = (segment.b.y - box_.y_min) * y_scale_;
  if (y_end < y) std::swap(x, x_end), std::swap(y, y_end);
  const double x_pad = margin * x_scale_ + kWider, y_pad = margin * y_scale_ + kWider;
  const auto x_at = [&](double at) {
    return y_end > y ? x + (x_end - x) * std::clamp((at - y) / (y_end - y), 0.0, 1.0) : x;
  };
  std::size_t touched = 0;
  const std::size_t last_row = square_at(y_end + y_pad);
  for (std::size_t row = square_at(y - y_pad); row <= last_row; ++row) {
    const double border = static_cast<double>(row);
    const double in = x_at(border - y_pad), out = y_end > y ? x_at(border + 1 + y_pad) : x_end;
    const std::size_t first = square_at(std::min(in, out) - x_pad),
                      last = square_at(std::max(in, out) + x_pad);
    touched += last - first + 1;
    std::fill(touched_.begin() + row * side_ + first, touched_.begin() + row * side_ + last + 1, true);
  }
  return touched;
}

BoxTree::BoxTree(std::span<const Box2> boxes, std::span<const std::uint32_t> items,
                 const Progress& progress) {
  if (boxes.empty()) return;
  std::vector<Point2> centres(boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    centres[i] = {(boxes[i].x_min + boxes[i].x_max) / 2, (boxes[i].y_min + boxes[i].y_max) / 2};
  }
  std::vector<Box2>& leaves = levels_.emplace_back();
  leaves.reserve(boxes.size());
  items_.reserve(boxes.size());
  for (const std::uint32_t i : hilbert_order(centres, progress)) {
    leaves.push_back(boxes[i]);
    items_.push_back(items[i]);
  }
  while (levels_.back().size() > kChildren) {
    const std::vector<Box2>& below = levels_.back();
    std::vector<Box2> level((below.size() + kChildren - 1) / kChildren);
    for (std::size_t i = 0; i < below.size(); ++i) {
      level[i / kChildren].add({below[i].x_min, below[i].y_min});
      level[i / kChildren].add({below[i].x_max, below[i].y_max});
    }
    levels_.push_back(std::move(level));
  }
}

void BoxTree::note_ends(std::span<const Ends> of_item) {
  shared_.clear();
  std::vector<Ends>& leaves = shared_.emplace_back();
  leaves.reserve(items_.size());
  for (const std::uint32_t item : items_) leaves.push_back(of_item[item]);
  while (shared_.size() < levels_.size()) {
    const std::vector<Ends>& below = shared_.back();
    std::vector<Ends> level(levels_[shared_.size()].size());
    for (std::size_t i = 0; i < below.size(); ++i) {
      Ends& shared = level[i / kChildren];
      if (i % kChildren == 0) shared = below[i];
      for (std::uint32_t& end : shared) {
        if (end != below[i][0] && end != below[i][1]) end = kNone;
      }
    }
    shared_.push_back(std::move(level));
  }
}

BoxTree segment_tree(std::span<const Segment> segments, const Progress& progress) {
  double total = 0;
  double largest = 0;
  for (const Segment& s : segments) {
    total += narrow_extent(s);
    for (const double c : {s.a.x, s.a.y, s.b.x, s.b.y}) largest = std::max(largest, std::abs(c));
  }
  const auto count = static_cast<double>(segments.size());
  const double longest_part = total / std::max(count, std::min(kManyParts, kPartsOfFew * count));
  const double margin = largest * kRounding;
  std::vector<Box2> boxes;
  std::vector<std::uint32_t> items;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const auto& [a, b] = segments[i];
    const double parts =
        longest_part > 0 ? std::max(1.0, std::ceil(narrow_extent(segments[i]) / longest_part)) : 1.0;
    Point2 from = a;
    for (double part = 1; part <= parts; ++part) {
      const double t = part / parts;
      const Point2 to = part < parts ? Point2{a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)} : b;
      boxes.push_back({std::min(from.x, to.x) - margin, std::min(from.y, to.y) - margin,
                       std::max(from.x, to.x) + margin, std::max(from.y, to.y) + margin});
      items.push_back(static_cast<std::uint32_t>(i));
      from = to;
    }
  }
  BoxTree tree(boxes, items, progress);
  tree.squares_ = TouchedSquares(segments, margin);
  return tree;
}

}  // namespace thalweg
