// densify_lines on a map that bends everywhere: the limit holds, and few vertices do.
#include "support/random.hpp"

#include <thalweg/mesh/densify.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace thalweg {
namespace {

// Longitude and latitude in degrees to a stereographic plane in metres, on a sphere.
Point2 stereographic(Point2 p) {
  constexpr double kRadian = 0.017453292519943295;
  const double lon = (p.x - 180) * kRadian, lat = p.y * kRadian;
  const double scale =
      2 * 6371000 / (1 + std::sin(0.6) * std::sin(lat) + std::cos(0.6) * std::cos(lat) * std::cos(lon));
  return {scale * std::cos(lat) * std::sin(lon),
          scale * (std::cos(0.6) * std::sin(lat) - std::sin(0.6) * std::cos(lat) * std::cos(lon))};
}

double distance_to_line(Point2 a, Point2 b, Point2 p) {
  const double dx = b.x - a.x, dy = b.y - a.y;
  return std::abs(dx * (p.y - a.y) - dy * (p.x - a.x)) / std::hypot(dx, dy);
}

Point2 between(Point2 a, Point2 b, double t) {
  return {a.x + t * std::remainder(b.x - a.x, 360), a.y + t * (b.y - a.y)};
}

TEST(DensifyLaws, NoPieceBendsBeyondTheLimit) {
  test::Random random;
  SCOPED_TRACE(random.trace());
  std::size_t pieces = 0;
  double largest = 0;
  for (int scene = 0; scene < 60; ++scene) {
    Survey survey;
    SurveyLine line;
    Point2 p = {180 + random.real(-3, 3), 35 + random.real(-10, 10)};
    const double step = std::pow(10, random.real(-4, 0.3));
    for (int i = 0; i < 20; ++i) {
      line.xy.push_back({p.x > 180 ? p.x - 360 : p.x, p.y});
      line.z.push_back(random.integer(0, 3));
      p = {p.x + random.real(-step, step), p.y + random.real(-step, step)};
    }
    survey.lines.push_back(line);
    const std::size_t added = densify_lines(survey, stereographic, {.x_period = 360});
    const SurveyLine& dense = survey.lines[0];
    ASSERT_EQ(dense.xy.size(), line.xy.size() + added);
    ASSERT_EQ(dense.z.size(), dense.xy.size());
    auto old = line.xy.begin();
    for (const Point2 q : dense.xy) old += old != line.xy.end() && *old == q ? 1 : 0;
    EXPECT_EQ(old, line.xy.end()) << "old vertices stay, in order";
    for (std::size_t i = 0; i + 1 < dense.xy.size(); ++i, ++pieces) {
      EXPECT_LE(std::abs(dense.xy[i].x), 180);
      const Point2 a = stereographic(dense.xy[i]), b = stereographic(dense.xy[i + 1]);
      for (int k = 1; k < 50; ++k) {
        const Point2 q = stereographic(between(dense.xy[i], dense.xy[i + 1], k / 50.0));
        largest = std::max(largest, distance_to_line(a, b, q));
      }
    }
  }
  EXPECT_LE(largest, 0.1 * 1.005);
  EXPECT_GT(largest, 0.05) << "vertices are not wasted";
  RecordProperty("pieces", std::to_string(pieces));
}

TEST(DensifyLaws, ReversedLinesAreReversed) {
  test::Random random;
  SCOPED_TRACE(random.trace());
  for (int scene = 0; scene < 30; ++scene) {
    Survey there, back;
    SurveyLine line;
    for (int i = 0; i < 6; ++i) {
      line.xy.push_back({180 + random.real(-2, 2), random.real(0, 4)});
      if (line.xy.back().x > 180) line.xy.back().x -= 360;
      line.z.push_back(random.real(0, 100));
    }
    there.lines.push_back(line);
    std::reverse(line.xy.begin(), line.xy.end());
    std::reverse(line.z.begin(), line.z.end());
    back.lines.push_back(line);
    EXPECT_EQ(densify_lines(there, stereographic, {.x_period = 360}),
              densify_lines(back, stereographic, {.x_period = 360}));
    std::reverse(back.lines[0].xy.begin(), back.lines[0].xy.end());
    std::reverse(back.lines[0].z.begin(), back.lines[0].z.end());
    EXPECT_EQ(there.lines[0].xy, back.lines[0].xy);
    EXPECT_EQ(there.lines[0].z, back.lines[0].z);
  }
}

}  // namespace
}  // namespace thalweg
