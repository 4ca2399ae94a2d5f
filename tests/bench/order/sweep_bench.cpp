// The order of one triangle whose disc holds much: angular sweeps against walks from pair to pair.
#include "order/sweep_count.hpp"

#include <thalweg/delaunay/triangulate.hpp>
#include <thalweg/mesh/change_tin.hpp>
#include <thalweg/order/constrained_order.hpp>

#include <benchmark/benchmark.h>

#include <cmath>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace thalweg::bench {
namespace {

using detail::Ground;

/// A flat triangle (vertices 0, 1, 2) below a disc of radius 500, and what lies in the disc.
struct FlatTriangle {
  std::vector<Point2> points{{-1, 0}, {0, -0.001}, {1, 0}};
  std::vector<ConstraintEdge> edges;
  std::mt19937_64 engine{20261126};

  double real(double low, double high) {
    return low + (high - low) * (static_cast<double>(engine() >> 11) * 0x1p-53);
  }
  VertexId add(double x, double y) {
    points.push_back({x, y});
    return VertexId{points.size() - 1};
  }
  void connect(VertexId a, VertexId b) { edges.push_back({a, b, EdgeKind::Breakline}); }
  [[nodiscard]] Tin triangulated() const {
    Progress progress;
    return triangulate(points, std::vector<double>(points.size(), 0.0), edges, progress);
  }
};

const Triangle kFlat{VertexId{std::size_t{1}}, VertexId{std::size_t{2}}, VertexId{std::size_t{0}}};

// A ladder between two walls of m / 4 constraint edges, which every sight line has to climb; above it m / 2
// small roofs, and m vertices above these, half of them shaded from the corner below.
Tin ladder(std::size_t m) {
  FlatTriangle scene;
  const double side = 4 / static_cast<double>(m);
  for (const double x : {-5.0, 5.0}) {
    VertexId last;
    for (std::size_t i = 0; i <= m / 4; ++i) {
      const double y =
          20 + 870 * (static_cast<double>(i) + scene.real(0, 0.5)) / (static_cast<double>(m) / 4);
      const VertexId here = scene.add(x + scene.real(0, 0.1), y);
      if (last.valid()) scene.connect(last, here);
      last = here;
    }
  }
  for (std::size_t i = 0; i < m / 2; ++i) {
    const double x = scene.real(-2, 2);
    const double y = 900 + 3 * static_cast<double>(i) / (static_cast<double>(m) / 2);
    const VertexId left = scene.add(x, y);
    scene.connect(left, scene.add(x + side, y));
  }
  for (std::size_t i = 0; i < m; ++i) {
    const double x = scene.real(-2, 2);
    scene.add(x, scene.real(905, 945));
  }
  return scene.triangulated();
}

// Vertices all over the disc, and every twentieth edge a constraint edge.
Tin filled(std::size_t m) {
  FlatTriangle scene;
  while (scene.points.size() < m + 3) {
    const double x = scene.real(-500, 500), y = scene.real(1, 999);
    if (std::hypot(x, y - 500) < 499) scene.add(x, y);
  }
  const Tin plain = scene.triangulated();
  for (std::size_t i = 0; i < plain.halfedge_count(); ++i) {
    const HalfedgeId h{i};
    if (plain.represents_edge(h) && scene.real(0, 1) < 0.05) scene.connect(plain.origin(h), plain.target(h));
  }
  return scene.triangulated();
}

/// A simple polygon by its corners, counter-clockwise, and one of its triangles.
struct Polygon {
  Tin tin;
  Triangle triangle;
};

Polygon polygon(FlatTriangle scene, const Triangle& triangle) {
  const std::size_t corners = scene.points.size();
  for (std::size_t i = 0; i < corners; ++i) {
    scene.edges.push_back({VertexId{i}, VertexId{(i + 1) % corners}, EdgeKind::Boundary});
  }
  const Tin tin = scene.triangulated();
  std::vector<bool> keep;
  for (const Triangle& t : tin.triangles()) keep.push_back(t[0] < t[1] && t[1] < t[2]);
  return {keep_triangles(tin, keep), triangle};
}

// The polygon's first two corners and its last one make the flat triangle.
Polygon polygon_on_flat_triangle(FlatTriangle scene) {
  scene.add(-1, 0);
  const VertexId last{scene.points.size() - 1};
  return polygon(std::move(scene), {VertexId{std::size_t{0}}, VertexId{std::size_t{1}}, last});
}

// A simple polygon of the ladder's shape: the flat triangle, walls of m / 4 teeth, and a ceiling of m teeth.
Polygon hall(std::size_t m) {
  FlatTriangle scene;
  scene.points = {{0, -0.001}, {1, 0}};
  const auto wall = [&](double side) {
    for (std::size_t i = 0; i < m / 4; ++i) {
      const std::size_t up = side > 0 ? i : m / 4 - 1 - i;
      const double y =
          20 + 870 * (static_cast<double>(up) + scene.real(0, 0.5)) / (static_cast<double>(m) / 4);
      scene.add(side * scene.real(4.8, 5), y);
    }
  };
  wall(1);
  for (std::size_t i = 0; i < m; ++i) {
    const double x = 2 - 4 * (static_cast<double>(i) + scene.real(0, 0.5)) / static_cast<double>(m);
    scene.add(x, i % 2 == 0 ? scene.real(904, 906) : scene.real(940, 945));
  }
  wall(-1);
  return polygon_on_flat_triangle(std::move(scene));
}

// From the flat triangle a corridor of eight turns towards the centre of the disc, m corners long.
Polygon spiral(std::size_t m) {
  constexpr double kTurn = 2 * 3.14159265358979323846;
  FlatTriangle scene;
  scene.points = {{0, -0.001}, {1, 0}};
  const auto wall = [&](double radius, bool outward) {
    for (std::size_t i = 1; i < m / 2; ++i) {
      const double part = static_cast<double>(outward ? m / 2 - i : i) / static_cast<double>(m / 2);
      const double turn = kTurn * (8 * part - 0.25);
      const double at = radius - 440 * part + scene.real(-1, 1);
      scene.add(at * std::cos(turn), 500 + at * std::sin(turn));
    }
  };
  wall(498, false);
  wall(470, true);
  return polygon_on_flat_triangle(std::move(scene));
}

// A large triangle. Beyond one side m corners on a wall look out through a slit, across the triangle and
// along a tunnel beyond another side, whose 2 m corners they do not see.
Polygon tunnel(std::size_t m) {
  constexpr double kLevel = -0.4;
  const double root = std::sqrt(0.75);
  const auto part = [m](std::size_t i) { return (static_cast<double>(i) + 0.5) / static_cast<double>(m); };
  FlatTriangle scene;
  scene.points.clear();
  scene.add(0, -1);
  scene.add(0.36, kLevel - 0.0005);
  for (std::size_t i = 0; i < m; ++i) {
    scene.add(0.6 + scene.real(0, 0.005) / static_cast<double>(m), kLevel + 0.02 * part(i) - 0.01);
  }
  scene.add(0.36, kLevel + 0.0005);
  const VertexId right = scene.add(root, 0.5), left = scene.add(-root, 0.5);
  const auto bulge = [&](std::size_t i) { return 0.1 + 0.02 * part(i) * (1 - part(i)); };
  for (std::size_t i = 0; i < m; ++i) scene.add(-0.45 - 0.55 * part(i), kLevel + bulge(i));
  for (std::size_t i = m; i-- > 0;) scene.add(-0.45 - 0.55 * part(i), kLevel - bulge(i));
  return polygon(std::move(scene), {VertexId{std::size_t{0}}, right, left});
}

// Round a triangle of three corners on the circle of radius 2.2 teeth, all but those near the corners inside
// the circle, and pockets between them that look across to the teeth beyond the other sides.
Polygon arena(std::size_t m) {
  constexpr double kTurn = 2 * 3.14159265358979323846;
  FlatTriangle scene;
  scene.points.clear();
  for (std::size_t i = 0; i < 3 * m; ++i) {
    const double part = static_cast<double>(i % m) / static_cast<double>(m);
    const bool inside = part > 0.05 && part < 0.95;
    double radius = i % 2 == 0 ? scene.real(2.05, 2.1) : scene.real(2.1, 2.19);
    if (!inside) radius = i % m == 0 ? 2.2 : 2.3;
    const double turn = kTurn / 3 * (static_cast<double>(i / m) + part);
    scene.add(radius * std::cos(turn), radius * std::sin(turn));
  }
  return polygon(std::move(scene), {VertexId{std::size_t{0}}, VertexId{m}, VertexId{2 * m}});
}

void count_sizes(benchmark::State& state, std::size_t counted) {
  state.counters["counted"] = static_cast<double>(counted);
  state.SetComplexityN(state.range(0));
}

void order_of_one(benchmark::State& state, OrderDefinition definition) {
  const Tin tin = ladder(static_cast<std::size_t>(state.range(0)));
  const ConstrainedOrder order(tin);
  OrderWorkspace workspace;
  std::size_t counted = 0;
  for (auto _ : state) counted = order.order(kFlat, definition, workspace);
  count_sizes(state, counted);
}

void order_in_polygon(benchmark::State& state, Polygon (*make)(std::size_t)) {
  const auto [tin, triangle] = make(static_cast<std::size_t>(state.range(0)));
  const OrderDefinition definition = kOrderDefinitions.at(static_cast<std::size_t>(state.range(1)));
  const ConstrainedOrder order(tin, GroundMode::Polygon);
  OrderWorkspace workspace;
  if (!order.is_valid(triangle, workspace)) return state.SkipWithError("no valid triangle");
  std::size_t counted = 0;
  for (auto _ : state) counted = order.order(triangle, definition, workspace);
  state.SetLabel(std::string(definition_name(definition)));
  state.counters["corners"] = static_cast<double>(tin.vertex_count());
  count_sizes(state, counted);
}

// By a walk from each vertex to the opposite corner.
std::size_t count_by_pairs(const Ground& ground, detail::Flood& flood) {
  std::size_t counted = 0;
  for (const VertexId p : flood.inside()) {
    const double y = ground.point(p).y;
    counted += ground.sees(p, y > 0 ? kFlat[0] : kFlat[2]) ? 1 : 0;
  }
  return counted;
}

TriangleId flood_disc(const Ground& ground, detail::Flood& flood) {
  const TriangleId start = Tin::triangle_of(ground.face_in_angle(kFlat[0], kFlat[1], kFlat[2]).value());
  flood.start(ground, kFlat, start, detail::Barrier::BlockingEdges);
  flood.spread();
  return start;
}

void pairs(benchmark::State& state, Tin (*make)(std::size_t)) {
  const Tin tin = make(static_cast<std::size_t>(state.range(0)));
  const Ground ground(tin, GroundMode::Hull);
  detail::Flood flood;
  flood_disc(ground, flood);
  std::size_t counted = 0;
  for (auto _ : state) counted = count_by_pairs(ground, flood);
  count_sizes(state, counted);
}

void sweeps(benchmark::State& state, Tin (*make)(std::size_t)) {
  const Tin tin = make(static_cast<std::size_t>(state.range(0)));
  const Ground ground(tin, GroundMode::Hull);
  detail::Flood flood;
  detail::SweepCount count;
  const TriangleId start = flood_disc(ground, flood);
  std::size_t counted = 0;
  for (auto _ : state) {
    counted = count.count(ground, kFlat, start, OrderDefinition::SeesOpp, flood).size();
  }
  count_sizes(state, counted);
}

BENCHMARK_CAPTURE(order_of_one, pathcon, OrderDefinition::Pathcon)
    ->RangeMultiplier(10)
    ->Range(100, 100000)
    ->Unit(benchmark::kMillisecond)
    ->Complexity(benchmark::oNLogN);
BENCHMARK_CAPTURE(order_of_one, sees_opp, OrderDefinition::SeesOpp)
    ->RangeMultiplier(10)
    ->Range(100, 100000)
    ->Unit(benchmark::kMillisecond)
    ->Complexity(benchmark::oNLogN);
BENCHMARK_CAPTURE(order_of_one, sees_3vtx, OrderDefinition::Sees3vtx)
    ->RangeMultiplier(10)
    ->Range(100, 100000)
    ->Unit(benchmark::kMillisecond)
    ->Complexity(benchmark::oNLogN);
BENCHMARK_CAPTURE(order_of_one, empty_quad, OrderDefinition::EmptyQuad)
    ->RangeMultiplier(10)
    ->Range(100, 100000)
    ->Unit(benchmark::kMillisecond)
    ->Complexity(benchmark::oNLogN);
BENCHMARK_CAPTURE(order_of_one, sees_triang, OrderDefinition::SeesTriang)
    ->RangeMultiplier(10)
    ->Range(100, 100000)
    ->Unit(benchmark::kMillisecond)
    ->Complexity();
BENCHMARK_CAPTURE(order_of_one, sees_vtx, OrderDefinition::SeesVtx)
    ->RangeMultiplier(10)
    ->Range(100, 100000)
    ->Unit(benchmark::kMillisecond)
    ->Complexity();
BENCHMARK_CAPTURE(order_of_one, conf_edge, OrderDefinition::ConfEdge)
    ->RangeMultiplier(10)
    ->Range(100, 100000)
    ->Unit(benchmark::kMillisecond)
    ->Complexity();
void sizes_and_definitions(benchmark::internal::Benchmark* bench) {
  bench->ArgsProduct({{1000, 10000, 100000}, benchmark::CreateDenseRange(1, 7, 1)})
      ->Unit(benchmark::kMillisecond);
}
BENCHMARK_CAPTURE(order_in_polygon, hall, hall)->Apply(sizes_and_definitions);
BENCHMARK_CAPTURE(order_in_polygon, spiral, spiral)->Apply(sizes_and_definitions);
BENCHMARK_CAPTURE(order_in_polygon, tunnel, tunnel)->Apply(sizes_and_definitions);
BENCHMARK_CAPTURE(order_in_polygon, arena, arena)->Apply(sizes_and_definitions);
BENCHMARK_CAPTURE(pairs, ladder, ladder)
    ->RangeMultiplier(10)
    ->Range(100, 10000)
    ->Unit(benchmark::kMillisecond)
    ->Complexity();
BENCHMARK_CAPTURE(sweeps, ladder, ladder)
    ->RangeMultiplier(10)
    ->Range(100, 100000)
    ->Unit(benchmark::kMillisecond)
    ->Complexity(benchmark::oNLogN);
// The experiment for kMostPairs in constrained_order.cpp.
BENCHMARK_CAPTURE(pairs, filled, filled)->RangeMultiplier(4)->Range(16, 65536);
BENCHMARK_CAPTURE(sweeps, filled, filled)->RangeMultiplier(4)->Range(16, 65536);

}  // namespace
}  // namespace thalweg::bench
