// Lakes are flat: levels, islands, touching lakes, what gives way.
#include <thalweg/base/error.hpp>
#include <thalweg/delaunay/ground.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <support/random.hpp>

#include <cmath>
#include <numbers>

namespace thalweg {
namespace {

using testing::HasSubstr;

constexpr int kSide = 11;

double slope_height(double x, double y) {
  return x + 0.125 * y;
}

Survey slope() {
  Survey survey;
  survey.sources = {{"points.csv", ""}, {"lakes.gpkg", "lakes"}};
  survey.points.runs = {{0, 0}};
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      survey.points.xy.push_back({static_cast<double>(x), static_cast<double>(y)});
      survey.points.z.push_back(slope_height(x, y));
    }
  }
  return survey;
}

void add(Survey& survey, EdgeKind kind, std::int64_t feature, std::vector<Point2> xy,
         std::vector<double> z = {}) {
  survey.lines.push_back(
      {.kind = kind, .xy = std::move(xy), .z = std::move(z), .source = 1, .feature = feature});
}

std::vector<Point2> box(double x0, double y0, double x1, double y1) {
  return {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}, {x0, y0}};
}

Ground build(const Survey& survey, const GroundOptions& options = {}) {
  Progress progress;
  return build_ground(survey, options, progress);
}

double height_at(const Ground& ground, Point2 p) {
  for (std::size_t v = 0; v < ground.tin.vertex_count(); ++v) {
    if (ground.tin.points()[v] == p) return ground.tin.heights()[v];
  }
  ADD_FAILURE() << "there is no vertex at " << p.x << ", " << p.y;
  return 0;
}

TEST(Lakes, TakeTheHeightOfTheirRings) {
  Survey survey = slope();
  add(survey, EdgeKind::Lake, 1, box(2.5, 2.5, 6.5, 5.5), std::vector<double>(5, 3.25));
  const Ground ground = build(survey);
  EXPECT_EQ(ground.lakes, 1U);
  EXPECT_EQ(ground.points_in_lakes, 4U * 3U - 0U);
  for (std::size_t v = 0; v < ground.tin.vertex_count(); ++v) {
    const Point2 p = ground.tin.points()[v];
    const bool in = p.x >= 2.5 && p.x <= 6.5 && p.y >= 2.5 && p.y <= 5.5;
    EXPECT_EQ(ground.tin.heights()[v], in ? 3.25 : slope_height(p.x, p.y));
  }
  std::size_t shore = 0;
  for (const ConstraintEdge& edge : ground.tin.constraint_edges())
    shore += edge.kind == EdgeKind::Lake ? 1 : 0;
  EXPECT_EQ(shore, 4U);
  ASSERT_EQ(ground.conflicts.size(), 12U);
  EXPECT_EQ(ground.conflicts[0].kind, Conflict::Kind::Lake);
  EXPECT_EQ(ground.conflicts[0].z_a, slope_height(3, 3));
  EXPECT_EQ(ground.conflicts[0].z_used, 3.25);
  EXPECT_THAT(ground.conflicts[0].source_a, HasSubstr("points.csv point 37"));
  EXPECT_THAT(ground.conflicts[0].source_b, HasSubstr("lakes.gpkg|lakes feature 1"));
}

TEST(Lakes, ElseTheLowestHeightOfTheShore) {
  Survey survey = slope();
  add(survey, EdgeKind::Lake, 1, box(3, 3, 6, 5));
  const Ground ground = build(survey);
  const double lowest = slope_height(3, 3);
  for (double x = 3; x <= 6; ++x) EXPECT_EQ(height_at(ground, {x, 4}), lowest);
  EXPECT_EQ(height_at(ground, {7, 4}), slope_height(7, 4));
  // Off the vertices the shore has the height of the surface.
  Survey between = slope();
  add(between, EdgeKind::Lake, 1, box(3.5, 2.75, 6.5, 5.5));
  EXPECT_DOUBLE_EQ(height_at(build(between), {5, 4}), slope_height(3.5, 2.75));
}

TEST(Lakes, IslandsAreNoWater) {
  Survey survey = slope();
  add(survey, EdgeKind::Lake, 1, box(1, 1, 9, 9), std::vector<double>(5, 0.5));
  add(survey, EdgeKind::Lake, 1, box(3, 3, 7, 7), std::vector<double>(5, 0.5));
  const Ground ground = build(survey);
  EXPECT_EQ(height_at(ground, {2, 5}), 0.5);
  EXPECT_EQ(height_at(ground, {3, 5}), 0.5);
  EXPECT_EQ(height_at(ground, {5, 5}), slope_height(5, 5));
  EXPECT_EQ(ground.lakes, 1U);
}

