// Catchments, the table of pits and the network against their laws and a plain flood.
#include "support/terrains.hpp"

#include <thalweg/delaunay/triangulate.hpp>
#include <thalweg/terrain/catchments.hpp>
#include <thalweg/terrain/network.hpp>
#include <thalweg/terrain/pit_table.hpp>
#include <thalweg/terrain/statistics.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

namespace thalweg {
namespace {

double doubled_area(const CatchmentRing& ring) {
  double sum = 0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Point2 p = ring[i].xy, q = ring[(i + 1) % ring.size()].xy;
    sum += p.x * q.y - p.y * q.x;
  }
  return sum;
}

bool holds(const CatchmentRing& ring, Point2 p) {
  bool inside = false;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Point2 a = ring[i].xy, b = ring[(i + 1) % ring.size()].xy;
    if ((a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x)) inside = !inside;
  }
  return inside;
}

bool holds(const CatchmentPolygon& polygon, Point2 p) {
  return holds(polygon.outer, p) && std::none_of(polygon.holes.begin(), polygon.holes.end(),
                                                 [&](const CatchmentRing& hole) { return holds(hole, p); });
}

TEST(CatchmentLaws, PolygonsTileTheTinAndHoldWhatDrainsThere) {
  test::Random random;
  SCOPED_TRACE(random.trace());
  int astray = 0;
  for (int i = 0; i < 150; ++i) {
    const Tin tin = test::random_terrain(i, random);
    Progress progress;
    const SurfaceFlow flow(tin, {}, progress);
    std::vector<std::uint32_t> group(flow.sinks().size());
    std::iota(group.begin(), group.end(), 0U);
    const std::vector<Catchment> catchments = outline_catchments(flow, group, progress);
    const double total = measure(tin).area_m2;
    double sum = 0;
    std::vector<double> area(group.size(), 0);
    for (const Catchment& catchment : catchments) {
      for (const CatchmentPolygon& polygon : catchment.polygons) {
        EXPECT_GT(doubled_area(polygon.outer), 0);
        area[catchment.group] += doubled_area(polygon.outer) / 2;
        for (const CatchmentRing& hole : polygon.holes) {
          EXPECT_LE(doubled_area(hole), 0);
          area[catchment.group] += doubled_area(hole) / 2;
        }
      }
      sum += area[catchment.group];
    }
    ASSERT_NEAR(sum, total, 1e-9 * total) << "scene " << i;
    for (std::size_t s = 0; s < group.size(); ++s) {
      ASSERT_NEAR(area[s], flow.sinks()[s].area, 1e-9 * total) << "scene " << i << " sink " << s;
    }
    for (int k = 0; k < 30; ++k) {
      const TriangleId t{random.integer<std::size_t>(0, tin.triangle_count() - 1)};
      double u = random.real(0, 1), v = random.real(0, 1);
      if (u + v > 1) u = 1 - u, v = 1 - v;
      const Triangle& c = tin.triangle(t);
      const Point2 a = tin.point(c[0]), b = tin.point(c[1]), d = tin.point(c[2]);
      const Point2 p{a.x + u * (b.x - a.x) + v * (d.x - a.x), a.y + u * (b.y - a.y) + v * (d.y - a.y)};
      const std::uint32_t sink = flow.path_from(t, p).sink.value();
      for (const Catchment& catchment : catchments) {
        const bool inside = std::any_of(catchment.polygons.begin(), catchment.polygons.end(),
                                        [&](const CatchmentPolygon& polygon) { return holds(polygon, p); });
        astray += inside == (catchment.group == sink) ? 0 : 1;
      }
    }
  }
  EXPECT_EQ(astray, 0);
}

