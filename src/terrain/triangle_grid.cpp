// A grid of cells over the TIN's box; each cell lists the triangles whose boxes meet it, by counting sort.
// Where triangles are long, as in a fan, cells are wider, so that lists stay linear.
#include "terrain/triangle_grid.hpp"

#include <thalweg/geometry/predicates.hpp>

#include <algorithm>
#include <cmath>

namespace thalweg {

namespace {

/// That a triangle is in, on average, at most; of an even TIN it is four.
constexpr std::size_t kMostCells = 32;

std::size_t cell(double at, double low, double size, std::size_t count) {
  const double share = size > 0 ? (at - low) / size * static_cast<double>(count) : 0;
  return static_cast<std::size_t>(std::clamp(share, 0.0, static_cast<double>(count - 1)));
}

}  // namespace

TriangleGrid::TriangleGrid(const Tin& tin) : tin_(tin), box_(bounding_box(tin.points())) {
  const double count = static_cast<double>(std::max<std::size_t>(1, tin.triangle_count()));
  const double width = std::max(box_.width(), 1e-300), height = std::max(box_.height(), 1e-300);
  const double across = std::clamp(std::sqrt(count * width / height), 1.0, count);
  columns_ = static_cast<std::size_t>(across);
  rows_ = static_cast<std::size_t>(std::max(1.0, count / across));
  while (columns_ * rows_ > 1 && count_entries() > kMostCells * tin.triangle_count()) {
    columns_ = (columns_ + 1) / 2;
    rows_ = (rows_ + 1) / 2;
  }
  first_.assign(columns_ * rows_ + 1, 0);
  const auto for_each_cell = [&](std::size_t t, const auto& visit) {
    const Box2 box = box_of(TriangleId{t});
    const Range x = columns(box.x_min, box.x_max), y = rows(box.y_min, box.y_max);
    for (std::size_t row = y.first; row <= y.last; ++row) {
      for (std::size_t column = x.first; column <= x.last; ++column) visit(row * columns_ + column);
    }
  };
  for (std::size_t t = 0; t < tin.triangle_count(); ++t) {
    for_each_cell(t, [&](std::size_t c) { ++first_[c + 1]; });
  }
  for (std::size_t c = 0; c + 1 < first_.size(); ++c) first_[c + 1] += first_[c];
  triangles_.resize(first_.back());
  std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
  for (std::size_t t = 0; t < tin.triangle_count(); ++t) {
    for_each_cell(t, [&](std::size_t c) { triangles_[next[c]++] = TriangleId{t}; });
  }
}

/// How many entries the lists of all cells have.
std::size_t TriangleGrid::count_entries() const {
  std::size_t entries = 0;
  for (std::size_t t = 0; t < tin_.triangle_count(); ++t) {
    const Box2 box = box_of(TriangleId{t});
    const Range x = columns(box.x_min, box.x_max), y = rows(box.y_min, box.y_max);
    entries += (x.last - x.first + 1) * (y.last - y.first + 1);
  }
  return entries;
}

TriangleGrid::Range TriangleGrid::columns(double low, double high) const {
  return {cell(low, box_.x_min, box_.width(), columns_), cell(high, box_.x_min, box_.width(), columns_)};
}

TriangleGrid::Range TriangleGrid::rows(double low, double high) const {
  return {cell(low, box_.y_min, box_.height(), rows_), cell(high, box_.y_min, box_.height(), rows_)};
}

std::optional<TriangleId> TriangleGrid::find(Point2 p) const {
  if (!box_.contains(p)) return std::nullopt;
  const std::size_t c = rows(p.y, p.y).first * columns_ + columns(p.x, p.x).first;
  for (std::size_t i = first_[c]; i < first_[c + 1]; ++i) {
    const Triangle& t = tin_.triangle(triangles_[i]);
    const Point2 a = tin_.point(t[0]), b = tin_.point(t[1]), d = tin_.point(t[2]);
    if (orientation(a, b, p) >= 0 && orientation(b, d, p) >= 0 && orientation(d, a, p) >= 0)
      return triangles_[i];
  }
  return std::nullopt;
}

}  // namespace thalweg
