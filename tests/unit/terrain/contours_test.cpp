// Contours against the formulas of a plane, a cone and a saddle, and their laws where heights tie.
#include "terrain_scene.hpp"

#include <thalweg/base/error.hpp>
#include <thalweg/terrain/contours.hpp>
#include <thalweg/terrain/sample_surface.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>
#include <utility>

namespace thalweg {
namespace {

using test::grid_tin;

std::vector<ContourLine> trace(const Tin& tin, double interval, double base = 0) {
  Progress progress;
  return trace_contours(tin, {interval, base}, progress);
}

/// Laws 1 to 3 on every piece, by sampling the surface beside its middle.
void expect_laws(const Tin& tin, const std::vector<ContourLine>& lines, bool may_have_crests) {
  const SurfaceSampler sampler(tin, {});
  std::set<std::pair<Point2, Point2>> pieces;
  for (const ContourLine& line : lines) {
    ASSERT_GE(line.points.size(), 2U);
    EXPECT_TRUE(!line.closed || line.points.front() == line.points.back());
    for (std::size_t i = 1; i < line.points.size(); ++i) {
      const Point2 a = line.points[i - 1], b = line.points[i];
      ASSERT_NE(a, b);
      EXPECT_TRUE(pieces.insert(std::minmax(a, b)).second) << "a piece is there twice";
      const double length = std::hypot(b.x - a.x, b.y - a.y), step = 1e-4;
      if (length < 1e-3) continue;
      const Point2 middle = {(a.x + b.x) / 2, (a.y + b.y) / 2};
      const Point2 right = {middle.x + step * (b.y - a.y) / length, middle.y - step * (b.x - a.x) / length};
      const Point2 left = {2 * middle.x - right.x, 2 * middle.y - right.y};
      const std::vector<Point2> places = {middle, right, left};
      const std::vector<double> z = sampler.sample(places, SurfaceValue::Elevation, Progress());
      EXPECT_TRUE(std::isnan(z[0]) || std::abs(z[0] - line.height) < 1e-9);
      if (may_have_crests || std::isnan(z[1]) || std::isnan(z[2])) continue;
      EXPECT_GE(z[1], line.height - 1e-12);
      EXPECT_LT(z[2], line.height);
    }
  }
}

bool on_frame(Point2 p, double width, double height) {
  return p.x == 0 || p.y == 0 || p.x == width || p.y == height;
}

TEST(Contours, OfAPlaneAreStraightAndEndOnTheRim) {
  const Tin tin = grid_tin(11, 7, [](double x, double y) { return 2 * x + y; });
  const std::vector<ContourLine> lines = trace(tin, 5, 0.25);
  ASSERT_EQ(lines.size(), 6U);  // 0.25, 5.25, ... 25.25 within 0 .. 26
  for (const ContourLine& line : lines) {
    EXPECT_FALSE(line.closed);
    for (const Point2 p : line.points) EXPECT_NEAR(2 * p.x + p.y, line.height, 1e-12);
    EXPECT_TRUE(on_frame(line.points.front(), 10, 6));
    EXPECT_TRUE(on_frame(line.points.back(), 10, 6));
    EXPECT_GT(line.points.back().y, line.points.front().y);  // the ground rises to the right, which is east
  }
  expect_laws(tin, lines, false);
}

TEST(Contours, OfAConeAreClosedRoundsOfItsRadius) {
  const Tin tin = grid_tin(41, 41, [](double x, double y) { return 20 - std::hypot(x - 20, y - 20); });
  const std::vector<ContourLine> lines = trace(tin, 5, 2.5);
  double area_before = 1e9;
  for (const ContourLine& line : lines) {
    if (line.height < 0) continue;  // corners of the square
    ASSERT_TRUE(line.closed) << line.height;
    double area = 0;
    for (std::size_t i = 1; i < line.points.size(); ++i) {
      const Point2 a = line.points[i - 1], b = line.points[i];
      area += (a.x * b.y - a.y * b.x) / 2;
      EXPECT_NEAR(std::hypot(b.x - 20, b.y - 20), 20 - line.height, 0.15);
    }
    EXPECT_LT(area, 0);  // clockwise: the hill is to the right
    EXPECT_LT(-area, area_before);
    area_before = -area;
  }
  expect_laws(tin, lines, false);
}

TEST(Contours, OfASaddleAreHyperbolas) {
  const Tin tin = grid_tin(21, 21, [](double x, double y) { return (x - 10) * (y - 10); });
  const std::vector<ContourLine> lines = trace(tin, 20, 10);
  for (const ContourLine& line : lines) {
    EXPECT_FALSE(line.closed);
    for (const Point2 p : line.points) EXPECT_NEAR((p.x - 10) * (p.y - 10), line.height, 0.5);
  }
  EXPECT_EQ(std::count_if(lines.begin(), lines.end(), [](const ContourLine& l) { return l.height == 30; }),
            2);
  expect_laws(tin, lines, false);
}

TEST(Contours, PlateauHasItsRim) {
  const Tin tin = grid_tin(9, 9, [](double x, double y) {
    return std::min(5.0, 9 - std::max(std::abs(x - 4), std::abs(y - 4)) * 2);
  });
  const std::vector<ContourLine> lines = trace(tin, 100, 5);
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_TRUE(lines[0].closed);
  for (const Point2 p : lines[0].points) EXPECT_EQ(std::max(std::abs(p.x - 4), std::abs(p.y - 4)), 2);
  expect_laws(tin, lines, false);
}

TEST(Contours, FloorAndPeakAtExactlyTheHeightHaveNone) {
  EXPECT_TRUE(
      trace(grid_tin(5, 5, [](double x, double y) { return x == 2 && y == 2 ? 1 : 0; }), 100, 1).empty());
  EXPECT_TRUE(trace(grid_tin(5, 5, [](double, double) { return 1; }), 1).empty());
}

TEST(Contours, CrestAtExactlyTheHeightIsThereOnce) {
  const Tin tin = grid_tin(7, 5, [](double, double y) { return -std::abs(y - 2); });
  const std::vector<ContourLine> lines = trace(tin, 100, 0);
  std::size_t pieces = 0;
  for (const ContourLine& line : lines) {
    for (const Point2 p : line.points) EXPECT_EQ(p.y, 2);
    pieces += line.points.size() - 1;
  }
  EXPECT_EQ(pieces, 6U);
  expect_laws(tin, lines, true);
}

TEST(Contours, LawsOnRandomSteps) {
  std::mt19937 random(20);
  for (int round = 0; round < 40; ++round) {
    std::uniform_int_distribution<int> height(0, 3);
    const Tin tin = grid_tin(8, 8, [&](double, double) { return height(random); });
    expect_laws(tin, trace(tin, 1), true);
    expect_laws(tin, trace(tin, 1, 0.5), false);
  }
}

TEST(Contours, RefusesIntervals) {
  const Tin tin = grid_tin(3, 3, [](double x, double) { return 1e9 * x; });
  EXPECT_THROW(trace(tin, 0), Error);
  EXPECT_THROW(trace(tin, -1), Error);
  EXPECT_THROW(trace(tin, 1), Error);
}

TEST(Contours, TooManyAreRefusedHoweverSmallTheInterval) {
  const Tin tin = grid_tin(3, 3, [](double x, double y) { return 100 + x + y; });
  for (const double interval : {1e-7, 1e-310, 5e-324}) EXPECT_THROW(trace(tin, interval), Error);
}

}  // namespace
}  // namespace thalweg
