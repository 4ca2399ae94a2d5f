// Laws of `measure`: independent of threads and of numbering, equivariant under shifts and scales of powers
// of two.
#include "support/meshes.hpp"

#include <thalweg/terrain/statistics.hpp>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace thalweg {
namespace {

struct Parts {
  std::vector<Point2> points;
  std::vector<double> heights;
  std::vector<Triangle> triangles;
  [[nodiscard]] Tin tin() const { return test::make_tin(points, triangles, {}, heights); }
};

// A lattice whose vertices are moved by less than a quarter, far from the origin.
Parts rough_terrain(test::Random& random) {
  const Tin lattice = test::random_lattice(160, 120, 1000, random);
  Parts parts{{lattice.points().begin(), lattice.points().end()},
              {lattice.heights().begin(), lattice.heights().end()},
              {lattice.triangles().begin(), lattice.triangles().end()}};
  for (Point2& p : parts.points)
    p = {433'000 + p.x + random.real(-0.2, 0.2), 5'120'000 + p.y + random.real(-0.2, 0.2)};
  for (double& z : parts.heights) z *= 0.01;
  return parts;
}

Parts renumbered(const Parts& parts, test::Random& random) {
  std::vector<std::size_t> new_id(parts.points.size());
  std::iota(new_id.begin(), new_id.end(), 0U);
  std::shuffle(new_id.begin(), new_id.end(), random.engine());
  Parts result = parts;
  for (std::size_t v = 0; v < new_id.size(); ++v) {
    result.points[new_id[v]] = parts.points[v];
    result.heights[new_id[v]] = parts.heights[v];
  }
  for (Triangle& t : result.triangles) {
    t = test::triangle(new_id[t[0].index()], new_id[t[1].index()], new_id[t[2].index()]);
  }
  return result;
}

void expect_same(const TinStatistics& a, const TinStatistics& b) {
  EXPECT_EQ(a.area_m2, b.area_m2);
  EXPECT_EQ(a.surface_area_m2, b.surface_area_m2);
  EXPECT_EQ(a.min_angle_deg, b.min_angle_deg);
  EXPECT_EQ(a.angle_histogram, b.angle_histogram);
  EXPECT_EQ(a.slope_histogram, b.slope_histogram);
  EXPECT_EQ(a.aspect_histogram, b.aspect_histogram);
  EXPECT_EQ(a.flat_triangles, b.flat_triangles);
  EXPECT_EQ(a.rim_vertices, b.rim_vertices);
  EXPECT_EQ(a.hull_vertices, b.hull_vertices);
  EXPECT_EQ(a.z_min, b.z_min);
  EXPECT_EQ(a.z_max, b.z_max);
}

TEST(MeasureLaws, NeitherThreadsNorNumbersMatter) {
  test::Random random;
  SCOPED_TRACE(random.trace());
  const Parts parts = rough_terrain(random);
  const TinStatistics expected = measure(parts.tin());
  for (int i = 0; i < 5; ++i) expect_same(measure(renumbered(parts, random).tin()), expected);
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  expect_same(measure(parts.tin()), expected);
}

TEST(MeasureLaws, FiguresAreThoseOfPlainFormulas) {
  test::Random random;
  SCOPED_TRACE(random.trace());
  const Parts parts = rough_terrain(random);
  const Tin tin = parts.tin();
  constexpr double kDegrees = 57.29577951308232;
  double area = 0, surface = 0, smallest = 180;
  std::array<std::size_t, 6> angles{};
  std::array<std::size_t, 9> slopes{};
  for (const Triangle& t : tin.triangles()) {
    const Point2 a = tin.point(t[0]), b = tin.point(t[1]), c = tin.point(t[2]);
    const double lengths[3] = {std::hypot(b.x - a.x, b.y - a.y), std::hypot(c.x - b.x, c.y - b.y),
                               std::hypot(a.x - c.x, a.y - c.y)};
    double least = 180;
    for (int i = 0; i < 3; ++i) {  // law of cosines
      const double p = lengths[i], q = lengths[(i + 1) % 3], r = lengths[(i + 2) % 3];
      least = std::min(least, std::acos((p * p + q * q - r * r) / (2 * p * q)) * kDegrees);
    }
    const double s = (lengths[0] + lengths[1] + lengths[2]) / 2;  // Heron's formula
    const double flat = std::sqrt(s * (s - lengths[0]) * (s - lengths[1]) * (s - lengths[2]));
    // Gradient by Cramer's rule.
    const double dz1 = tin.height(t[1]) - tin.height(t[0]), dz2 = tin.height(t[2]) - tin.height(t[0]);
    const double gx = (dz1 * (c.y - a.y) - dz2 * (b.y - a.y)) / (2 * flat);
    const double gy = (dz2 * (b.x - a.x) - dz1 * (c.x - a.x)) / (2 * flat);
    area += flat;
    surface += flat * std::sqrt(1 + gx * gx + gy * gy);
    smallest = std::min(smallest, least);
    ++angles[std::min<std::size_t>(5, static_cast<std::size_t>(least / 10))];
    ++slopes[static_cast<std::size_t>(std::atan(std::hypot(gx, gy)) * kDegrees / 10)];
  }
  const TinStatistics measured = measure(tin);
  EXPECT_NEAR(measured.area_m2, area, 1e-9 * area);
  EXPECT_NEAR(measured.surface_area_m2, surface, 1e-9 * surface);
  EXPECT_NEAR(measured.min_angle_deg, smallest, 1e-6);
  EXPECT_EQ(measured.angle_histogram, angles);
  EXPECT_EQ(measured.slope_histogram, slopes);
  EXPECT_EQ(std::accumulate(measured.aspect_histogram.begin(), measured.aspect_histogram.end(), 0U),
            tin.triangle_count());
}

TEST(MeasureLaws, PowersOfTwoScaleExactly) {
  test::Random random;
  SCOPED_TRACE(random.trace());
  const Parts parts = rough_terrain(random);
  const TinStatistics once = measure(parts.tin());
  const TinStatistics fourfold =
      measure(parts.tin(), {.horizontal_metres_per_unit = 4, .vertical_metres_per_unit = 4});
  EXPECT_EQ(fourfold.area_m2, 16 * once.area_m2);
  EXPECT_EQ(fourfold.surface_area_m2, 16 * once.surface_area_m2);
  EXPECT_EQ(fourfold.min_angle_deg, once.min_angle_deg);
  EXPECT_EQ(fourfold.slope_histogram, once.slope_histogram);
}

}  // namespace
}  // namespace thalweg