// Bellman-Ford from the rim: the least greatest height on a way out.
std::vector<double> fill_heights(const Tin& tin, const std::vector<VertexId>& outlets) {
  std::vector<double> fill(tin.vertex_count(), std::numeric_limits<double>::infinity());
  const std::vector<bool> rim = tin.rim_vertices();
  for (std::size_t v = 0; v < fill.size(); ++v) {
    if (rim[v]) fill[v] = tin.heights()[v];
  }
  for (const VertexId v : outlets) fill[v.index()] = tin.height(v);
  for (bool changed = true; changed;) {
    changed = false;
    for (const Triangle& t : tin.triangles()) {
      for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) {
          const double through = std::max(fill[t[j].index()], tin.height(t[i]));
          if (through < fill[t[i].index()]) fill[t[i].index()] = through, changed = true;
        }
      }
    }
  }
  return fill;
}

TEST(PitTableLaws, FillHeightsAreThoseOfAFlood) {
  test::Random random;
  SCOPED_TRACE(random.trace());
  for (int i = 0; i < 150; ++i) {
    const Tin tin = test::random_terrain(i, random);
    std::vector<VertexId> outlets;
    if (i % 4 == 0) outlets.emplace_back(random.integer<std::size_t>(0, tin.vertex_count() - 1));
    Progress progress;
    const SurfaceFlow flow(tin, outlets, progress);
    const PitTable table = tabulate_pits(flow, {}, progress);
    const std::vector<double> fill = fill_heights(tin, outlets);
    if (outlets.empty()) {
      EXPECT_EQ(table.pits.size(), find_pits(tin).interior);
    }
    double deepest = 0;
    for (const Pit& pit : table.pits) {
      EXPECT_GT(pit.depth_m, 0);
      EXPECT_GT(pit.volume_m3, 0);
      EXPECT_LE(pit.volume_m3, pit.area_m2 * pit.depth_m * (1 + 1e-9));
      EXPECT_EQ(pit.fill_height, fill[pit.vertex.index()]) << "scene " << i;
      EXPECT_LE(pit.spill_height, pit.fill_height);
      EXPECT_EQ(tin.height(pit.spill_vertex), pit.spill_height);
      EXPECT_EQ(std::accumulate(table.interior_by_depth.begin(), table.interior_by_depth.end(), 0U),
                table.pits.size());
      deepest = std::max(deepest, pit.volume_m3);
      if (!pit.spills_into) continue;
      EXPECT_NE(table.pits[*pit.spills_into].vertex, pit.vertex);
      EXPECT_LE(table.pits[*pit.spills_into].fill_height, pit.fill_height);
    }
    EXPECT_GE(table.fill_volume_m3, deepest * (1 - 1e-12));
  }
}

TEST(NetworkLaws, AreasAddUpDownstream) {
  test::Random random;
  SCOPED_TRACE(random.trace());
  for (int i = 0; i < 100; ++i) {
    const Tin tin = test::random_terrain(i, random);
    Progress progress;
    const SurfaceFlow flow(tin, {}, progress);
    const double least = i % 2 == 0 ? 0 : measure(tin).area_m2 / 50;
    const PitTable table = tabulate_pits(flow, {}, progress);
    const double depth = i % 3 == 0 ? 0 : i % 3 == 1 ? 1 : 1e9;
    const Spilling spilling = let_spill(flow, table, depth);
    std::vector<double> area(flow.sinks().size(), 0);
    for (std::size_t s = 0; s < area.size(); ++s) area[spilling.end[s].index()] += flow.sinks()[s].area;
    for (const Pit& pit : table.pits) {
      EXPECT_EQ(spilling.overflow[pit.sink.index()].valid(), pit.depth_m <= depth);
      if (pit.depth_m > depth) {
        EXPECT_EQ(spilling.end[pit.sink.index()], pit.sink);
      }
    }
    for (const Reach& reach : find_network(flow, spilling, least, progress)) {
      EXPECT_GE(reach.area, least);
      EXPECT_LE(reach.area, area[reach.sink.index()] * (1 + 1e-9));
      EXPECT_GE(reach.points.size(), 2U);
      EXPECT_GE(reach.points.front().z, reach.points.back().z);
      EXPECT_GE(reach.strahler, 1U);
    }
  }
}

}  // namespace
}  // namespace thalweg
