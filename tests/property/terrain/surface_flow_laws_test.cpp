// SurfaceFlow against its laws, and against a walk from the definition that shares nothing with it.
#include "support/meshes.hpp"

#include <thalweg/delaunay/triangulate.hpp>
#include <thalweg/terrain/statistics.hpp>
#include <thalweg/terrain/surface_flow.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <set>
#include <vector>

namespace thalweg {
namespace {

enum class Terrain { Noise, Hills, Steps };

Tin random_tin(std::size_t count, Terrain kind, test::Random& random) {
  std::vector<Point2> points;
  std::vector<double> heights;
  for (std::size_t i = 0; i < count; ++i) {
    const Point2 p{random.real(0, 100), random.real(0, 100)};
    points.push_back(p);
    const double hills = 10 * std::sin(p.x / 9) * std::cos(p.y / 13) + p.x / 20;
    heights.push_back(kind == Terrain::Noise   ? random.real(0, 10)
                      : kind == Terrain::Hills ? hills + random.real(0, 0.5)
                                               : std::floor(hills / 3));
  }
  Progress progress;
  return triangulate(std::move(points), std::move(heights), {}, progress);
}

Tin scene(int i, test::Random& random) {
  if (i % 4 == 3) {
    return test::random_lattice(random.integer<std::size_t>(2, 14), random.integer<std::size_t>(2, 14),
                                random.integer(1, 9), random);
  }
  return random_tin(random.integer<std::size_t>(3, 300), static_cast<Terrain>(i % 4), random);
}

std::vector<VertexId> random_outlets(const Tin& tin, int i, test::Random& random) {
  std::vector<VertexId> outlets;
  for (int k = 0; k < i % 3; ++k)
    outlets.emplace_back(random.integer<std::size_t>(0, tin.vertex_count() - 1));
  return outlets;
}

Point2 random_point(const Tin& tin, TriangleId t, test::Random& random) {
  double u = random.real(0, 1), v = random.real(0, 1);
  if (u + v > 1) u = 1 - u, v = 1 - v;
  const Triangle& c = tin.triangle(t);
  const Point2 a = tin.point(c[0]), b = tin.point(c[1]), d = tin.point(c[2]);
  return {a.x + u * (b.x - a.x) + v * (d.x - a.x), a.y + u * (b.y - a.y) + v * (d.y - a.y)};
}

TEST(SurfaceFlowLaws, CatchmentsTileAndEveryVertexHasOneSink) {
  test::Random random;
  SCOPED_TRACE(random.trace());
  for (int i = 0; i < 200; ++i) {
    const Tin tin = scene(i, random);
    const std::vector<VertexId> outlets = random_outlets(tin, i, random);
    Progress progress;
    const SurfaceFlow flow(tin, outlets, progress);
    double sum = 0;
    std::set<VertexId> places;
    for (const Sink& sink : flow.sinks()) {
      sum += sink.area;
      EXPECT_TRUE(places.insert(sink.vertex).second || sink.kind == Sink::Kind::Given ||
                  sink.kind == Sink::Kind::Outlet);
    }
    const double area = measure(tin).area_m2;
    ASSERT_NEAR(sum, area, 1e-9 * area) << "scene " << i;
    EXPECT_EQ(flow.broken_cycles(), 0U);
    for (std::size_t v = 0; v < tin.vertex_count(); ++v) {
      if (tin.outgoing(VertexId{v}).empty()) continue;
      const SinkId sink = flow.sink_of(VertexId{v});
      ASSERT_TRUE(sink.valid()) << "scene " << i;
      ASSERT_EQ(flow.path_from(VertexId{v}).sink, sink) << "scene " << i << " vertex " << v;
    }
  }
}

TEST(SurfaceFlowLaws, StationsStopWaterAndLeadItNowhereElse) {
  test::Random random;
  SCOPED_TRACE(random.trace());
  std::size_t stopped = 0;
  for (int i = 0; i < 120; ++i) {
    const Tin tin = scene(i, random);
    const std::vector<VertexId> outlets = random_outlets(tin, i, random);
    std::vector<VertexId> stations;
    for (int k = 0; k < 6; ++k) stations.emplace_back(random.integer<std::size_t>(0, tin.vertex_count() - 1));
    Progress progress;
    const SurfaceFlow flow(tin, outlets, progress), stops(tin, outlets, stations, progress);
    const std::set<VertexId> stations_on(stations.begin(), stations.end());
    double area = 0;
    for (const Sink& sink : stops.sinks()) area += sink.area;
    double whole = 0;
    for (const Sink& sink : flow.sinks()) whole += sink.area;
    EXPECT_NEAR(area, whole, 1e-9 * whole);
    for (std::size_t v = 0; v < tin.vertex_count(); ++v) {
      if (!flow.sink_of(VertexId{v}).valid()) continue;
      const FlowPath path = flow.path_from(VertexId{v});
      const auto first = std::find_if(path.points.begin(), path.points.end(),
                                      [&](const FlowPoint& p) { return stations_on.contains(p.vertex); });
      const Sink &end = flow.sinks()[path.sink.index()],
                 &stop = stops.sinks()[stops.sink_of(VertexId{v}).index()];
      const bool in_pit = stop.kind == Sink::Kind::Pit || stop.kind == Sink::Kind::Lake;
      if (first == path.points.end() || in_pit) {
        EXPECT_EQ(stop.vertex, end.vertex) << i;
        EXPECT_EQ(stop.kind, end.kind) << i;
        continue;
      }
      stopped += stop.kind == Sink::Kind::Given ? 1 : 0;
      // On a plateau at the rim water leaves before it comes to a station there.
      EXPECT_TRUE(stop.vertex == first->vertex || stop.vertex == end.vertex) << i;
    }
  }
  EXPECT_GT(stopped, 500U);
}

TEST(SurfaceFlowLaws, PitsAreTheSinksInside) {
  test::Random random;
  SCOPED_TRACE(random.trace());
  for (int i = 0; i < 200; ++i) {
    const Tin tin = scene(i, random);
    Progress progress;
    const SurfaceFlow flow(tin, {}, progress);
    const PitSummary pits = find_pits(tin);
    std::size_t inside = 0;
    for (const Sink& sink : flow.sinks()) {
      inside += sink.kind == Sink::Kind::Pit ? 1 : 0;
      if (sink.kind == Sink::Kind::Pit) {
        EXPECT_EQ(pits.is_pit[sink.vertex.index()], 1);
      }
    }
    EXPECT_EQ(inside, pits.interior);
  }
}

TEST(SurfaceFlowLaws, PathsFallAndEnd) {
  test::Random random;
  SCOPED_TRACE(random.trace());
  for (int i = 0; i < 100; ++i) {
    const Tin tin = scene(i, random);
    Progress progress;
    const SurfaceFlow flow(tin, random_outlets(tin, i, random), progress);
    for (int k = 0; k < 50; ++k) {
      const TriangleId t{random.integer<std::size_t>(0, tin.triangle_count() - 1)};
      const FlowPath path = flow.path_from(t, random_point(tin, t, random));
      ASSERT_TRUE(path.sink.valid());
      std::set<VertexId> met;
      for (std::size_t j = 0; j < path.points.size(); ++j) {
        if (j > 0) {
          EXPECT_LE(path.points[j].z, path.points[j - 1].z + 1e-12);
        }
        if (path.points[j].vertex.valid()) {
          EXPECT_TRUE(met.insert(path.points[j].vertex).second) << "a loop";
        }
      }
      const FlowPoint& end = path.points.back();
      const Sink& sink = flow.sinks()[path.sink.index()];
      if (sink.kind == Sink::Kind::Outlet) {
        const bool on_rim = end.edge.valid() ? tin.on_rim(end.edge)
                                             : end.vertex.valid() && flow.sink_of(end.vertex) == path.sink;
        EXPECT_TRUE(on_rim);
      } else {
        EXPECT_TRUE(end.vertex.valid());
        EXPECT_EQ(tin.height(end.vertex), tin.height(sink.vertex));
      }
    }
  }
}

/// Walks down in small geometry, by gradients in long double, with no table: for surfaces without plateaus.
class PlainWalk {
 public:
  PlainWalk(const Tin& tin) : tin_(tin), rim_(tin.rim_vertices()) {}

