// What orders cost: seconds a pass over a ground, by kind of ground and size.
#include "delaunay/spatial_order.hpp"
#include "scenes.hpp"

#include <thalweg/delaunay/triangulate.hpp>
#include <thalweg/mesh/change_tin.hpp>
#include <thalweg/order/order_tin.hpp>
#include <thalweg/order/order_triangles.hpp>
#include <thalweg/order/quadrilaterals.hpp>
#include <thalweg/order/useful_edges.hpp>

#include <benchmark/benchmark.h>

#include <algorithm>
#include <ctime>
#include <utility>

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
  bench->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->Iterations(1);
}

BENCHMARK_CAPTURE(order_triangles, random, Scene::Random, OrderDefinition::Pathcon)->Apply(sizes_and_orders);
BENCHMARK_CAPTURE(order_triangles, comb_sees_opp, Scene::Comb, OrderDefinition::SeesOpp)
    ->Args({10000, 1})
    ->Args({10000, 3})
    ->Args({100000, 1})
    ->Args({100000, 3})
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->Iterations(1);

// Both lists of `thalweg order`: all triangles, then from them the useful edges. Processor time of all
// threads, in seconds per million found; the second includes the first.
void lists(benchmark::State& state, Scene scene, OrderDefinition definition) {
  const ConstrainedOrder order(ground(scene, static_cast<std::size_t>(state.range(0))));
  const auto k = static_cast<std::size_t>(state.range(1));
  Progress progress;
  const auto since = [](std::clock_t start) {
    return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  };
  for (auto _ : state) {
    const std::clock_t start = std::clock();
    auto triangles = find_order_triangles(order, {.definition = definition, .max_order = k}, progress);
    const auto found = static_cast<double>(triangles.size());
    state.counters["triangles"] = found;
    state.counters["s_per_million_triangles"] = since(start) / found * 1e6;
    const auto edges =
        find_useful_edges(order, std::move(triangles), {.definition = definition, .max_order = k}, progress);
    state.counters["edges"] = static_cast<double>(edges.size());
    state.counters["s_per_million_edges"] = since(start) / static_cast<double>(edges.size()) * 1e6;
    state.counters["unknown"] = static_cast<double>(
        std::count_if(edges.begin(), edges.end(), [](const UsefulEdge& e) { return !e.order; }));
  }
}

BENCHMARK_CAPTURE(lists, random5_pathcon, Scene::Random5, OrderDefinition::Pathcon)->Apply(sizes_and_orders);
BENCHMARK_CAPTURE(lists, random5_sees_triang, Scene::Random5, OrderDefinition::SeesTriang)
    ->Apply(sizes_and_orders);
BENCHMARK_CAPTURE(lists, random5_sees_vtx, Scene::Random5, OrderDefinition::SeesVtx)->Apply(sizes_and_orders);
BENCHMARK_CAPTURE(lists, random5_conf_edge, Scene::Random5, OrderDefinition::ConfEdge)
    ->Apply(sizes_and_orders);
BENCHMARK_CAPTURE(lists, random5_sees_opp, Scene::Random5, OrderDefinition::SeesOpp)->Apply(sizes_and_orders);
BENCHMARK_CAPTURE(lists, random5_std, Scene::Random5, OrderDefinition::Std)->Apply(sizes_and_orders);
BENCHMARK_CAPTURE(lists, comb_sees_opp, Scene::Comb, OrderDefinition::SeesOpp)->Apply(sizes_and_orders);

// As the build numbers its vertices: what is close in the plane is close in memory.
Tin along_curve(const Tin& tin) {
  const std::vector<std::uint32_t> order = hilbert_order(tin.points(), Progress());
  std::vector<VertexId> number(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) number[order[i]] = VertexId{i};
  return renumber(tin, number, Progress()).tin;
}

