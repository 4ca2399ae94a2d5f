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
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

namespace thalweg {

namespace {

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

Vector3 difference(const Vector3& a, const Vector3& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
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

// Clockwise from north, 0 to 7; 8 where the surface is level. (x, y) points downhill.
std::size_t sector(double x, double y) {
  if (x == 0 && y == 0) return 8;
  if (std::abs(x) <= kTangentOfHalfSector * std::abs(y)) return y > 0 ? 0 : 4;
  if (std::abs(y) <= kTangentOfHalfSector * std::abs(x)) return x > 0 ? 2 : 6;
  return x > 0 ? (y > 0 ? 1 : 3) : (y > 0 ? 7 : 5);
}

// The smallest angle in the plane, as its tangent: it lies opposite of the shortest side.
double smallest_tangent(const std::array<Vector3, 3>& side, double doubled_area) {
  std::size_t shortest = 0;
  for (std::size_t i = 1; i < 3; ++i) {
    if (dot(side[i], side[i]) < dot(side[shortest], side[shortest])) shortest = i;
  }
  const double along = -dot(side[(shortest + 1) % 3], side[(shortest + 2) % 3]);
  return doubled_area / along;
}

void add_triangle(const Tin& tin, const Triangle& t, const MetricScale& scale, Figures& figures) {
  std::size_t first = 0;
  for (std::size_t i = 1; i < 3; ++i) {
    if (tin.point(t[i]) < tin.point(t[first])) first = i;
  }
  std::array<Vector3, 3> corner;
  for (std::size_t i = 0; i < 3; ++i) {
    const VertexId v = t[(first + i) % 3];
    const double z = tin.height(v);
    figures.z_min = std::min(figures.z_min, z);
    figures.z_max = std::max(figures.z_max, z);
    corner[i] = {tin.point(v).x, tin.point(v).y, z};
  }
  std::array<Vector3, 3> side{difference(corner[1], corner[0]), difference(corner[2], corner[1]),
                              difference(corner[0], corner[2])};
  for (Vector3& s : side) {
    s = {s.x * scale.horizontal_metres_per_unit, s.y * scale.horizontal_metres_per_unit,
         s.z * scale.vertical_metres_per_unit};
  }
  const Vector3 up = {side[2].y * side[0].z - side[2].z * side[0].y,
                      side[2].z * side[0].x - side[2].x * side[0].z, cross(side[2], side[0])};
  const double horizontal = std::sqrt(up.x * up.x + up.y * up.y);
  figures.area.add(up.z / 2);
  figures.surface_area.add(std::sqrt(up.x * up.x + up.y * up.y + up.z * up.z) / 2);
  figures.flat += corner[0].z == corner[1].z && corner[1].z == corner[2].z ? 1 : 0;
  const double tangent = smallest_tangent(side, up.z);
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

TinStatistics measure(const Tin& tin, const MetricScale& scale) {
  TinStatistics statistics;
  if (tin.triangle_count() == 0) return statistics;
  constexpr std::size_t kBlock = 8192;
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
