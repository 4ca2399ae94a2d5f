// What orders cost: seconds a pass over a ground, by kind of ground and size.
#include "scenes.hpp"

#include <thalweg/delaunay/triangulate.hpp>
#include <thalweg/order/order_tin.hpp>
#include <thalweg/order/order_triangles.hpp>
#include <thalweg/order/quadrilaterals.hpp>
#include <thalweg/order/useful_edges.hpp>

#include <benchmark/benchmark.h>

namespace thalweg::bench {
namespace {

void quadrilaterals(benchmark::State& state, Scene scene, OrderDefinition definition) {
  const Tin& tin = ground(scene, static_cast<std::size_t>(state.range(0)));
  std::size_t found = 0;
  for (auto _ : state) {
    found = find_quadrilaterals(tin, {.definition = definition}, Progress()).size();
  }
  state.counters["found"] = static_cast<double>(found);
  state.counters["vertices"] = static_cast<double>(tin.vertex_count());
}

BENCHMARK_CAPTURE(quadrilaterals, random, Scene::Random, OrderDefinition::SeesOpp)
    ->RangeMultiplier(10)
    ->Range(10000, 1000000)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(quadrilaterals, random5, Scene::Random5, OrderDefinition::SeesOpp)
    ->RangeMultiplier(10)
    ->Range(10000, 1000000)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(quadrilaterals, random5_std, Scene::Random5, OrderDefinition::Std)
    ->RangeMultiplier(10)
    ->Range(10000, 1000000)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(quadrilaterals, lattice, Scene::Lattice, OrderDefinition::SeesOpp)
    ->RangeMultiplier(10)
    ->Range(10000, 1000000)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(quadrilaterals, polylines, Scene::Polylines, OrderDefinition::SeesOpp)
    ->RangeMultiplier(10)
    ->Range(10000, 1000000)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(quadrilaterals, comb, Scene::Comb, OrderDefinition::SeesOpp)
    ->RangeMultiplier(10)
    ->Range(10000, 100000)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

void order_triangles(benchmark::State& state, Scene scene, OrderDefinition definition) {
  const ConstrainedOrder order(ground(scene, static_cast<std::size_t>(state.range(0))));
  Progress progress;
  std::size_t found = 0;
  for (auto _ : state) {
    found = find_order_triangles(
                order, {.definition = definition, .max_order = static_cast<std::size_t>(state.range(1))},
                progress)
                .size();
  }
  state.counters["found"] = static_cast<double>(found);
  state.counters["seconds_per_million"] =
      benchmark::Counter(static_cast<double>(found) / 1e6,
                         benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void sizes_and_orders(benchmark::internal::Benchmark* bench) {
  for (const std::int64_t k : {1, 2, 3}) {
    for (const std::int64_t n : {10000, 100000, 1000000}) bench->Args({n, k});
  }
  bench->Unit(benchmark::kMillisecond)->UseRealTime()->Iterations(1);
}

BENCHMARK_CAPTURE(order_triangles, random, Scene::Random, OrderDefinition::Pathcon)->Apply(sizes_and_orders);
BENCHMARK_CAPTURE(order_triangles, random5_pathcon, Scene::Random5, OrderDefinition::Pathcon)
    ->Apply(sizes_and_orders);
BENCHMARK_CAPTURE(order_triangles, random5_sees_triang, Scene::Random5, OrderDefinition::SeesTriang)
    ->Apply(sizes_and_orders);
BENCHMARK_CAPTURE(order_triangles, random5_sees_vtx, Scene::Random5, OrderDefinition::SeesVtx)
    ->Apply(sizes_and_orders);
BENCHMARK_CAPTURE(order_triangles, random5_conf_edge, Scene::Random5, OrderDefinition::ConfEdge)
    ->Apply(sizes_and_orders);
BENCHMARK_CAPTURE(order_triangles, random5_sees_opp, Scene::Random5, OrderDefinition::SeesOpp)
    ->Apply(sizes_and_orders);
BENCHMARK_CAPTURE(order_triangles, comb_sees_opp, Scene::Comb, OrderDefinition::SeesOpp)
    ->Args({10000, 1})
    ->Args({10000, 3})
    ->Args({100000, 1})
    ->Args({100000, 3})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime()
    ->Iterations(1);

// Includes the search for all triangles of the order.
void useful_edges(benchmark::State& state, Scene scene, OrderDefinition definition) {
  const ConstrainedOrder order(ground(scene, static_cast<std::size_t>(state.range(0))));
  Progress progress;
  std::size_t found = 0;
  for (auto _ : state) {
    found = find_useful_edges(
                order, {.definition = definition, .max_order = static_cast<std::size_t>(state.range(1))},
                progress)
                .size();
  }
  state.counters["found"] = static_cast<double>(found);
  state.counters["seconds_per_million"] =
      benchmark::Counter(static_cast<double>(found) / 1e6,
                         benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

BENCHMARK_CAPTURE(useful_edges, random5_pathcon, Scene::Random5, OrderDefinition::Pathcon)
    ->Apply(sizes_and_orders);
BENCHMARK_CAPTURE(useful_edges, random5_sees_triang, Scene::Random5, OrderDefinition::SeesTriang)
    ->Apply(sizes_and_orders);
BENCHMARK_CAPTURE(useful_edges, random5_sees_opp, Scene::Random5, OrderDefinition::SeesOpp)
    ->Apply(sizes_and_orders);

// The orders of all triangles of a first-order triangulation: every fourth quadrilateral flipped.
void tin_orders(benchmark::State& state, Scene scene) {
  const Tin& delaunay = ground(scene, static_cast<std::size_t>(state.range(0)));
  std::vector<HalfedgeId> flips;
  std::size_t i = 0;
  for (const Quadrilateral& q : find_quadrilaterals(delaunay, {}, Progress())) {
    if (++i % 4 == 0) flips.push_back(q.diagonal);
  }
  const Tin tin = flip_edges(delaunay, flips);
  Progress progress;
  std::uint32_t largest = 0;
  for (auto _ : state) largest = find_tin_orders(tin, {}, progress).max_order;
  state.counters["max_order"] = static_cast<double>(largest);
}

// What the orders are compared with.
void triangulation(benchmark::State& state, Scene scene) {
  const Tin& tin = ground(scene, static_cast<std::size_t>(state.range(0)));
  const std::vector<ConstraintEdge> edges = tin.constraint_edges();
  Progress progress;
  for (auto _ : state) {
    const std::vector<Point2> points(tin.points().begin(), tin.points().end());
    benchmark::DoNotOptimize(
        triangulate(points, std::vector<double>(points.size(), 0.0), edges, progress).triangle_count());
  }
}

BENCHMARK_CAPTURE(tin_orders, random5, Scene::Random5)
    ->RangeMultiplier(10)
    ->Range(10000, 1000000)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(triangulation, random5, Scene::Random5)
    ->RangeMultiplier(10)
    ->Range(10000, 1000000)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

}  // namespace
}  // namespace thalweg::bench
