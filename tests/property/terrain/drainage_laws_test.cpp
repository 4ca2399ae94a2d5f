// Catchments, the table of pits and the network against their laws and a plain flood.
#include "support/terrains.hpp"

#include <thalweg/delaunay/triangulate.hpp>
#include <thalweg/mesh/change_tin.hpp>
#include <thalweg/terrain/catchments.hpp>
#include <thalweg/terrain/network.hpp>
#include <thalweg/terrain/pit_table.hpp>
#include <thalweg/terrain/statistics.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <span>
#include <tuple>
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

struct Body {
  double area = 0, volume = 0;
};

/// The part of a triangle below a level, cut corner by corner.
Body below(const Tin& tin, const Triangle& t, double level) {
  struct Cut {
    double x, y, depth;
  };
  std::vector<Cut> ring;
  for (std::size_t i = 0; i < 3; ++i) {
    const Point2 p = tin.point(t[i]), q = tin.point(t[(i + 1) % 3]);
    const double a = level - tin.height(t[i]), b = level - tin.height(t[(i + 1) % 3]);
    if (a > 0) ring.push_back({p.x, p.y, a});
    if ((a > 0) == (b > 0)) continue;
    const double share = a / (a - b);
    ring.push_back({p.x + share * (q.x - p.x), p.y + share * (q.y - p.y), 0});
  }
  Body body;
  for (std::size_t i = 2; i < ring.size(); ++i) {
    const Cut &o = ring[0], &p = ring[i - 1], &q = ring[i];
    const double area = ((p.x - o.x) * (q.y - o.y) - (p.y - o.y) * (q.x - o.x)) / 2;
    body.area += area;
    body.volume += area * (o.depth + p.depth + q.depth) / 3;
  }
  return body;
}

/// What is connected to a vertex below a level.
Body flood(const Tin& tin, VertexId bottom, double level) {
  std::vector<bool> wet(tin.vertex_count(), false);
  wet[bottom.index()] = true;
  for (bool changed = true; changed;) {
    changed = false;
    for (const Triangle& t : tin.triangles()) {
      if (std::none_of(t.begin(), t.end(), [&](VertexId v) { return wet[v.index()]; })) continue;
      for (const VertexId v : t) {
        if (wet[v.index()] || !(tin.height(v) < level)) continue;
        wet[v.index()] = changed = true;
      }
    }
  }
  Body body;
  for (const Triangle& t : tin.triangles()) {
    if (std::none_of(t.begin(), t.end(), [&](VertexId v) { return wet[v.index()]; })) continue;
    const Body part = below(tin, t, level);
    body.area += part.area;
    body.volume += part.volume;
  }
  return body;
}

TEST(PitTableLaws, WaterIsThatOfAFlood) {
  test::Random random;
  SCOPED_TRACE(random.trace());
  for (int i = 0; i < 150; ++i) {
    const Tin tin = test::random_terrain(i, random);
    Progress progress;
    const SurfaceFlow flow(tin, {}, progress);
    for (const Pit& pit : tabulate_pits(flow, {}, progress).pits) {
      const Body water = flood(tin, pit.vertex, pit.spill_height);
      EXPECT_NEAR(pit.area_m2, water.area, 1e-9 * water.area) << "scene " << i;
      EXPECT_NEAR(pit.volume_m3, water.volume, 1e-9 * water.volume) << "scene " << i;
    }
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

void expect_same_ring(const CatchmentRing& a, const CatchmentRing& b, std::span<const VertexId> number) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_NEAR(a[i].xy.x, b[i].xy.x, 1e-9);  // triangles start at other corners
    EXPECT_NEAR(a[i].xy.y, b[i].xy.y, 1e-9);
    EXPECT_EQ(a[i].vertex.valid() ? number[a[i].vertex.index()] : VertexId{}, b[i].vertex);
  }
}

// Whether the vertices' numbers are scattered over the plane, so that the flow takes its own, or run along
// it.
TEST(DrainageLaws, NumbersOfVerticesDoNotMatter) {
  test::Random random;
  SCOPED_TRACE(random.trace());
  constexpr std::size_t kCount = 60'000;
  std::vector<Point2> points;
  std::vector<double> heights;
  for (std::size_t i = 0; i < kCount; ++i) {
    points.push_back({random.real(0, 1000), random.real(0, 1000)});
    heights.push_back(10 * std::sin(points.back().x / 9) * std::cos(points.back().y / 13) +
                      std::floor(random.real(0, 3)));
  }
  std::vector<std::size_t> order(kCount);
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::tuple(std::floor(points[a].x / 20), points[a].y) <
           std::tuple(std::floor(points[b].x / 20), points[b].y);
  });
  std::vector<VertexId> number(kCount);
  for (std::size_t i = 0; i < kCount; ++i) number[order[i]] = VertexId{i};
  Progress progress;
  const Tin scattered = triangulate(points, heights, {}, progress);
  const Tin along = renumber(scattered, number, progress).tin;
  const SurfaceFlow flow(scattered, {}, progress), other(along, {}, progress);
  ASSERT_EQ(flow.sinks().size(), other.sinks().size());
  std::map<VertexId, std::uint32_t> sink_at;
  for (std::size_t s = 0; s < other.sinks().size(); ++s) {
    sink_at[other.sinks()[s].vertex] = static_cast<std::uint32_t>(s);
  }
  std::vector<std::uint32_t> group(flow.sinks().size()), other_group(group.size());
  std::iota(other_group.begin(), other_group.end(), 0U);
  for (std::size_t s = 0; s < group.size(); ++s) {
    const Sink& sink = flow.sinks()[s];
    group[s] = sink_at.at(number[sink.vertex.index()]);
    EXPECT_EQ(sink.kind, other.sinks()[group[s]].kind);
    EXPECT_NEAR(sink.area, other.sinks()[group[s]].area, 1e-9 * sink.area);
  }
  for (std::size_t v = 0; v < kCount; ++v) {
    ASSERT_EQ(group[flow.sink_of(VertexId{v}).index()], other.sink_of(number[v]).value());
  }
  const PitTable table = tabulate_pits(flow, {}, progress), other_table = tabulate_pits(other, {}, progress);
  ASSERT_EQ(table.pits.size(), other_table.pits.size());
  EXPECT_NEAR(table.fill_volume_m3, other_table.fill_volume_m3, 1e-9 * table.fill_volume_m3);
  const auto reaches = find_network(flow, let_spill(flow, table, 0.5), 500, progress);
  EXPECT_EQ(reaches.size(), find_network(other, let_spill(other, other_table, 0.5), 500, progress).size());
  EXPECT_GT(reaches.size(), 100U);
  const auto catchments = outline_catchments(flow, group, progress);
  const auto others = outline_catchments(other, other_group, progress);
  ASSERT_EQ(catchments.size(), others.size());
  for (std::size_t c = 0; c < catchments.size(); ++c) {
    ASSERT_EQ(catchments[c].polygons.size(), others[c].polygons.size());
    if (catchments[c].polygons.size() > 1) continue;  // their order is that of numbers
    CatchmentRing ring = catchments[c].polygons[0].outer;
    const VertexId start = others[c].polygons[0].outer.front().vertex;
    std::rotate(ring.begin(),
                std::find_if(ring.begin(), ring.end(),
                             [&](const FlowPoint& p) {
                               return p.vertex.valid() && number[p.vertex.index()] == start;
                             }),
                ring.end());
    expect_same_ring(ring, others[c].polygons[0].outer, number);
  }
}

}  // namespace
}  // namespace thalweg
