// Prisms under triangles.
//
// 1. The difference of two planes over a convex polygon is linear: it is cut where it is zero, and each part
//    is fanned into triangles, over which its integral is the area times the mean of its corners' values.
// 2. Between two TINs the polygons are the intersections of their triangles: one is clipped by the sides of
//    the other (Sutherland, Hodgman, Reentrant polygon clipping, 1974).
// 3. Coordinates are taken from a corner of the triangle, so that large ones cost no digits; sums are
//    compensated (Kahan), in order of triangles, so that nothing depends on threads.
#include "terrain/triangle_grid.hpp"

#include <thalweg/terrain/volume.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

namespace thalweg {

namespace {

/// A corner of a polygon, and the difference of the surfaces there.
struct Corner {
  Point2 p;
  double difference = 0;
};

/// z = at_origin + by_x x + by_y y, coordinates from some origin.
struct Plane {
  double at_origin = 0, by_x = 0, by_y = 0;
  [[nodiscard]] double height(Point2 p) const { return at_origin + by_x * p.x + by_y * p.y; }
};

class Sum {
 public:
  void add(double value) {
    const double corrected = value - lost_;
    const double next = sum_ + corrected;
    lost_ = (next - sum_) - corrected;
    sum_ = next;
  }
  [[nodiscard]] double value() const { return sum_; }

 private:
  double sum_ = 0;
  double lost_ = 0;
};

struct Sums {
  Sum above, below, area_above, area_below, area;
  [[nodiscard]] Volumes volumes() const {
    return {above.value(), below.value(), area_above.value(), area_below.value(), area.value()};
  }
};

double doubled_area(Point2 a, Point2 b, Point2 c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

double cut_share(const Corner& a, const Corner& b) {
  return a.difference / (a.difference - b.difference);
}

// The part where `sign` times the difference is positive: its area and the integral of that.
struct Part {
  double area = 0, integral = 0;
};

Part part_of(std::span<const Corner> polygon, double sign, std::vector<Corner>& scratch) {
  scratch.clear();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Corner& a = polygon[i];
    const Corner& b = polygon[i + 1 == polygon.size() ? 0 : i + 1];
    if (sign * a.difference > 0) scratch.push_back({a.p, sign * a.difference});
    if (a.difference * b.difference < 0) {
      const double t = cut_share(a, b);
      scratch.push_back({{a.p.x + t * (b.p.x - a.p.x), a.p.y + t * (b.p.y - a.p.y)}, 0});
    } else if (a.difference == 0) {
      scratch.push_back({a.p, 0});
    }
  }
  Part part;
  for (std::size_t i = 2; i < scratch.size(); ++i) {
    const Corner &a = scratch[0], &b = scratch[i - 1], &c = scratch[i];
    const double area = doubled_area(a.p, b.p, c.p) / 2;
    part.integral += area * (a.difference + b.difference + c.difference) / 3;
    part.area += area;
  }
  return part;
}

void add_polygon(std::span<const Corner> polygon, std::vector<Corner>& scratch, Sums& sums) {
  double area = 0;
  for (std::size_t i = 2; i < polygon.size(); ++i) {
    area += doubled_area(polygon[0].p, polygon[i - 1].p, polygon[i].p) / 2;
  }
  sums.area.add(area);
  const auto has = [&](double sign) {
    return std::ranges::any_of(polygon, [&](const Corner& corner) { return sign * corner.difference > 0; });
  };
  if (has(1)) {
    const Part part = part_of(polygon, 1, scratch);
    sums.above.add(part.integral);
    sums.area_above.add(part.area);
  }
  if (has(-1)) {
    const Part part = part_of(polygon, -1, scratch);
    sums.below.add(part.integral);
    sums.area_below.add(part.area);
  }
}

std::array<Point2, 3> corners_from(const Tin& tin, TriangleId t, Point2 origin) {
  std::array<Point2, 3> corners;
  for (std::size_t i = 0; i < 3; ++i) {
    const Point2 p = tin.point(tin.triangle(t)[i]);
    corners[i] = {p.x - origin.x, p.y - origin.y};
  }
  return corners;
}

Plane plane_of(const Tin& tin, TriangleId t, const std::array<Point2, 3>& at) {
  const auto z = [&](std::size_t i) { return tin.height(tin.triangle(t)[i]); };
  const double area = doubled_area(at[0], at[1], at[2]);
  const double bz = z(1) - z(0), cz = z(2) - z(0);
  Plane plane;
  plane.by_x = (bz * (at[2].y - at[0].y) - cz * (at[1].y - at[0].y)) / area;
  plane.by_y = (cz * (at[1].x - at[0].x) - bz * (at[2].x - at[0].x)) / area;
  plane.at_origin = z(0) - plane.by_x * at[0].x - plane.by_y * at[0].y;
  return plane;
}

// Keeps what lies to the left of ab, or on it.
void clip(std::vector<Point2>& polygon, Point2 a, Point2 b, std::vector<Point2>& scratch) {
  scratch.clear();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point2 p = polygon[i], q = polygon[i + 1 == polygon.size() ? 0 : i + 1];
    const double at_p = doubled_area(a, b, p), at_q = doubled_area(a, b, q);
    if (at_p >= 0) scratch.push_back(p);
    if ((at_p > 0 && at_q < 0) || (at_p < 0 && at_q > 0)) {
      const double t = at_p / (at_p - at_q);
      scratch.push_back({p.x + t * (q.x - p.x), p.y + t * (q.y - p.y)});
    }
  }
  polygon.swap(scratch);
}

constexpr std::size_t kTrianglesBetweenChecks = 4096;

}  // namespace

Volumes volume_above(const Tin& tin, double height, const Progress& progress) {
  Sums sums;
  std::vector<Corner> scratch;
  for (std::size_t i = 0; i < tin.triangle_count(); ++i) {
    if (i % kTrianglesBetweenChecks == 0) progress.check();
    const TriangleId t{i};
    const auto at = corners_from(tin, t, tin.point(tin.triangle(t)[0]));
    std::array<Corner, 3> polygon;
    for (std::size_t k = 0; k < 3; ++k) polygon[k] = {at[k], tin.height(tin.triangle(t)[k]) - height};
    add_polygon(polygon, scratch, sums);
  }
  return sums.volumes();
}

Volumes volume_between(const Tin& tin, const Tin& base, const Progress& progress) {
  const TriangleGrid grid(base);
  Sums sums;
  std::vector<Point2> polygon, clipped;
  std::vector<Corner> corners, scratch;
  for (std::size_t i = 0; i < tin.triangle_count(); ++i) {
    if (i % kTrianglesBetweenChecks == 0) progress.check();
    const TriangleId t{i};
    const Point2 origin = tin.point(tin.triangle(t)[0]);
    const auto at = corners_from(tin, t, origin);
    const Plane plane = plane_of(tin, t, at);
    Box2 box;
    for (const VertexId v : tin.triangle(t)) box.add(tin.point(v));
    grid.visit({box.x_min, box.y_min}, {box.x_max, box.y_max}, [&](TriangleId other) {
      const auto there = corners_from(base, other, origin);
      polygon.assign(at.begin(), at.end());
      for (std::size_t side = 0; side < 3 && polygon.size() >= 3; ++side) {
        clip(polygon, there[side], there[(side + 1) % 3], clipped);
      }
      if (polygon.size() < 3) return;
      const Plane below = plane_of(base, other, there);
      corners.clear();
      for (const Point2 p : polygon) corners.push_back({p, plane.height(p) - below.height(p)});
      add_polygon(corners, scratch, sums);
    });
  }
  return sums.volumes();
}

}  // namespace thalweg
