// Profiles of surfaces whose heights are known.
#include "support/meshes.hpp"

#include <thalweg/delaunay/surface.hpp>
#include <thalweg/delaunay/triangulate.hpp>
#include <thalweg/mesh/rim.hpp>
#include <thalweg/terrain/profile.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace thalweg {
namespace {

using test::make_tin;
using test::triangle;

Tin pyramid() {
  return make_tin({{0, 0}, {4, 0}, {4, 4}, {0, 4}, {2, 2}},
                  {triangle(0, 1, 4), triangle(1, 2, 4), triangle(2, 3, 4), triangle(3, 0, 4)}, {},
                  {0, 0, 0, 0, 3});
}

std::vector<ProfilePoint> trace(const Tin& tin, const std::vector<Point2>& line) {
  return ProfileTracer(tin).trace(line, Progress());
}

TEST(Profile, AcrossAPyramid) {
  const Tin tin = pyramid();
  const auto profile = trace(tin, {{0, 1}, {4, 1}});
  ASSERT_EQ(profile.size(), 4U);
  const double x[] = {0, 1, 3, 4}, z[] = {0, 1.5, 1.5, 0};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_DOUBLE_EQ(profile[i].distance, x[i]);
    EXPECT_DOUBLE_EQ(profile[i].xy.x, x[i]);
    EXPECT_DOUBLE_EQ(profile[i].z, z[i]);
    EXPECT_EQ(profile[i].part, 0U);
  }
  const auto apex = trace(tin, {{0, 2}, {4, 2}});
  ASSERT_EQ(apex.size(), 3U);
  EXPECT_EQ(apex[1].z, 3);
  const auto edge = trace(tin, {{0, 0}, {4, 4}});  // along edges, through the apex
  ASSERT_EQ(edge.size(), 3U);
  EXPECT_EQ(edge[1].z, 3);
  EXPECT_DOUBLE_EQ(edge[2].distance, std::sqrt(32));
  const auto within = trace(tin, {{1.5, 0.5}, {1.75, 0.5}, {1.75, 0.25}});
  ASSERT_EQ(within.size(), 3U);
  EXPECT_DOUBLE_EQ(within[2].distance, 0.5);
  EXPECT_DOUBLE_EQ(within[2].z, 0.375);
}

TEST(Profile, OffTheSurfaceANewPartBegins) {
  const Tin tin = pyramid();
  const auto profile = trace(tin, {{-1, 1}, {5, 1}, {5, 3}, {-1, 3}});
  ASSERT_EQ(profile.size(), 8U);
  for (std::size_t i = 0; i < 8; ++i) EXPECT_EQ(profile[i].part, i / 4);
  EXPECT_DOUBLE_EQ(profile[0].distance, 1);
  EXPECT_DOUBLE_EQ(profile[4].distance, 9);
  EXPECT_TRUE(trace(tin, {{10, 10}, {11, 11}}).empty());
  // Over a gap between two triangles.
  const Tin two = make_tin({{0, 0}, {1, 0}, {0, 2}, {3, 0}, {4, 0}, {4, 2}},
                           {triangle(0, 1, 2), triangle(3, 4, 5)}, {}, {0, 1, 2, 3, 4, 5});
  const auto gap = trace(two, {{0, 0}, {4, 0}});
  ASSERT_EQ(gap.size(), 4U);
  EXPECT_EQ(gap[1].part, 0U);
  EXPECT_EQ(gap[2].part, 1U);
  EXPECT_EQ(gap[2].z, 3);
}

TEST(Profile, BetweenPlacesTheSurfaceIsStraight) {
  test::Random random;
  SCOPED_TRACE(random.trace());
  std::vector<Point2> points{{0, 0}, {10, 0}, {10, 10}, {0, 10}};
  std::vector<double> heights;
  while (points.size() < 80) points.push_back({random.real(0, 10), random.real(0, 10)});
  for (std::size_t i = 0; i < points.size(); ++i) heights.push_back(random.real(0, 5));
  Progress progress;
  const Tin tin = triangulate(points, heights, {}, progress);
  const SurfaceLocator surface(tin);
  for (int round = 0; round < 30; ++round) {
    std::vector<Point2> line;
    for (int i = 0; i < 4; ++i) line.push_back({random.real(0, 10), random.real(0, 10)});
    const auto profile = trace(tin, line);
    ASSERT_GE(profile.size(), 4U);
    for (std::size_t i = 0; i + 1 < profile.size(); ++i) {
      EXPECT_EQ(profile[i].part, 0U);
      EXPECT_LT(profile[i].distance, profile[i + 1].distance);
      const double t = random.real(0.01, 0.99);
      const ProfilePoint &p = profile[i], &q = profile[i + 1];
      const Point2 between{p.xy.x + t * (q.xy.x - p.xy.x), p.xy.y + t * (q.xy.y - p.xy.y)};
      const auto z = surface.height_at(between);
      ASSERT_TRUE(z);
      EXPECT_NEAR(*z, p.z + t * (q.z - p.z), 1e-9);
    }
  }
}

TEST(Profile, AlongTheRimIsOnePart) {
  test::Random random;
  SCOPED_TRACE(random.trace());
  std::vector<Point2> points;
  std::vector<double> heights;
  for (int i = 0; i < 300; ++i) {
    points.push_back({random.real(500000, 501000), random.real(5.2e6, 5.201e6)});
    heights.push_back(random.real(0, 5));
  }
  Progress progress;
  const Tin tin = triangulate(points, heights, {}, progress);
  std::vector<Point2> line;
  const auto loops = rim_loops(tin);
  for (const VertexId v : loops.at(0)) line.push_back(tin.point(v));
  line.push_back(line.front());
  const auto profile = trace(tin, line);
  ASSERT_EQ(profile.size(), line.size());
  for (const ProfilePoint& place : profile) EXPECT_EQ(place.part, 0U);
  std::reverse(line.begin(), line.end());
  EXPECT_EQ(trace(tin, line).back().part, 0U);
}

}  // namespace
}  // namespace thalweg