  // The pit in which water ends, or none: it left, or came too near to a vertex or an edge's direction to
  // tell.
  std::optional<VertexId> run(TriangleId t, long double x, long double y) const {
    for (int step = 0; step < 100000; ++step) {
      const auto [gx, gy] = gradient(t);
      long double nearest = 1e300L;
      int exit = -1;
      for (int side = 0; side < 3; ++side) {
        const Point2 a = tin_.point(tin_.triangle(t)[side]), b = tin_.point(tin_.triangle(t)[(side + 1) % 3]);
        const long double nx = b.y - a.y, ny = a.x - b.x;  // outward
        const long double speed = -(gx * nx + gy * ny);
        if (speed <= 0) continue;
        const long double time = std::max<long double>(0, ((a.x - x) * nx + (a.y - y) * ny) / speed);
        if (time < nearest) nearest = time, exit = side;
      }
      x -= nearest * gx;
      y -= nearest * gy;
      const HalfedgeId h = Tin::halfedge(t, static_cast<std::size_t>(exit));
      const HalfedgeId twin = tin_.twin(h);
      if (!twin.valid()) return std::nullopt;
      const auto [hx, hy] = gradient(Tin::triangle_of(twin));
      const Point2 a = tin_.point(tin_.origin(h)), b = tin_.point(tin_.target(h));
      if (-(hx * (b.y - a.y) + hy * (a.x - b.x)) > 0) {
        t = Tin::triangle_of(twin);
        continue;
      }
      VertexId v =
          tin_.height(tin_.origin(h)) < tin_.height(tin_.target(h)) ? tin_.origin(h) : tin_.target(h);
      while (true) {  // from vertex to vertex along edges, until a triangle is the steepest way
        HalfedgeId across;
        VertexId next;
        long double best = 0;
        for (const HalfedgeId out : tin_.outgoing(v)) {
          for (const VertexId w : {tin_.target(out), tin_.apex(out)}) {
            const long double dx = tin_.point(w).x - tin_.point(v).x, dy = tin_.point(w).y - tin_.point(v).y;
            const long double slope = (tin_.height(v) - tin_.height(w)) / std::sqrt(dx * dx + dy * dy);
            if (slope > best) best = slope, next = w, across = {};
          }
          const auto [fx, fy] = gradient(Tin::triangle_of(out));
          const long double slope = std::sqrt(fx * fx + fy * fy);
          const auto left_of = [&](VertexId w) {
            return (tin_.point(w).x - tin_.point(v).x) * -fy - (tin_.point(w).y - tin_.point(v).y) * -fx;
          };
          if (left_of(tin_.target(out)) > 0 && left_of(tin_.apex(out)) < 0 && slope > best) {
            best = slope, next = {}, across = out;
          }
        }
        if (rim_[v.index()] && (best == 0 || (next.valid() && rim_[next.index()]))) return std::nullopt;
        if (best == 0) return v;
        if (across.valid()) {
          t = Tin::triangle_of(across);
          x = tin_.point(v).x, y = tin_.point(v).y;
          break;
        }
        v = next;
      }
    }
    return std::nullopt;
  }

