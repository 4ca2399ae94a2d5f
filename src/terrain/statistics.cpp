// Figures of a TIN.
//
// 1. Blocks of triangles with fixed borders are measured in parallel, each into its own figures; the
//    blocks' figures are added in order. Areas are added in double-double, so the rounded sum does not
//    depend on the order of triangles.
// 2. A triangle's figures are computed from its lexicographically smallest corner, so they do not depend on
//    ids.
// 3. Angles are compared by their tangents; one arc tangent at the end.
// 4. Hull: Andrew's monotone chain over the rim's vertices, exact, vertices within a side kept.
#include "base/double_double.hpp"
#include "base/parallel.hpp"

#include <thalweg/geometry/predicates.hpp>
#include <thalweg/terrain/statistics.hpp>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

namespace thalweg {

namespace {

// Triangles that a thread takes at once.
constexpr std::size_t kBlock = 8192;

struct Figures {
  DoubleDouble area;
  DoubleDouble surface_area;
  double smallest_tangent = std::numeric_limits<double>::infinity();
  double z_min = std::numeric_limits<double>::infinity();
  double z_max = -std::numeric_limits<double>::infinity();
  std::array<std::size_t, 6> angles{};
  std::array<std::size_t, 9> slopes{};
  std::array<std::size_t, 9> aspects{};
  std::size_t flat = 0;
};

struct Vector3 {
  double x = 0;
  double y = 0;
  double z = 0;
};

// Tangents of 10, 20, ... degrees.
constexpr std::array<double, 8> kTangent{0.17632698070846498, 0.36397023426620236, 0.57735026918962576,
                                         0.83909963117728001, 1.19175359259420996, 1.73205080756887729,
                                         2.74747741945462228, 5.67128181961770953};
constexpr double kTangentOfHalfSector = 0.41421356237309505;  // 22.5 degrees

double cross(const Vector3& a, const Vector3& b) {
  return a.x * b.y - a.y * b.x;
}
double dot(const Vector3& a, const Vector3& b) {
  return a.x * b.x + a.y * b.y;
}

// How many of the first tangents are reached.
template <std::size_t Count>
std::size_t count_steps(double tangent) {
  std::size_t steps = 0;
  for (std::size_t i = 0; i < Count; ++i) steps += tangent >= kTangent[i] ? 1 : 0;
  return steps;
}

// Clockwise from north, 0 to 7; 8 where the surface is level. (x, y) points downhill. What is to be told of a
// terrain's triangles is not to be foreseen, so here and below no branch depends on it.
std::size_t sector(double x, double y) {
  constexpr std::array<std::uint8_t, 4> kNorthOrSouth{4, 4, 0, 0}, kEastOrWest{6, 2, 6, 2},
      kBetween{5, 3, 7, 1};
  const std::size_t quarter = (x > 0 ? 1 : 0) + (y > 0 ? 2 : 0);
  const std::array<std::size_t, 4> sectors{kBetween[quarter], kNorthOrSouth[quarter], kEastOrWest[quarter],
                                           8};
  const bool steep = std::abs(x) <= kTangentOfHalfSector * std::abs(y);
  const bool shallow = std::abs(y) <= kTangentOfHalfSector * std::abs(x);
  return sectors[(steep ? 1 : 0) + (shallow ? 2 : 0)];  // both only where both are zero
}

/// A triangle from its lexicographically smallest corner on, in metres. No arrays: what is stored in parts
/// and loaded whole costs more than all of the arithmetic.
struct Metric {
  Vector3 first, second, third;       ///< sides: from corner 0 to 1, 1 to 2, 2 to 0
  double z_first, z_second, z_third;  ///< heights of the corners, as they are in the TIN
};

bool comes_first(Point2 a, Point2 b) {
  return ((a.x < b.x ? 1U : 0U) | ((a.x == b.x ? 1U : 0U) & (a.y < b.y ? 1U : 0U))) != 0;
}

[[gnu::always_inline]] inline Metric metric(const Tin& tin, const Triangle& t, const MetricScale& scale) {
  constexpr std::array<std::size_t, 5> kCorner{0, 1, 2, 0, 1};
  std::size_t start = comes_first(tin.point(t[1]), tin.point(t[0])) ? 1 : 0;
  start = comes_first(tin.point(t[2]), tin.point(t[start])) ? 2 : start;
  const VertexId u = t[start], v = t[kCorner[start + 1]], w = t[kCorner[start + 2]];
  const Point2 at_u = tin.point(u), at_v = tin.point(v), at_w = tin.point(w);
  const double z_u = tin.height(u), z_v = tin.height(v), z_w = tin.height(w);
  const double flat = scale.horizontal_metres_per_unit, up = scale.vertical_metres_per_unit;
  return {{(at_v.x - at_u.x) * flat, (at_v.y - at_u.y) * flat, (z_v - z_u) * up},
          {(at_w.x - at_v.x) * flat, (at_w.y - at_v.y) * flat, (z_w - z_v) * up},
          {(at_u.x - at_w.x) * flat, (at_u.y - at_w.y) * flat, (z_u - z_w) * up},
          z_u,
          z_v,
          z_w};
}

// The tangent of the smallest angle in the plane, which has the largest cotangent.
double smallest_tangent(const Metric& t, double doubled_area) {
  return doubled_area / std::max({-dot(t.second, t.third), -dot(t.third, t.first), -dot(t.first, t.second)});
}

void add_triangle(const Tin& tin, const Triangle& t, const MetricScale& scale, Figures& figures) {
  const Metric m = metric(tin, t, scale);
  const double lowest = std::min({m.z_first, m.z_second, m.z_third});
  const double highest = std::max({m.z_first, m.z_second, m.z_third});
  figures.z_min = std::min(figures.z_min, lowest);
  figures.z_max = std::max(figures.z_max, highest);
  const Vector3 up = {m.third.y * m.first.z - m.third.z * m.first.y,
                      m.third.z * m.first.x - m.third.x * m.first.z, cross(m.third, m.first)};
  const double horizontal = std::sqrt(up.x * up.x + up.y * up.y);
  figures.area.add(up.z / 2);
  figures.surface_area.add(std::sqrt(up.x * up.x + up.y * up.y + up.z * up.z) / 2);
  figures.flat += lowest == highest ? 1 : 0;
  const double tangent = smallest_tangent(m, up.z);
  figures.smallest_tangent = std::min(figures.smallest_tangent, tangent);
  ++figures.angles[count_steps<5>(tangent)];
  ++figures.slopes[count_steps<8>(horizontal / up.z)];
  ++figures.aspects[sector(up.x, up.y)];
}

void add_block(const Figures& block, Figures& sum) {
  sum.area.add(block.area);
  sum.surface_area.add(block.surface_area);
  sum.smallest_tangent = std::min(sum.smallest_tangent, block.smallest_tangent);
  sum.z_min = std::min(sum.z_min, block.z_min);
  sum.z_max = std::max(sum.z_max, block.z_max);
  for (std::size_t i = 0; i < sum.angles.size(); ++i) sum.angles[i] += block.angles[i];
  for (std::size_t i = 0; i < sum.slopes.size(); ++i) sum.slopes[i] += block.slopes[i];
  for (std::size_t i = 0; i < sum.aspects.size(); ++i) sum.aspects[i] += block.aspects[i];
  sum.flat += block.flat;
}

// The vertices on the convex hull of sorted points: each of two chains goes along one side, ends included.
std::size_t count_hull(std::vector<Point2> points) {
  if (points.size() < 3) return points.size();
  std::size_t count = 0;
  std::vector<Point2> chain;
  for (int side = 0; side < 2; ++side) {
    chain.clear();
    for (const Point2 p : points) {
      while (chain.size() > 1 && orientation(chain[chain.size() - 2], chain.back(), p) < 0) chain.pop_back();
      chain.push_back(p);
    }
    count += chain.size() - 1;
    std::reverse(points.begin(), points.end());
  }
  return count;
}

void measure_rim(const Tin& tin, TinStatistics& statistics) {
  std::vector<VertexId> rim;
  for (std::size_t i = 0; i < tin.halfedge_count(); ++i) {
    const HalfedgeId h{i};
    if (!tin.on_rim(h)) continue;
    ++statistics.rim_edges;
    rim.push_back(tin.origin(h));
  }
  std::sort(rim.begin(), rim.end());
  rim.erase(std::unique(rim.begin(), rim.end()), rim.end());
  statistics.rim_vertices = rim.size();
  std::vector<Point2> points(rim.size());
  std::transform(rim.begin(), rim.end(), points.begin(), [&](VertexId v) { return tin.point(v); });
  std::sort(points.begin(), points.end());
  statistics.hull_vertices = count_hull(std::move(points));
}

}  // namespace

std::array<std::size_t, 6> measure_angles(const Tin& tin, const MetricScale& scale) {
  std::array<std::atomic<std::size_t>, 6> angles{};
  for_each_block(tin.triangle_count(), kBlock, Progress(), [&](std::size_t begin, std::size_t end) {
    std::array<std::size_t, 6> counts{};
    for (const Triangle& t : tin.triangles().subspan(begin, end - begin)) {
      const Metric m = metric(tin, t, scale);
      ++counts[count_steps<5>(smallest_tangent(m, cross(m.third, m.first)))];
    }
    for (std::size_t i = 0; i < counts.size(); ++i) angles[i] += counts[i];
  });
  return {angles[0], angles[1], angles[2], angles[3], angles[4], angles[5]};
}

TinStatistics measure(const Tin& tin, const MetricScale& scale) {
  TinStatistics statistics;
  if (tin.triangle_count() == 0) return statistics;
  std::vector<Figures> blocks((tin.triangle_count() + kBlock - 1) / kBlock);
  for_each_block(tin.triangle_count(), kBlock, Progress(), [&](std::size_t begin, std::size_t end) {
    Figures figures;
    for (const Triangle& t : tin.triangles().subspan(begin, end - begin))
      add_triangle(tin, t, scale, figures);
    blocks[begin / kBlock] = figures;
  });
  Figures sum;
  for (const Figures& block : blocks) add_block(block, sum);
  statistics.area_m2 = sum.area.value();
  statistics.surface_area_m2 = sum.surface_area.value();
  statistics.min_angle_deg = std::atan(sum.smallest_tangent) * 180 / std::numbers::pi;
  statistics.angle_histogram = sum.angles;
  statistics.slope_histogram = sum.slopes;
  statistics.aspect_histogram = sum.aspects;
  statistics.flat_triangles = sum.flat;
  statistics.z_min = sum.z_min;
  statistics.z_max = sum.z_max;
  measure_rim(tin, statistics);
  return statistics;
}

}  // namespace thalweg
