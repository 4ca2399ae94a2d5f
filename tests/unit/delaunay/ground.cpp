// What build_ground promises: ids, duplicates, lines with and without heights, boundaries, errors.
#include <thalweg/base/error.hpp>
#include <thalweg/delaunay/ground.hpp>
#include <thalweg/mesh/change_tin.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <utility>

namespace thalweg {
namespace {

using testing::HasSubstr;

struct Point3 {
  double x, y, z;
};

Survey make_survey(const std::vector<Point3>& points) {
  Survey survey;
  survey.sources = {{"points.csv", ""}, {"lines.gpkg", "valleys"}};
  survey.points.runs = {{0, 0}};
  for (const auto& [x, y, z] : points) {
    survey.points.xy.push_back({x, y});
    survey.points.z.push_back(z);
  }
  return survey;
}

void add_hard(Survey& survey, const std::vector<Point3>& vertices, EdgeKind kind = EdgeKind::Breakline) {
  SurveyLine line{.kind = kind, .xy = {}, .z = {}, .source = 1, .feature = 12, .part = 0};
  line.feature += static_cast<std::int64_t>(survey.lines.size());
  for (const auto& [x, y, z] : vertices) {
    line.xy.push_back({x, y});
    line.z.push_back(z);
  }
  survey.lines.push_back(line);
}

void add_soft(Survey& survey, std::vector<Point2> vertices, EdgeKind kind = EdgeKind::Breakline) {
  survey.lines.push_back({.kind = kind,
                          .xy = std::move(vertices),
                          .z = {},
                          .source = 1,
                          .feature = 12 + static_cast<std::int64_t>(survey.lines.size()),
                          .part = 0});
}

Ground build(const Survey& survey, const GroundOptions& options = {}) {
  Progress progress;
  return build_ground(survey, options, progress);
}

struct Failure {
  ErrorCode code;
  std::string message;
};

std::optional<Failure> failure_of(const Survey& survey, const GroundOptions& options = {}) {
  try {
    build(survey, options);
  } catch (const Error& error) {
    return Failure{error.code(), error.what()};
  }
  return std::nullopt;
}

ErrorCode code_of(const Survey& survey, const GroundOptions& options = {}) {
  const auto failure = failure_of(survey, options);
  return failure ? failure->code : ErrorCode::Internal;
}

double height_at(const Ground& ground, Point2 p) {
  for (std::size_t v = 0; v < ground.tin.vertex_count(); ++v) {
    if (ground.tin.point(VertexId{v}) == p) return ground.tin.height(VertexId{v});
  }
  return std::numeric_limits<double>::quiet_NaN();
}

const std::vector<Point3> kSquare{{0, 0, 0}, {10, 0, 0}, {10, 10, 10}, {0, 10, 10}};

TEST(Ground, NamesVerticesInOrderOfAppearance) {
  Survey survey = make_survey({{0, 0, 1}, {10, 0, 2}, {0, 0, 1}, {10, 10, 3}, {0, 10, 4}});
  add_hard(survey, {{2, 1, 5}, {8, 9, 5}});
  add_hard(survey, {{2, 9, 5}, {10, 0, 2}, {8, 1, 5}});
  const Ground ground = build(survey);
  ASSERT_EQ(ground.tin.vertex_count(), 9U);
  EXPECT_EQ(ground.duplicates_merged, 1U);
  EXPECT_EQ(ground.crossings, 1U);
  const std::vector<VertexId> of_points{VertexId{0}, VertexId{1}, VertexId{0}, VertexId{2}, VertexId{3}};
  EXPECT_EQ(ground.point_vertices, of_points);
  EXPECT_EQ(ground.tin.point(VertexId{4}), (Point2{2, 1}));
  EXPECT_EQ(ground.tin.point(VertexId{6}), (Point2{2, 9}));
  EXPECT_EQ(ground.tin.point(VertexId{7}), (Point2{8, 1}));
  EXPECT_EQ(ground.origins[6].kind, VertexOrigin::Kind::LineVertex);
  EXPECT_EQ(ground.origins[6].index, 1U);
  EXPECT_EQ(ground.origins[8].kind, VertexOrigin::Kind::Crossing);
  EXPECT_EQ(ground.tin.constraint_edges().size(), 5U);
}

TEST(Ground, GivesBackThePointsOfASurveyThatIsHandedOver) {
  Survey survey = make_survey({{0, 0, 1}, {10, 0, 2}, {0, 0, 4}, {10, 10, 3}, {0, 10, 4}});
  add_hard(survey, {{2, 1, 5}, {8, 9, 5}});
  add_hard(survey, {{2, 9, 5}, {10, 0, 7}, {8, 1, 5}});
  const Ground kept = build(survey);
  Progress progress;
  const Ground handed_over = build_ground(std::move(survey), {}, progress);
  EXPECT_EQ(survey.points.xy.capacity(), 0U);  // NOLINT(bugprone-use-after-move): what it promises
  EXPECT_EQ(survey.lines.size(), 2U);
  EXPECT_TRUE(std::ranges::equal(kept.tin.triangles(), handed_over.tin.triangles()));
  EXPECT_TRUE(std::ranges::equal(kept.tin.heights(), handed_over.tin.heights()));
  EXPECT_EQ(handed_over.duplicates_merged, 1U);
  ASSERT_EQ(handed_over.conflicts.size(), kept.conflicts.size());
  for (std::size_t i = 0; i < kept.conflicts.size(); ++i) {
    EXPECT_EQ(kept.conflicts[i].source_a, handed_over.conflicts[i].source_a);
  }
}

TEST(Ground, DuplicateRules) {
  std::vector<Point3> points = kSquare;
  points.push_back({0, 0, 6});
  points.push_back({0, 0, 3});
  const Survey survey = make_survey(points);
  const auto with = [&](DuplicateRule rule) {
    return height_at(build(survey, {.duplicates = rule}), {0, 0});
  };
  EXPECT_EQ(with(DuplicateRule::First), 0);
  EXPECT_EQ(with(DuplicateRule::Last), 3);
  EXPECT_EQ(with(DuplicateRule::Lowest), 0);
  EXPECT_EQ(with(DuplicateRule::Highest), 6);
  EXPECT_EQ(with(DuplicateRule::Mean), 3);
  const Ground ground = build(survey, {.duplicates = DuplicateRule::Last});
  ASSERT_EQ(ground.conflicts.size(), 2U);
  EXPECT_EQ(ground.conflicts[0].kind, Conflict::Kind::DuplicatePoint);
  EXPECT_EQ(ground.conflicts[0].source_a, "points.csv point 1");
  EXPECT_EQ(ground.conflicts[0].source_b, "points.csv point 5");
  EXPECT_EQ(ground.conflicts[0].z_used, 3);
}

// Many blocks of vertices, with conflicts of points and of lines in each.
TEST(Ground, ConflictsAreInOrderOnAnyNumberOfThreads) {
  std::vector<Point3> points;
  for (int y = 0; y < 200; ++y) {
    for (int x = 0; x < 300; ++x) points.push_back({1.0 * x, 1.0 * y, 0});
  }
  for (std::size_t i = 0; i < points.size(); i += 700) points.push_back({points[i].x, points[i].y, 1});
  Survey survey = make_survey(points);
  for (int y = 1; y < 200; y += 10) add_hard(survey, {{0, 1.0 * y, 2}, {299, 1.0 * y, 2}});
  add_hard(survey, {{5, 0, 3}, {5, 199, 3}});
  GroundOptions options;
  const auto conflicts = [&] { return build(survey, options).conflicts; };
  const std::vector<Conflict> by_one = tbb::task_arena(1).execute(conflicts);
  const std::vector<Conflict> by_four = tbb::task_arena(4).execute(conflicts);
  ASSERT_GT(by_one.size(), 6000U);
  ASSERT_EQ(by_one.size(), by_four.size());
  for (std::size_t i = 0; i < by_one.size(); ++i) {
    EXPECT_EQ(by_one[i].xy, by_four[i].xy);
    EXPECT_EQ(by_one[i].source_b, by_four[i].source_b);
    if (i == 0) continue;
    EXPECT_LE(std::pair(by_one[i - 1].xy.y, by_one[i - 1].xy.x), std::pair(by_one[i].xy.y, by_one[i].xy.x));
  }
  options.crossing = CrossingRule::Error;
  const auto message = [&] {
    try {
      build(survey, options);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const std::string first = tbb::task_arena(1).execute(message);
  EXPECT_THAT(first, HasSubstr("feature 12"));
  EXPECT_EQ(tbb::task_arena(4).execute(message), first);
}

TEST(Ground, EqualDuplicatesAreNoConflict) {
  std::vector<Point3> points = kSquare;
  points.push_back({0, 0, 0});
  EXPECT_TRUE(build(make_survey(points)).conflicts.empty());
}

TEST(Ground, FindsAllEqualPositionsAmongMany) {
  // Columns and rows in all signs, zero in both; each position up to three times, far apart in the order.
  std::vector<Point3> points;
  std::map<std::pair<double, double>, std::size_t> first;
  std::vector<std::size_t> expected;
  for (int turn = 0; turn < 3; ++turn) {
    for (int i = 0; i < 9000; ++i) {
      if ((i + turn) % 4 == 0) continue;
      double x = i % 95 - 47, y = i / 95 - 40;
      if (turn == 1) x = x == 0 ? -x : x, y = y == 0 ? -y : y;
      points.push_back({x, y, 1});
      expected.push_back(first.emplace(std::pair(x, y), first.size()).first->second);
    }
  }
  for (const bool with_line : {false, true}) {
    Survey survey = make_survey(points);
    if (with_line) add_hard(survey, {{-47, -40, 1}, {0, 0, 1}, {20, 11, 1}});
    const Ground ground = build(survey);
    EXPECT_EQ(ground.duplicates_merged, points.size() - first.size());
    ASSERT_EQ(ground.point_vertices.size(), points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      ASSERT_EQ(ground.point_vertices[i].index(), expected[i]) << "point " << i;
    }
  }
}

TEST(Ground, SnapsToTheFirstRepresentativeInOrderOfXThenY) {
  std::vector<Point3> points = kSquare;
  points.insert(points.begin(), {5.4, 5, 7});
  points.push_back({5, 5, 8});
  points.push_back({5.8, 5, 9});
  Survey survey = make_survey(points);
  add_hard(survey, {{5.1, 5.1, 3}, {8, 8, 4}, {8.2, 8.1, 4}});
  const Ground ground = build(survey, {.snap = 0.5});
  // 5.4 joins 5; 5.8 is too far from 5; (5.1, 5.1) joins 5; (8.2, 8.1) joins (8, 8).
  EXPECT_EQ(ground.tin.vertex_count(), 4U + 2U + 1U);
  EXPECT_EQ(ground.tin.point(VertexId{0}), (Point2{5, 5}));
  EXPECT_EQ(ground.point_vertices[0], ground.point_vertices[5]);
  EXPECT_EQ(ground.tin.point(ground.point_vertices[6]), (Point2{5.8, 5}));
  EXPECT_EQ(height_at(ground, {5, 5}), 3);
  EXPECT_EQ(ground.duplicates_merged, 1U);
}

TEST(Ground, HardLinesBeatPoints) {
  std::vector<Point3> points = kSquare;
  points.push_back({5, 5, 42});
  points.push_back({2, 2, 43});
  Survey survey = make_survey(points);
  add_hard(survey, {{2, 2, 1}, {8, 8, 3}});
  const Ground ground = build(survey);
  EXPECT_EQ(height_at(ground, {5, 5}), 2);
  EXPECT_EQ(height_at(ground, {2, 2}), 1);
  ASSERT_EQ(ground.conflicts.size(), 2U);
  EXPECT_EQ(ground.conflicts[0].kind, Conflict::Kind::PointOnLine);
  EXPECT_EQ(ground.conflicts[0].z_a, 42);
  EXPECT_EQ(ground.conflicts[0].z_b, 2);
  EXPECT_EQ(ground.conflicts[0].z_used, 2);
  EXPECT_EQ(ground.conflicts[0].source_b, "lines.gpkg|valleys feature 12 part 0 between vertices 0 and 1");
  EXPECT_EQ(ground.conflicts[1].source_b, "lines.gpkg|valleys feature 12 part 0 vertex 0");
}

TEST(Ground, CrossingRules) {
  const auto crossed = [](EdgeKind a, EdgeKind b, CrossingRule rule) {
    Survey survey = make_survey(kSquare);
    add_hard(survey, {{2, 2, 4}, {8, 8, 4}}, a);
    add_hard(survey, {{2, 8, 6}, {8, 2, 6}}, b);
    const Ground ground = build(survey, {.crossing = rule});
    EXPECT_EQ(ground.conflicts.size(), 1U);
    EXPECT_EQ(ground.conflicts.at(0).kind, Conflict::Kind::Crossing);
    return height_at(ground, {5, 5});
  };
  const auto [plain, ridge, valley] = std::tuple(EdgeKind::Breakline, EdgeKind::Ridge, EdgeKind::Valley);
  EXPECT_EQ(crossed(plain, plain, CrossingRule::Auto), 5);
  EXPECT_EQ(crossed(plain, ridge, CrossingRule::Auto), 6);
  EXPECT_EQ(crossed(valley, ridge, CrossingRule::Auto), 4);
  EXPECT_EQ(crossed(ridge, ridge, CrossingRule::Auto), 6);
  EXPECT_EQ(crossed(valley, valley, CrossingRule::Higher), 6);
  EXPECT_EQ(crossed(ridge, ridge, CrossingRule::Lower), 4);
  EXPECT_EQ(crossed(valley, ridge, CrossingRule::Mean), 5);
  EXPECT_EQ(crossed(valley, ridge, CrossingRule::First), 4);
  EXPECT_EQ(crossed(valley, ridge, CrossingRule::Last), 6);
}

TEST(Ground, CrossingRuleErrorNamesBothLines) {
  Survey survey = make_survey(kSquare);
  add_hard(survey, {{2, 2, 4}, {8, 8, 4}});
  add_hard(survey, {{2, 8, 4}, {8, 2, 4}});
  const auto failure = failure_of(survey, {.crossing = CrossingRule::Error});
  ASSERT_TRUE(failure);
  EXPECT_EQ(failure->code, ErrorCode::CrossingLines);
  EXPECT_THAT(failure->message, HasSubstr("feature 12"));
  EXPECT_THAT(failure->message, HasSubstr("feature 13"));
  EXPECT_THAT(failure->message, HasSubstr("(5, 5)"));
}

TEST(Ground, BranchesThatShareVerticesAreNoCrossing) {
  Survey survey = make_survey(kSquare);
  add_hard(survey, {{2, 2, 4}, {5, 5, 3}, {8, 8, 2}});
  add_hard(survey, {{2, 8, 5}, {5, 5, 3}});
  EXPECT_FALSE(failure_of(survey, {.crossing = CrossingRule::Error}));
  survey.lines[1].z[1] = 3.5;
  EXPECT_EQ(code_of(survey, {.crossing = CrossingRule::Error}), ErrorCode::CrossingLines);
  const Ground ground = build(survey);
  ASSERT_EQ(ground.conflicts.size(), 1U);
  EXPECT_EQ(ground.conflicts[0].kind, Conflict::Kind::LineVertex);
}

TEST(Ground, TouchAndOverlapAreCrossings) {
  Survey touch = make_survey(kSquare);
  add_hard(touch, {{2, 2, 4}, {8, 8, 4}});
  add_hard(touch, {{2, 8, 4}, {5, 5, 4}});
  EXPECT_EQ(code_of(touch, {.crossing = CrossingRule::Error}), ErrorCode::CrossingLines);
  Survey overlap = make_survey(kSquare);
  add_soft(overlap, {{2, 2}, {6, 6}});
  add_soft(overlap, {{4, 4}, {8, 8}});
  EXPECT_EQ(code_of(overlap, {.crossing = CrossingRule::Error}), ErrorCode::CrossingLines);
  EXPECT_EQ(build(overlap).tin.constraint_edges().size(), 3U);
}

TEST(Ground, KindsOfSharedEdgesAddUp) {
  Survey survey = make_survey(kSquare);
  add_soft(survey, {{2, 2}, {6, 6}, {2, 2}}, EdgeKind::Ridge);
  add_soft(survey, {{6, 6}, {2, 2}}, EdgeKind::Valley);
  const Ground ground = build(survey);
  ASSERT_EQ(ground.tin.constraint_edges().size(), 1U);
  EXPECT_EQ(ground.tin.constraint_edges()[0].kind, EdgeKind::Ridge | EdgeKind::Valley);
}

TEST(Ground, ZeroLengthLinesVanishButTheirVertexStays) {
  Survey survey = make_survey(kSquare);
  add_hard(survey, {{4, 4, 9}, {4, 4, 9}});
  add_hard(survey, {{6, 4, 8}});
  const Ground ground = build(survey);
  EXPECT_EQ(ground.tin.vertex_count(), 6U);
  EXPECT_TRUE(ground.tin.constraint_edges().empty());
}

TEST(Ground, SoftLinesTakeTheSurfaceOfPointsAndHardLines) {
  Survey survey = make_survey(kSquare);
  add_hard(survey, {{0, 5, 20}, {10, 5, 20}});
  add_soft(survey, {{2, 1}, {2, 9}, {0, 10}});
  const Ground ground = build(survey);
  EXPECT_DOUBLE_EQ(height_at(ground, {2, 1}), 4);
  EXPECT_DOUBLE_EQ(height_at(ground, {2, 9}), 12);
  EXPECT_EQ(height_at(ground, {2, 5}), 20);
  EXPECT_TRUE(ground.conflicts.empty());
}

TEST(Ground, SoftVertexOutsideTheHullIsNamed) {
  Survey survey = make_survey(kSquare);
  add_soft(survey, {{2, 2}, {12, 3}}, EdgeKind::Valley);
  const auto failure = failure_of(survey);
  ASSERT_TRUE(failure);
  EXPECT_EQ(failure->code, ErrorCode::OutsideHull);
  EXPECT_THAT(failure->message, HasSubstr("lines.gpkg|valleys feature 12 part 0 vertex 1 at (12, 3)"));
  add_hard(survey, {{10, 10, 1}, {20, 10, 1}, {20, 0, 1}});
  EXPECT_FALSE(failure_of(survey)) << "hard lines enlarge the hull";
}

TEST(Ground, BoundariesThatOverlapAreOne) {
  std::vector<Point3> points;
  for (int y = 0; y <= 10; ++y) {
    for (int x = 0; x <= 10; ++x) points.push_back({x * 1.0, y * 1.0, 3});
  }
  Survey survey = make_survey(points);
  const std::vector<Point2> ring = {{1, 1}, {6, 1}, {6, 5}, {1, 5}, {1, 1}};
  add_soft(survey, ring, EdgeKind::Boundary);
  add_soft(survey, {{5, 1}, {9, 1}, {9, 5}, {5, 5}, {5, 1}}, EdgeKind::Boundary);
  add_soft(survey, {{2, 2}, {3, 2}, {3, 3}, {2, 3}, {2, 2}}, EdgeKind::Boundary);
  add_soft(survey, ring, EdgeKind::Boundary);
  const Ground ground = build(survey);
  EXPECT_EQ(ground.tin.vertex_count(), 9U * 5U);
  EXPECT_EQ(ground.tin.triangle_count(), 2U * 8U * 4U);
}

TEST(Ground, BoundaryDropsWhatIsOutside) {
  std::vector<Point3> points;
  for (int y = 0; y <= 10; ++y) {
    for (int x = 0; x <= 10; ++x) points.push_back({x * 1.0, y * 1.0, 3});
  }
  Survey survey = make_survey(points);
  add_soft(survey, {{2, 2}, {8, 2}, {8, 8}, {2, 8}, {2, 2}}, EdgeKind::Boundary);
  add_soft(survey, {{4.5, 4.5}, {4.5, 5.5}, {5.5, 5.5}, {5.5, 4.5}, {4.5, 4.5}}, EdgeKind::Boundary);
  survey.lines[1].feature = survey.lines[0].feature;  // an inner ring
  add_soft(survey, {{0, 3}, {10, 3}}, EdgeKind::Valley);
  const Ground ground = build(survey);
  EXPECT_EQ(ground.mode, GroundMode::Polygon);
  EXPECT_EQ(ground.tin.vertex_count(), 49U - 1U + 4U);
  EXPECT_EQ(ground.outside_boundary, 121U - 48U);
  EXPECT_FALSE(ground.point_vertices[0].valid());
  EXPECT_TRUE(ground.point_vertices[2 * 11 + 2].valid()) << "on the ring is inside";
  double area = 0;
  for (const Triangle& t : ground.tin.triangles()) {
    const auto [a, b, c] = std::tuple(ground.tin.point(t[0]), ground.tin.point(t[1]), ground.tin.point(t[2]));
    area += ((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)) / 2;
  }
  EXPECT_DOUBLE_EQ(area, 35);
  for (const ConstraintEdge& edge : ground.tin.constraint_edges()) {
    for (const VertexId v : {edge.a, edge.b}) {
      const Point2 p = ground.tin.point(v);
      EXPECT_TRUE(p.x >= 2 && p.x <= 8 && p.y >= 2 && p.y <= 8);
    }
  }
  EXPECT_TRUE(
      std::all_of(ground.tin.heights().begin(), ground.tin.heights().end(), [](double z) { return z == 3; }));
}

// Under both numberings; with a boundary, so that vertices are dropped too.
TEST(Ground, NumberingAlongACurveChangesIdsOnly) {
  std::vector<Point3> points;
  for (int i = 0; i < 400; ++i) {
    const double x = (i * 37) % 101, y = (i * 61) % 103;
    points.push_back({x, y, x + 2 * y});
  }
  Survey survey = make_survey(points);
  add_hard(survey, {{10.5, 11.5, 3}, {80.5, 70.5, 4}});
  for (const bool bounded : {false, true}) {
    if (bounded) add_soft(survey, {{20, 20}, {80, 20}, {80, 80}, {20, 80}, {20, 20}}, EdgeKind::Boundary);
    const Ground plain = build(survey);
    const Ground curved = build(survey, {.numbering = Numbering::AlongCurve});
    EXPECT_TRUE(plain.number.empty());
    ASSERT_EQ(curved.number.size(), plain.tin.vertex_count());
    const Tin renumbered = renumber(curved.tin, curved.number, Progress()).tin;
    EXPECT_TRUE(std::ranges::equal(renumbered.points(), plain.tin.points()));
    EXPECT_TRUE(std::ranges::equal(renumbered.heights(), plain.tin.heights()));
    EXPECT_TRUE(std::ranges::equal(renumbered.triangles(), plain.tin.triangles()));
    EXPECT_TRUE(std::ranges::equal(renumbered.arrays().kinds, plain.tin.arrays().kinds));
    for (std::size_t v = 0; v < curved.number.size(); ++v) {
      const VertexOrigin& origin = plain.origins[curved.number[v].index()];
      EXPECT_EQ(curved.origins[v].kind, origin.kind);
      EXPECT_EQ(curved.origins[v].index, origin.index);
    }
    for (std::size_t i = 0; i < points.size(); ++i) {
      const VertexId v = curved.point_vertices[i];
      EXPECT_EQ(v.valid() ? curved.number[v.index()] : v, plain.point_vertices[i]);
    }
  }
}

TEST(Ground, HolesAreCutOutEvenWhereTheyOverlap) {
  std::vector<Point3> points;
  for (int y = 0; y <= 10; ++y) {
    for (int x = 0; x <= 10; ++x) points.push_back({x * 1.0, y * 1.0, 3});
  }
  Survey survey = make_survey(points);
  add_soft(survey, {{2, 2}, {6, 2}, {6, 6}, {2, 6}, {2, 2}}, EdgeKind::Hole);
  add_soft(survey, {{4, 4}, {8, 4}, {8, 8}, {4, 8}, {4, 4}}, EdgeKind::Hole);
  const Ground ground = build(survey);
  double area = 0;
  for (const Triangle& t : ground.tin.triangles()) {
    const auto [a, b, c] = std::tuple(ground.tin.point(t[0]), ground.tin.point(t[1]), ground.tin.point(t[2]));
    area += ((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)) / 2;
  }
  EXPECT_DOUBLE_EQ(area, 100 - 28);
}

TEST(Ground, AHoleThatIsAPointBoundsNothing) {
  Survey survey = make_survey({{0, 0, 1}, {9, 0, 1}, {9, 9, 1}, {0, 9, 1}});
  add_hard(survey, {{4, 4, 1}, {4, 4, 1}, {4, 4, 1}}, EdgeKind::Hole);
  const Ground ground = build(survey);
  EXPECT_EQ(ground.mode, GroundMode::Hull);
  EXPECT_EQ(ground.tin.vertex_count(), 5U);
  add_hard(survey, {{4, 4, 1}, {4, 4, 1}, {4, 4, 1}}, EdgeKind::Boundary);
  EXPECT_EQ(code_of(survey), ErrorCode::EmptyInput);
}

TEST(Ground, RefusesBadRings) {
  Survey open = make_survey(kSquare);
  add_soft(open, {{2, 2}, {8, 2}, {8, 8}}, EdgeKind::Boundary);
  EXPECT_EQ(code_of(open), ErrorCode::WrongGeometry);
  Survey flat = make_survey(kSquare);
  add_soft(flat, {{2, 2}, {8, 2}, {2, 2}}, EdgeKind::Boundary);
  EXPECT_EQ(code_of(flat), ErrorCode::EmptyInput);
}

TEST(Ground, RefusesWhatHasNoTriangle) {
  EXPECT_EQ(code_of(make_survey({})), ErrorCode::TooFewPoints);
  EXPECT_EQ(code_of(make_survey({{0, 0, 0}, {1, 0, 0}, {0, 0, 0}})), ErrorCode::TooFewPoints);
  EXPECT_EQ(code_of(make_survey({{0, 0, 0}, {1, 1, 0}, {2, 2, 0}})), ErrorCode::Collinear);
  Survey soft = make_survey({});
  add_soft(soft, {{2, 2}, {8, 2}, {8, 8}});
  EXPECT_EQ(code_of(soft), ErrorCode::TooFewPoints);
}

TEST(Ground, LinesAloneSuffice) {
  Survey survey = make_survey({});
  add_hard(survey, {{0, 0, 1}, {4, 0, 2}, {4, 4, 3}});
  EXPECT_EQ(build(survey).tin.triangle_count(), 1U);
}

TEST(Ground, RefusesBadCoordinates) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Survey survey = make_survey({{0, 0, 0}, {1, 0, nan}, {0, 1, 0}});
  const auto failure = failure_of(survey);
  ASSERT_TRUE(failure);
  EXPECT_EQ(failure->code, ErrorCode::BadCoordinate);
  EXPECT_THAT(failure->message, HasSubstr("points.csv point 2"));
  Survey line = make_survey(kSquare);
  add_soft(line, {{2, 2}, {2e15, 3}});
  EXPECT_EQ(code_of(line), ErrorCode::BadCoordinate);
}

TEST(Ground, RefusesAResolutionThatIsNoPowerOfTwo) {
  Progress progress;
  for (const double resolution : {3.0, -1.0, std::numeric_limits<double>::infinity()}) {
    EXPECT_THROW(build_ground(make_survey({{0, 0, 1}}), {.resolution = resolution}, progress), Error);
  }
}

}  // namespace
}  // namespace thalweg