 private:
  std::pair<long double, long double> gradient(TriangleId t) const {
    const Triangle& c = tin_.triangle(t);
    const Point2 o = tin_.point(c[0]);
    const long double x1 = tin_.point(c[1]).x - o.x, y1 = tin_.point(c[1]).y - o.y;
    const long double x2 = tin_.point(c[2]).x - o.x, y2 = tin_.point(c[2]).y - o.y;
    const long double z1 = tin_.height(c[1]) - tin_.height(c[0]), z2 = tin_.height(c[2]) - tin_.height(c[0]);
    const long double area = x1 * y2 - x2 * y1;
    return {(z1 * y2 - z2 * y1) / area, (x1 * z2 - x2 * z1) / area};
  }

  const Tin& tin_;
  std::vector<bool> rim_;
};

TEST(SurfaceFlowLaws, PointsDrainWhereAPlainWalkLeads) {
  test::Random random;
  SCOPED_TRACE(random.trace());
  int told = 0, differ = 0;
  for (int i = 0; i < 40; ++i) {
    const Tin tin = random_tin(200, i % 2 == 0 ? Terrain::Noise : Terrain::Hills, random);
    Progress progress;
    const SurfaceFlow flow(tin, {}, progress);
    const PlainWalk walk(tin);
    for (int k = 0; k < 100; ++k) {
      const TriangleId t{random.integer<std::size_t>(0, tin.triangle_count() - 1)};
      const Point2 p = random_point(tin, t, random);
      const auto pit = walk.run(t, p.x, p.y);
      if (!pit) continue;
      ++told;
      differ += flow.sinks()[flow.path_from(t, p).sink.index()].vertex == *pit ? 0 : 1;
    }
  }
  EXPECT_GT(told, 1000);
  EXPECT_EQ(differ, 0);
}

// Areas by counting points: each point's path and the areas of the sinks say the same.
TEST(SurfaceFlowLaws, AreasAreThoseOfThePointsThatDrainThere) {
  test::Random random;
  SCOPED_TRACE(random.trace());
  const Tin tin = random_tin(60, Terrain::Hills, random);
  Progress progress;
  const SurfaceFlow flow(tin, {}, progress);
  std::vector<double> counted(flow.sinks().size(), 0);
  constexpr int kPoints = 400;
  for (std::size_t t = 0; t < tin.triangle_count(); ++t) {
    const Triangle& c = tin.triangle(TriangleId{t});
    const Point2 a = tin.point(c[0]), b = tin.point(c[1]), d = tin.point(c[2]);
    const double area = ((b.x - a.x) * (d.y - a.y) - (b.y - a.y) * (d.x - a.x)) / 2;
    for (int k = 0; k < kPoints; ++k) {
      counted[flow.path_from(TriangleId{t}, random_point(tin, TriangleId{t}, random)).sink.index()] +=
          area / kPoints;
    }
  }
  const double total = measure(tin).area_m2;
  for (std::size_t s = 0; s < counted.size(); ++s) {
    EXPECT_NEAR(flow.sinks()[s].area, counted[s], 0.003 * total);
  }
}

}  // namespace
}  // namespace thalweg
