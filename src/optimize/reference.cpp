// A grid of cells with about two points each, and the rule of ownership.
//
// Moved from p by (e, e^2), e small, a point lies to the left of the line from a to b if p does, or if p is
// on the line and the line runs downwards, or level and to the right. No line runs along (e, e^2) for all
// small e, so each moved point is inside exactly one triangle around it, or off the TIN.
#include <thalweg/geometry/predicates.hpp>
#include <thalweg/optimize/reference.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

namespace thalweg {

namespace {

bool leads_left(Point2 a, Point2 b) {
  return b.y < a.y || (b.y == a.y && b.x > a.x);
}

bool owns(const std::array<Point2, 3>& at, Point2 p) {
  for (std::size_t i = 0; i < 3; ++i) {
    const Point2 a = at[i], b = at[(i + 1) % 3];
    const int side = orientation(a, b, p);
    if (side < 0 || (side == 0 && !leads_left(a, b))) return false;
  }
  return true;
}

double square_at(const std::array<Point2, 3>& at, const std::array<double, 3>& heights, Point2 p,
                 double reference) {
  const auto corner = std::find(at.begin(), at.end(), p);
  double height = 0;
  if (corner != at.end()) {
    height = heights[static_cast<std::size_t>(corner - at.begin())];
  } else {
    const double bx = at[1].x - at[0].x, by = at[1].y - at[0].y, cx = at[2].x - at[0].x,
                 cy = at[2].y - at[0].y, px = p.x - at[0].x, py = p.y - at[0].y;
    const double rise =
        (heights[1] - heights[0]) * (px * cy - cx * py) + (heights[2] - heights[0]) * (bx * py - px * by);
    height = heights[0] + rise / (bx * cy - by * cx);
  }
  return (height - reference) * (height - reference);
}

}  // namespace

Reference::Reference(std::span<const Point2> points, std::span<const double> heights)
    : box_(bounding_box(points)) {
  constexpr double kPerCell = 2;
  constexpr double kMostCells = 4096;
  const double area = std::max(box_.width(), 1e-300) * std::max(box_.height(), 1e-300);
  cell_ = std::max({std::sqrt(area * kPerCell / static_cast<double>(std::max<std::size_t>(points.size(), 1))),
                    box_.width() / kMostCells, box_.height() / kMostCells, 1e-300});
  columns_ = static_cast<std::size_t>(box_.width() / cell_) + 1;
  rows_ = static_cast<std::size_t>(box_.height() / cell_) + 1;
  const auto cell_of = [&](std::size_t i) {
    return static_cast<std::size_t>((points[i].y - box_.y_min) / cell_) * columns_ +
           static_cast<std::size_t>((points[i].x - box_.x_min) / cell_);
  };
  std::vector<std::uint32_t> order(points.size());
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(), [&](std::uint32_t i, std::uint32_t j) {
    return std::tuple(cell_of(i), points[i], heights[i]) < std::tuple(cell_of(j), points[j], heights[j]);
  });
  first_.assign(columns_ * rows_ + 1, 0);
  for (const std::uint32_t i : order) {
    ++first_[cell_of(i) + 1];
    points_.push_back(points[i]);
    heights_.push_back(heights[i]);
  }
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
}

template <class Visit>
void Reference::for_points_in(const Box2& box, const Visit& visit) const {
  if (points_.empty() || box.x_max < box_.x_min || box.y_max < box_.y_min || box.x_min > box_.x_max ||
      box.y_min > box_.y_max) {
    return;
  }
  const auto place = [&](double offset, std::size_t count) {
    return static_cast<std::size_t>(std::clamp(offset / cell_, 0.0, static_cast<double>(count - 1)));
  };
  const std::size_t left = place(box.x_min - box_.x_min, columns_),
                    right = place(box.x_max - box_.x_min, columns_);
  for (std::size_t row = place(box.y_min - box_.y_min, rows_); row <= place(box.y_max - box_.y_min, rows_);
       ++row) {
    for (std::size_t i = first_[row * columns_ + left]; i < first_[row * columns_ + right + 1]; ++i) {
      if (box.contains(points_[i])) visit(points_[i], heights_[i]);
    }
  }
}

double Reference::squares(const std::array<Point2, 3>& at, const std::array<double, 3>& heights) const {
  double sum = 0;
  for_points_in(bounding_box(at), [&](Point2 p, double reference) {
    if (owns(at, p)) sum += square_at(at, heights, p, reference);
  });
  return sum;
}

double Reference::squares_left_on_rim(const Tin& tin, const Progress& progress) const {
  constexpr std::size_t kStep = 4096;
  std::vector<double> left;
  const auto corners = [&](TriangleId t) {
    const Triangle& corner = tin.triangle(t);
    return std::array{tin.point(corner[0]), tin.point(corner[1]), tin.point(corner[2])};
  };
  for (std::size_t i = 0; i < tin.halfedge_count(); ++i) {
    if (i % kStep == 0) progress.check();
    const HalfedgeId h{i};
    const Point2 a = tin.point(tin.origin(h)), b = tin.point(tin.target(h));
    if (!tin.on_rim(h) || leads_left(a, b)) continue;
    const std::array at{a, b, tin.point(tin.apex(h))};
    const std::array heights{tin.height(tin.origin(h)), tin.height(tin.target(h)), tin.height(tin.apex(h))};
    for_points_in(bounding_box(std::array{a, b}), [&](Point2 p, double reference) {
      if (p != a && p != b && orientation(a, b, p) == 0) left.push_back(square_at(at, heights, p, reference));
    });
  }
  const std::vector<bool> rim = tin.rim_vertices();
  for (std::size_t i = 0; i < rim.size(); ++i) {
    const VertexId v{i};
    if (!rim[i] || tin.outgoing(v).empty()) continue;
    const Point2 p = tin.point(v);
    const bool owned = std::any_of(tin.outgoing(v).begin(), tin.outgoing(v).end(),
                                   [&](HalfedgeId h) { return owns(corners(Tin::triangle_of(h)), p); });
    if (owned) continue;
    for_points_in(bounding_box(std::array{p}), [&](Point2 /*p*/, double reference) {
      left.push_back((tin.height(v) - reference) * (tin.height(v) - reference));
    });
  }
  std::sort(left.begin(), left.end());  // so that the sum does not depend on ids
  return std::accumulate(left.begin(), left.end(), 0.0);
}

}  // namespace thalweg