// The orders of all triangles of a triangulation: every second quadrilateral that is first-order under
// `flipped` is flipped. And the triangulation of the same vertices and constraint edges: processor time of
// both, on all threads together.
void tin_orders(benchmark::State& state, Scene scene, OrderDefinition definition, OrderDefinition flipped) {
  const Tin delaunay = along_curve(ground(scene, static_cast<std::size_t>(state.range(0))));
  std::vector<HalfedgeId> flips;
  std::size_t i = 0;
  for (const Quadrilateral& q : find_quadrilaterals(delaunay, {.definition = flipped}, Progress())) {
    if (++i % 2 == 0) flips.push_back(q.diagonal);
  }
  const Tin tin = flip_edges(delaunay, flips).tin;
  const std::vector<ConstraintEdge> edges = tin.constraint_edges();
  const std::vector<Point2> points(tin.points().begin(), tin.points().end());
  const std::vector<double> heights(points.size(), 0.0);
  Progress progress;
  std::uint32_t largest = 0;
  double orders_s = 0, triangulation_s = 0;
  for (auto _ : state) {
    const std::clock_t start = std::clock();
    benchmark::DoNotOptimize(triangulate(points, heights, edges, progress).triangle_count());
    const std::clock_t middle = std::clock();
    largest = find_tin_orders(tin, {.definition = definition}, progress).max_order;
    const double seconds = static_cast<double>(std::clock() - middle) / CLOCKS_PER_SEC;
    orders_s += seconds;
    triangulation_s += static_cast<double>(middle - start) / CLOCKS_PER_SEC;
    state.SetIterationTime(seconds);
  }
  state.counters["max_order"] = static_cast<double>(largest);
  state.counters["to_triangulation"] = orders_s / triangulation_s;
}

void tin_sizes(benchmark::internal::Benchmark* bench) {
  bench->RangeMultiplier(10)->Range(10000, 1000000)->Unit(benchmark::kMillisecond)->UseManualTime();
}

constexpr auto kPathcon = OrderDefinition::Pathcon;
constexpr auto kSeesTriang = OrderDefinition::SeesTriang;
constexpr auto kSeesVtx = OrderDefinition::SeesVtx;
constexpr auto kConfEdge = OrderDefinition::ConfEdge;
constexpr auto kSeesOpp = OrderDefinition::SeesOpp;
BENCHMARK_CAPTURE(tin_orders, random5_pathcon, Scene::Random5, kPathcon, kPathcon)->Apply(tin_sizes);
BENCHMARK_CAPTURE(tin_orders, random5_sees_triang, Scene::Random5, kSeesTriang, kSeesTriang)
    ->Apply(tin_sizes);
BENCHMARK_CAPTURE(tin_orders, random5_sees_vtx, Scene::Random5, kSeesVtx, kSeesVtx)->Apply(tin_sizes);
BENCHMARK_CAPTURE(tin_orders, random5_conf_edge, Scene::Random5, kConfEdge, kConfEdge)->Apply(tin_sizes);
BENCHMARK_CAPTURE(tin_orders, random5_sees_opp, Scene::Random5, kSeesOpp, kSeesOpp)->Apply(tin_sizes);
BENCHMARK_CAPTURE(tin_orders, random5_higher_pathcon, Scene::Random5, kPathcon, kSeesOpp)->Apply(tin_sizes);
BENCHMARK_CAPTURE(tin_orders, random5_higher_sees_triang, Scene::Random5, kSeesTriang, kSeesOpp)
    ->Apply(tin_sizes);
BENCHMARK_CAPTURE(tin_orders, random5_higher_sees_vtx, Scene::Random5, kSeesVtx, kSeesOpp)->Apply(tin_sizes);
BENCHMARK_CAPTURE(tin_orders, random5_std, Scene::Random5, OrderDefinition::Std, kSeesOpp)->Apply(tin_sizes);
BENCHMARK_CAPTURE(tin_orders, lattice, Scene::Lattice, kSeesOpp, kSeesOpp)->Apply(tin_sizes);
BENCHMARK_CAPTURE(tin_orders, comb, Scene::Comb, kSeesOpp, kSeesOpp)
    ->Arg(10000)
    ->Unit(benchmark::kMillisecond)
    ->UseManualTime();

}  // namespace
}  // namespace thalweg::bench
