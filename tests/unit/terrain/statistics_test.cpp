// Figures of TINs that can be worked out by hand.
#include "support/meshes.hpp"

#include <thalweg/terrain/statistics.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace thalweg {
namespace {

using test::make_tin;
using test::triangle;
using testing::ElementsAre;

TEST(Measure, NothingIsZero) {
  const TinStatistics nothing = measure(Tin());
  EXPECT_EQ(nothing.area_m2, 0);
  EXPECT_EQ(nothing.min_angle_deg, 0);
  EXPECT_EQ(nothing.rim_vertices, 0U);
  EXPECT_EQ(measure(make_tin({{0, 0}, {1, 0}}, {})).hull_vertices, 0U);
}

TEST(Measure, ATiltedTriangle) {
  const Tin tin = make_tin({{0, 0}, {4, 0}, {0, 3}}, {triangle(0, 1, 2)}, {}, {0, 3, 0});
  const TinStatistics s = measure(tin);
  EXPECT_DOUBLE_EQ(s.area_m2, 6);
  EXPECT_DOUBLE_EQ(s.surface_area_m2, 6 * 1.25);
  EXPECT_NEAR(s.min_angle_deg, 36.869897645844, 1e-12);
  EXPECT_THAT(s.angle_histogram, ElementsAre(0, 0, 0, 1, 0, 0));
  EXPECT_THAT(s.slope_histogram, ElementsAre(0, 0, 0, 1, 0, 0, 0, 0, 0));   // 36.9 degrees
  EXPECT_THAT(s.aspect_histogram, ElementsAre(0, 0, 0, 0, 0, 0, 1, 0, 0));  // falls to the west
  EXPECT_EQ(s.flat_triangles, 0U);
  EXPECT_EQ(s.rim_vertices, 3U);
  EXPECT_EQ(s.rim_edges, 3U);
  EXPECT_EQ(s.hull_vertices, 3U);
  EXPECT_EQ(s.z_min, 0);
  EXPECT_EQ(s.z_max, 3);
}

TEST(Measure, UnitsAreConverted) {
  const Tin tin = make_tin({{0, 0}, {40, 0}, {0, 30}}, {triangle(0, 1, 2)}, {}, {0, 3000, 0});
  const TinStatistics s =
      measure(tin, {.horizontal_metres_per_unit = 0.1, .vertical_metres_per_unit = 0.001});
  EXPECT_NEAR(s.area_m2, 6, 1e-12);
  EXPECT_NEAR(s.surface_area_m2, 7.5, 1e-12);
  EXPECT_EQ(s.z_max, 3000);
}

TEST(Measure, TheSmallestAngleOfEachTriangleIsBinned) {
  std::vector<Point2> points;
  std::vector<Triangle> triangles;
  for (const double degrees : {5.0, 15.0, 25.0, 35.0, 45.0, 58.0}) {  // isosceles, apart from each other
    const std::size_t n = points.size();
    const double x = static_cast<double>(n) * 10;
    const double half = degrees / 2 * 0.017453292519943295;
    points.insert(points.end(),
                  {{x, 0}, {x + std::cos(half), -std::sin(half)}, {x + std::cos(half), std::sin(half)}});
    triangles.push_back(triangle(n, n + 1, n + 2));
  }
  const TinStatistics s = measure(make_tin(std::move(points), std::move(triangles)));
  EXPECT_THAT(s.angle_histogram, ElementsAre(1, 1, 1, 1, 1, 1));
  EXPECT_NEAR(s.min_angle_deg, 5, 1e-9);
  EXPECT_EQ(s.flat_triangles, 6U);
  EXPECT_THAT(s.slope_histogram, ElementsAre(6, 0, 0, 0, 0, 0, 0, 0, 0));
  EXPECT_THAT(s.aspect_histogram, ElementsAre(0, 0, 0, 0, 0, 0, 0, 0, 6));
}

TEST(Measure, AspectsAreNamedByWhereWaterRuns) {
  const std::vector<std::pair<Point2, std::size_t>> falls{{{0, 1}, 0},  {{1, 1}, 1},  {{1, 0}, 2},
                                                          {{1, -1}, 3}, {{0, -1}, 4}, {{-1, -1}, 5},
                                                          {{-1, 0}, 6}, {{-1, 1}, 7}};
  for (const auto& [downhill, sector] : falls) {
    const std::vector<Point2> points{{0, 0}, {1, 0}, {0, 1}};
    std::vector<double> heights;
    for (const Point2 p : points) heights.push_back(-(p.x * downhill.x + p.y * downhill.y));
    const TinStatistics s = measure(make_tin(points, {triangle(0, 1, 2)}, {}, heights));
    EXPECT_EQ(s.aspect_histogram[sector], 1U) << downhill.x << ' ' << downhill.y;
  }
}

TEST(Measure, HullVerticesLieOnTheHullsSidesToo) {
  test::Random random;
  SCOPED_TRACE(random.trace());
  const TinStatistics s = measure(test::random_lattice(6, 4, 3, random));
  EXPECT_EQ(s.hull_vertices, 16U);
  EXPECT_EQ(s.rim_vertices, 16U);
  EXPECT_EQ(s.rim_edges, 16U);
  EXPECT_DOUBLE_EQ(s.area_m2, 15);
  EXPECT_DOUBLE_EQ(s.min_angle_deg, 45);
  const Tin notched = make_tin({{0, 0}, {4, 0}, {4, 4}, {3, 1}}, {triangle(0, 1, 3), triangle(1, 2, 3)});
  EXPECT_EQ(measure(notched).hull_vertices, 3U);
  EXPECT_EQ(measure(notched).rim_vertices, 4U);
}

}  // namespace
}  // namespace thalweg
