// Terrains whose flow is known.
#include "support/meshes.hpp"
#include "terrain_scene.hpp"

#include <thalweg/terrain/catchments.hpp>
#include <thalweg/terrain/network.hpp>
#include <thalweg/terrain/pit_table.hpp>
#include <thalweg/terrain/statistics.hpp>
#include <thalweg/terrain/surface_flow.hpp>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <numeric>
#include <vector>

namespace thalweg {
namespace {

/// A lattice of (2 half + 1)^2 vertices about the origin, one unit apart, diagonals all the same way.
Tin lattice(int half, const std::function<double(double, double)>& height) {
  std::vector<Point2> points;
  std::vector<double> heights;
  std::vector<Triangle> triangles;
  const auto side = static_cast<std::size_t>(2 * half + 1);
  for (int y = -half; y <= half; ++y) {
    for (int x = -half; x <= half; ++x) {
      points.push_back({static_cast<double>(x), static_cast<double>(y)});
      heights.push_back(height(x, y));
    }
  }
  for (std::size_t row = 0; row + 1 < side; ++row) {
    for (std::size_t column = 0; column + 1 < side; ++column) {
      const std::size_t a = row * side + column, b = a + 1, c = b + side, d = a + side;
      triangles.push_back(test::triangle(a, b, d));
      triangles.push_back(test::triangle(b, c, d));
    }
  }
  return test::make_tin(std::move(points), std::move(triangles), {}, std::move(heights));
}

VertexId at(int half, int x, int y) {
  return VertexId{static_cast<std::size_t>((y + half) * (2 * half + 1) + x + half)};
}

SurfaceFlow flow_on(const Tin& tin) {
  Progress progress;
  return {tin, {}, progress};
}

PitTable pits_of(const SurfaceFlow& flow) {
  Progress progress;
  return tabulate_pits(flow, {}, progress);
}

double doubled_area(const CatchmentRing& ring) {
  double sum = 0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Point2 p = ring[i].xy, q = ring[(i + 1) % ring.size()].xy;
    sum += p.x * q.y - p.y * q.x;
  }
  return sum;
}

/// The polygons' areas are those of the sinks.
void expect_catchments_tile(const SurfaceFlow& flow) {
  Progress progress;
  std::vector<std::uint32_t> group(flow.sinks().size());
  std::iota(group.begin(), group.end(), 0U);
  std::vector<double> area(group.size(), 0);
  for (const Catchment& catchment : outline_catchments(flow, group, progress)) {
    for (const CatchmentPolygon& polygon : catchment.polygons) {
      area[catchment.group] += doubled_area(polygon.outer) / 2;
      for (const CatchmentRing& hole : polygon.holes) area[catchment.group] += doubled_area(hole) / 2;
    }
  }
  for (std::size_t s = 0; s < area.size(); ++s) EXPECT_NEAR(area[s], flow.sinks()[s].area, 1e-9) << s;
}

TEST(AnalyticFlow, ATiltedPlaneDrainsInStraightLines) {
  const Tin tin = lattice(8, [](double x, double y) { return 3 * x + 2 * y; });
  const SurfaceFlow flow = flow_on(tin);
  EXPECT_TRUE(pits_of(flow).pits.empty());
  for (const Point2 start : {Point2{3.3, 4.2}, Point2{7.5, -1.25}, Point2{0.4, 7.7}}) {
    for (std::size_t t = 0; t < tin.triangle_count(); ++t) {
      const Triangle& c = tin.triangle(TriangleId{t});
      const Point2 a = tin.point(c[0]), b = tin.point(c[1]), d = tin.point(c[2]);
      const auto left = [](Point2 p, Point2 q, Point2 r) {
        return (q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x) > 0;
      };
      if (!left(a, b, start) || !left(b, d, start) || !left(d, a, start)) continue;
      const FlowPath path = flow.path_from(TriangleId{t}, start);
      EXPECT_TRUE(tin.on_rim(path.points.back().edge));
      for (const FlowPoint& p : path.points) {
        EXPECT_NEAR(2 * (p.xy.x - start.x), 3 * (p.xy.y - start.y), 1e-12);
        EXPECT_NEAR(p.z, 3 * p.xy.x + 2 * p.xy.y, 1e-12);
      }
    }
  }
  for (std::size_t h = 0; h < tin.halfedge_count(); ++h) EXPECT_FALSE(flow.is_valley(HalfedgeId{h}));
}

TEST(AnalyticFlow, AConeShedsAllOverTheRimAndAFunnelHoldsAll) {
  const Tin cone = lattice(8, [](double x, double y) { return -std::hypot(x, y); });
  const SurfaceFlow off = flow_on(cone);
  EXPECT_TRUE(pits_of(off).pits.empty());
  EXPECT_EQ(off.path_from(at(8, 0, 0)).points.front().z, 0);
  const Tin funnel = lattice(8, [](double x, double y) { return std::hypot(x, y); });
  const SurfaceFlow in = flow_on(funnel);
  const PitTable table = pits_of(in);
  ASSERT_EQ(table.pits.size(), 1U);
  EXPECT_EQ(table.pits[0].vertex, at(8, 0, 0));
  EXPECT_EQ(table.pits[0].depth_m, 8) << "it spills where the rim is nearest";
  // A cone of height 8 and radius 8, as far as a lattice gives it.
  EXPECT_NEAR(table.pits[0].volume_m3, std::numbers::pi * 64 * 8 / 3, 12);
  EXPECT_NEAR(table.pits[0].area_m2, std::numbers::pi * 64, 3);
  for (int x = -7; x <= 7; ++x) EXPECT_EQ(in.sinks()[in.sink_of(at(8, x, 3)).index()].kind, Sink::Kind::Pit);
}

TEST(AnalyticFlow, AParaboloidHoldsHalfOfItsCylinder) {
  const Tin tin = lattice(20, [](double x, double y) { return x * x + y * y; });
  const PitTable table = pits_of(flow_on(tin));
  ASSERT_EQ(table.pits.size(), 1U);
  EXPECT_EQ(table.pits[0].depth_m, 400);
  EXPECT_NEAR(table.pits[0].volume_m3, std::numbers::pi * 400 * 400 / 2, 0.005 * 251327);
}

TEST(AnalyticFlow, TwoPlanesMakeAValleyThatTakesAllButTheSides) {
  // The valley runs down along y = 0 towards -x.
  const Tin tin = lattice(6, [](double x, double y) { return 2 * std::abs(y) + 0.25 * x; });
  const SurfaceFlow flow = flow_on(tin);
  for (int x = -6; x < 6; ++x) {
    HalfedgeId h = tin.find_halfedge(at(6, x, 0), at(6, x + 1, 0));
    EXPECT_TRUE(flow.is_valley(h));
  }
  Progress progress;
  double largest = 0;
  for (const Reach& reach : find_network(flow, let_spill(flow, pits_of(flow), 0), 1, progress)) {
    EXPECT_EQ(reach.points.front().xy.y, 0);
    EXPECT_EQ(reach.strahler, 1U);
    largest = std::max(largest, reach.area);
  }
  // Lines of flow move by 1/8 a unit of y: on each side a triangle of 6 * 0.75 / 2 leaves over the end at -x.
  EXPECT_NEAR(largest, 12 * 12 - 2 * (6 * 0.75 / 2), 1e-9);
}

TEST(AnalyticFlow, ASaddlePartsItsFourQuarters) {
  const Tin tin = lattice(5, [](double x, double y) { return x * x - y * y; });
  const SurfaceFlow flow = flow_on(tin);
  EXPECT_TRUE(pits_of(flow).pits.empty());
  double sum = 0;
  for (const Sink& sink : flow.sinks()) sum += sink.area;
  EXPECT_NEAR(sum, 100, 1e-9);
}

TEST(AnalyticFlow, StairsOfPlateausLeadDown) {
  const Tin tin = lattice(6, [](double x, double) { return std::floor((x + 6) / 3); });
  const SurfaceFlow flow = flow_on(tin);
  EXPECT_TRUE(pits_of(flow).pits.empty());
  const FlowPath path = flow.path_from(at(6, 5, 0));
  EXPECT_LE(path.points.back().xy.x, -3) << "the lowest plateau lies on the rim";
  EXPECT_EQ(path.points.back().z, 0);
}

TEST(AnalyticFlow, ACraterLakeSpillsAtTheNotch) {
  // A crater of inner slope 1 about a plateau, its rim at 6, and a gully from 4.5 down through it.
  const auto crater = [](double x, double y) {
    const double r = std::max(std::abs(x), std::abs(y));
    const double z = r <= 2 ? 1 : r <= 7 ? r - 1 : 13 - r;
    return y == 0 && x >= 6 ? 4.5 - (x - 6) / 2 : z;
  };
  const Tin tin = lattice(10, crater);
  const SurfaceFlow flow = flow_on(tin);
  const PitTable table = pits_of(flow);
  ASSERT_EQ(table.pits.size(), 1U);
  const Pit& lake = table.pits[0];
  EXPECT_EQ(lake.vertices, 25U);
  EXPECT_EQ(lake.height, 1);
  EXPECT_EQ(lake.spill_height, 4.5);
  EXPECT_EQ(lake.spill_vertex, at(10, 6, 0));
  EXPECT_EQ(lake.depth_m, 3.5);
  EXPECT_FALSE(lake.spills_into.has_value());
}

TEST(AnalyticFlow, ADivideThatComesToAVertexEndsThere) {
  // The line between the grounds of two channels meets the end of a side that it crosses.
  constexpr std::array<double, 36> kHeights = {
      2, 5, 9,  11, 14, 21, 4, 7, 8,  15, 17, 19, 3, 8,  9,  14, 17, 23,  //
      3, 7, 12, 14, 18, 21, 4, 8, 15, 18, 19, 24, 9, 12, 14, 17, 23, 27};
  const Tin tin =
      test::grid_tin(6, 6, [&](double x, double y) { return kHeights[static_cast<std::size_t>(6 * y + x)]; });
  const SurfaceFlow flow = flow_on(tin);
  EXPECT_NEAR(flow.sinks()[0].area, 145.0 / 9, 1e-12);
  EXPECT_NEAR(flow.sinks()[1].area, 80.0 / 9, 1e-12);
  expect_catchments_tile(flow);
}

TEST(AnalyticFlow, TrianglesThatHandWaterRoundACircleAreParted) {
  // A twisted ring of triangles, each of which drains over a side into the next; in the middle a pit.
  constexpr std::size_t kSides = 8;
  std::vector<Point2> points = {{0, 0}};
  std::vector<double> heights = {-5};
  for (std::size_t i = 0; i < 2 * kSides; ++i) {
    const bool inner = i < kSides;
    const double angle =
        2 * std::numbers::pi * (static_cast<double>(i % kSides) + (inner ? 0 : 0.5)) / kSides;
    const double radius = inner ? 1 : 1.5;
    points.push_back({radius * std::cos(angle), radius * std::sin(angle)});
    heights.push_back(inner ? 0 : 10);
  }
  std::vector<Triangle> triangles;
  for (std::size_t i = 0; i < kSides; ++i) {
    const std::size_t a = 1 + i, next_a = 1 + (i + 1) % kSides, b = a + kSides, next_b = next_a + kSides;
    triangles.push_back(test::triangle(a, b, next_b));
    triangles.push_back(test::triangle(a, next_b, next_a));
    triangles.push_back(test::triangle(0, a, next_a));
  }
  const Tin tin = test::make_tin(std::move(points), std::move(triangles), {}, std::move(heights));
  const SurfaceFlow flow = flow_on(tin);
  EXPECT_EQ(flow.broken_cycles(), 1U);
  ASSERT_EQ(pits_of(flow).pits.size(), 1U);
  double sum = 0;
  for (const Sink& sink : flow.sinks()) sum += sink.area;
  EXPECT_NEAR(sum, measure(tin).area_m2, 1e-9);
  expect_catchments_tile(flow);
  for (std::size_t t = 0; t < tin.triangle_count(); ++t) {
    const Triangle& c = tin.triangle(TriangleId{t});
    const Point2 middle{(tin.point(c[0]).x + tin.point(c[1]).x + tin.point(c[2]).x) / 3,
                        (tin.point(c[0]).y + tin.point(c[1]).y + tin.point(c[2]).y) / 3};
    EXPECT_EQ(flow.path_from(TriangleId{t}, middle).sink, flow.sink_of(VertexId{0}));
  }
  Progress progress;
  const Spilling spilling = let_spill(flow, pits_of(flow), 0);
  for (const Reach& reach : find_network(flow, spilling, 0, progress)) EXPECT_GT(reach.area, 0);
}

}  // namespace
}  // namespace thalweg