TEST(Lakes, ThatTouchAreOne) {
  Survey survey = slope();
  add(survey, EdgeKind::Lake, 1, box(1, 1, 4, 4), std::vector<double>(5, 2));
  add(survey, EdgeKind::Lake, 2, box(4, 4, 6, 6), std::vector<double>(5, 1));
  add(survey, EdgeKind::Lake, 3, box(8, 8, 9, 9), std::vector<double>(5, 7));
  const Ground ground = build(survey);
  EXPECT_EQ(ground.lakes, 2U);
  EXPECT_EQ(height_at(ground, {2, 2}), 1);
  EXPECT_EQ(height_at(ground, {5, 5}), 1);
  EXPECT_EQ(height_at(ground, {8, 8}), 7);
  EXPECT_TRUE(std::any_of(ground.conflicts.begin(), ground.conflicts.end(), [](const Conflict& c) {
    return c.kind == Conflict::Kind::Lake && c.z_a == 2 && c.z_used == 1;
  }));
  // Two lakes that overlap: what both hold is water, too.
  Survey overlap = slope();
  add(overlap, EdgeKind::Lake, 1, box(1, 1, 5, 5), std::vector<double>(5, 2));
  add(overlap, EdgeKind::Lake, 2, box(3, 3, 7, 7), std::vector<double>(5, 1));
  EXPECT_EQ(height_at(build(overlap), {4, 4}), 1);
}

TEST(Lakes, LinesGiveWay) {
  Survey survey = slope();
  add(survey, EdgeKind::Lake, 1, box(2, 2, 6, 6), std::vector<double>(5, 2));
  add(survey, EdgeKind::Valley, 2, {{0, 4}, {4.5, 4}, {10, 4}}, {0, 4, 9});
  const Ground ground = build(survey);
  for (const double x : {2.0, 3.0, 4.0, 4.5, 5.0, 6.0}) EXPECT_EQ(height_at(ground, {x, 4}), 2) << x;
  EXPECT_NEAR(height_at(ground, {1, 4}), 4.0 / 4.5, 1e-12);
  for (const Conflict& conflict : ground.conflicts) {
    if (conflict.xy == Point2{4.5, 4}) {
      EXPECT_EQ(conflict.z_used, 2);
    }
  }
  EXPECT_TRUE(std::any_of(ground.conflicts.begin(), ground.conflicts.end(), [](const Conflict& c) {
    return c.kind == Conflict::Kind::Lake && c.xy == Point2{4.5, 4} && c.z_a == 4 && c.z_used == 2;
  }));
}

TEST(Lakes, RandomShoresAreFlatInside) {
  test::Random random;
  SCOPED_TRACE(random.trace());
  for (int round = 0; round < 20; ++round) {
    Survey survey = slope();
    const Point2 centre{random.real(3, 7), random.real(3, 7)};
    std::vector<Point2> ring;
    const int count = random.integer(3, 12);
    for (int i = 0; i < count; ++i) {
      const double angle = 2 * std::numbers::pi * i / count, radius = random.real(0.5, 2.8);
      ring.push_back({centre.x + radius * std::cos(angle), centre.y + radius * std::sin(angle)});
    }
    ring.push_back(ring.front());
    add(survey, EdgeKind::Lake, 1, ring);
    const Ground ground = build(survey);
    double lowest = 1e9;
    for (const Point2 p : ring) lowest = std::min(lowest, slope_height(p.x, p.y));
    for (std::size_t t = 0; t < ground.tin.triangle_count(); ++t) {
      const Triangle& corner = ground.tin.triangle(TriangleId{t});
      Point2 middle{};
      for (const VertexId v : corner) {
        middle.x += ground.tin.point(v).x / 3;
        middle.y += ground.tin.point(v).y / 3;
      }
      bool inside = false;
      for (std::size_t i = 0; i + 1 < ring.size(); ++i) {
        const Point2 a = ring[i], b = ring[i + 1];
        if ((a.y > middle.y) == (b.y > middle.y)) continue;
        if (a.x + (middle.y - a.y) / (b.y - a.y) * (b.x - a.x) > middle.x) inside = !inside;
      }
      for (const VertexId v : corner) {
        if (!inside) continue;
        EXPECT_NEAR(ground.tin.height(v), lowest, 1e-9);
        EXPECT_EQ(ground.tin.height(v), ground.tin.height(corner[0]));
      }
    }
  }
}

TEST(Lakes, AnOpenRingIsRefused) {
  Survey survey = slope();
  add(survey, EdgeKind::Lake, 1, {{1, 1}, {3, 1}, {3, 3}});
  try {
    build(survey);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::WrongGeometry);
    EXPECT_THAT(error.what(), HasSubstr("lake"));
  }
}

}  // namespace
}  // namespace thalweg
