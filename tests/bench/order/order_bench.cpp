// What orders cost: seconds a pass over a ground, by kind of ground and size.
#include "scenes.hpp"

#include <thalweg/order/constrained_order.hpp>
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

}  // namespace
}  // namespace thalweg::bench
