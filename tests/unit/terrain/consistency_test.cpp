// Drawn lines that are, or are not, what they were drawn as.
#include "support/meshes.hpp"

#include <thalweg/terrain/consistency.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

namespace thalweg {
namespace {

VertexId at(int x, int y) {
  return VertexId{static_cast<std::size_t>((y + 2) * 5 + x + 2)};
}

/// Five by five vertices about the origin, one unit apart; one diagonal a cell, all the same way.
Tin lattice(const std::function<double(int, int)>& height, const std::vector<ConstraintEdge>& lines) {
  std::vector<Point2> points;
  std::vector<double> heights;
  std::vector<Triangle> triangles;
  for (int y = -2; y <= 2; ++y) {
    for (int x = -2; x <= 2; ++x) {
      points.push_back({static_cast<double>(x), static_cast<double>(y)});
      heights.push_back(height(x, y));
      if (x == 2 || y == 2) continue;
      triangles.push_back({at(x, y), at(x + 1, y), at(x, y + 1)});
      triangles.push_back({at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)});
    }
  }
  return {std::move(points), std::move(heights), std::move(triangles), lines};
}

/// Along y = 0, from x = 2 to x = -2.
std::vector<ConstraintEdge> middle(EdgeKind kind) {
  std::vector<ConstraintEdge> lines;
  for (int x = -2; x < 2; ++x) lines.push_back({at(x, 0), at(x + 1, 0), kind});
  return lines;
}

TEST(Consistency, AValleyOfTwoPlanesDrainsAlongItself) {
  const Tin tin = lattice([](int x, int y) { return 0.25 * x + std::abs(y); }, middle(EdgeKind::Valley));
  const Consistency found = check_consistency(tin, {.horizontal_metres_per_unit = 2});
  EXPECT_EQ(found.valley_edges, 4U);
  EXPECT_EQ(found.valley_length_m, 8);
  EXPECT_EQ(found.draining_length_m, 8);
  EXPECT_EQ(found.rising_edges, 0U);
  EXPECT_TRUE(found.places.empty());
}

TEST(Consistency, WaterThatRunsAlongAPlaneIsInNoValley) {
  const Tin tin = lattice([](int x, int) { return x; }, middle(EdgeKind::Valley));
  EXPECT_EQ(check_consistency(tin, {}).draining_length_m, 0);
}

TEST(Consistency, AHumpRisesDownstream) {
  const Tin tin = lattice([](int x, int y) { return x == 0 && y == 0 ? 5 : x + 10 * std::abs(y); },
                          middle(EdgeKind::Valley));
  const Consistency found = check_consistency(tin, {.vertical_metres_per_unit = 0.5});
  ASSERT_EQ(found.places.size(), 1U);
  EXPECT_EQ(found.places[0].kind, Inconsistency::Kind::ValleyRises);
  EXPECT_EQ(found.places[0].from, at(1, 0));
  EXPECT_EQ(found.places[0].to, at(0, 0));
  EXPECT_EQ(found.places[0].rise_m, 2);
  EXPECT_EQ(found.rise_sum_m, 2);
  EXPECT_EQ(found.rise_max_m, 2);
}

/// Around the eight vertices at distance 1 from the middle, and from (1, 0) on to x = 2.
std::vector<ConstraintEdge> lollipop(bool with_tail) {
  std::vector<ConstraintEdge> lines;
  for (int i = -1; i < 1; ++i) {
    for (const int side : {-1, 1}) {
      lines.push_back({at(i, side), at(i + 1, side), EdgeKind::Valley});
      lines.push_back({at(side, i), at(side, i + 1), EdgeKind::Valley});
    }
  }
  if (with_tail) lines.push_back({at(1, 0), at(2, 0), EdgeKind::Valley});
  return lines;
}

TEST(Consistency, ARingRunsBothWaysFromItsHighestVertex) {
  const auto slope = [](int x, int y) { return x == 0 && y == 1 ? 5 : 10 - 4 * x; };
  const Consistency found = check_consistency(lattice(slope, lollipop(true)), {});
  ASSERT_EQ(found.places.size(), 1U);
  EXPECT_EQ(found.places[0].from, at(0, 1));
  EXPECT_EQ(found.places[0].to, at(1, 1));
  EXPECT_EQ(found.places[0].rise_m, 1);
  // By itself it runs to the dip.
  EXPECT_EQ(check_consistency(lattice(slope, lollipop(false)), {}).rising_edges, 0U);
  const auto wave = [&](int x, int y) { return slope(x, y) + (x == 0 && y == -1 ? 7 : 0); };
  EXPECT_EQ(check_consistency(lattice(wave, lollipop(false)), {}).rise_sum_m, 0);
  const auto hump = [&](int x, int y) { return slope(x, y) + (x == 1 && y == -1 ? 5 : 0); };
  EXPECT_EQ(check_consistency(lattice(hump, lollipop(false)), {}).rise_sum_m, 1);
}

TEST(Consistency, TwoValleysDrawnTowardsEachOtherMeetWhereTheyAreLowest) {
  const auto bowl = [](int x, int y) { return (x > 0 ? 2 * x : -x) + 10 * std::abs(y); };
  EXPECT_EQ(check_consistency(lattice(bowl, middle(EdgeKind::Valley)), {}).rising_edges, 0U);
}

TEST(Consistency, ALowestVertexNextToTheEndIsNoMeeting) {
  // Falling to x = -2 takes changes of 2, to the vertex before it 1: no less than half.
  const std::vector<double> heights = {2, 1, 4, 3, 6};
  const Tin tin =
      lattice([&](int x, int y) { return heights[static_cast<std::size_t>(x + 2)] + 10 * std::abs(y); },
              middle(EdgeKind::Valley));
  const Consistency found = check_consistency(tin, {});
  ASSERT_EQ(found.rising_edges, 2U);
  EXPECT_EQ(found.places[0].to, at(0, 0));
  EXPECT_EQ(found.places[1].to, at(-2, 0));
}

TEST(Consistency, AllLinesOfANetRunToOneEnd) {
  // A stem along y = 0 that falls to x = -2 but for its middle reach, and two tributaries.
  std::vector<ConstraintEdge> lines = middle(EdgeKind::Valley);
  for (const int x : {-1, 1}) lines.push_back({at(x, 0), at(x, 1), EdgeKind::Valley});
  const std::vector<double> stem = {0, 4, 3, 3, 9};
  const Tin tin =
      lattice([&](int x, int y) { return stem[static_cast<std::size_t>(x + 2)] + 10 * std::abs(y); }, lines);
  const Consistency found = check_consistency(tin, {});
  ASSERT_EQ(found.places.size(), 1U);
  EXPECT_EQ(found.places[0].from, at(0, 0));
  EXPECT_EQ(found.places[0].to, at(-1, 0));
}

TEST(Consistency, ARidgeOnASlopeIsCrossedAndOneOnACrestIsNot) {
  const Tin slope = lattice([](int, int y) { return y; }, middle(EdgeKind::Ridge));
  EXPECT_EQ(check_consistency(slope, {}).crossed_ridge_edges, 4U);
  EXPECT_EQ(check_consistency(slope, {}).places.size(), 4U);
  const Tin crest = lattice([](int, int y) { return -std::abs(y); }, middle(EdgeKind::Ridge));
  EXPECT_EQ(check_consistency(crest, {}).crossed_ridge_edges, 0U);
}

TEST(Consistency, FlatsAndTrianglesOnValleysAreCounted) {
  std::vector<ConstraintEdge> lines = middle(EdgeKind::Valley);
  lines.push_back({at(0, 0), at(0, 1), EdgeKind::Valley});
  const Tin tin = lattice([](int, int) { return 1; }, lines);
  const Consistency found = check_consistency(tin, {});
  EXPECT_EQ(found.flat_triangles, 32U);
  EXPECT_EQ(found.flat_edges, tin.edge_count());
  EXPECT_EQ(found.triangles_on_valleys, 1U);  // (0, 0), (1, 0), (0, 1)
  EXPECT_EQ(found.undrawn_valley_edges, 0U);
}

}  // namespace
}  // namespace thalweg
