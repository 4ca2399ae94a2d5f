// What orders cost: seconds a pass over a ground, by kind of ground and size.
#include "scenes.hpp"

#include <thalweg/order/order_triangles.hpp>
#include <thalweg/order/quadrilaterals.hpp>

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

}  // namespace
}  // namespace thalweg::bench
