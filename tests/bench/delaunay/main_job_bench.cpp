// The main job's phases on a million points, next to CGAL's constrained Delaunay triangulation of the same
// points and edges in the same run. Counters: seconds of processor time, all threads together, and `ratio`,
// those of orders and optimisation over CGAL's.
#include "bench/delaunay/inputs.hpp"

#include <thalweg/delaunay/ground.hpp>
#include <thalweg/optimize/optimize.hpp>
#include <thalweg/order/quadrilaterals.hpp>

#include <benchmark/benchmark.h>

namespace thalweg::bench {
namespace {

void run_phases(benchmark::State& state, InputKind kind) {
  const Survey survey = make_survey(kind, 1'000'000);
  const std::vector<ConstraintEdge> edges = line_edges(survey);
  double cgal = 0, ground_seconds = 0, orders = 0, optimize = 0;
  for (auto _ : state) {
    cgal += seconds_of_cgal(survey, edges).processor;
    Progress progress;
    Seconds start = Seconds::now();
    const auto lap = [&start] {
      const Seconds now = Seconds::now();
      const double seconds = (now - start).processor;
      start = now;
      return seconds;
    };
    const Ground ground = build_ground(survey, {.numbering = Numbering::AlongCurve}, progress);
    ground_seconds += lap();
    const auto quadrilaterals = find_quadrilaterals(ground.tin, {}, progress);
    orders += lap();
    benchmark::DoNotOptimize(optimize_first_order(ground.tin, quadrilaterals, {}, progress).flipped.data());
    optimize += lap();
  }
  using benchmark::Counter;
  state.counters["cgal_s"] = Counter(cgal, Counter::kAvgIterations);
  state.counters["ground_s"] = Counter(ground_seconds, Counter::kAvgIterations);
  state.counters["orders_s"] = Counter(orders, Counter::kAvgIterations);
  state.counters["optimize_s"] = Counter(optimize, Counter::kAvgIterations);
  state.counters["ratio"] = (orders + optimize) / cgal;
}

BENCHMARK_CAPTURE(run_phases, uniform, InputKind::Uniform)->Unit(benchmark::kSecond)->Iterations(3);
BENCHMARK_CAPTURE(run_phases, jittered, InputKind::Jittered)->Unit(benchmark::kSecond)->Iterations(3);
BENCHMARK_CAPTURE(run_phases, lattice, InputKind::Lattice)->Unit(benchmark::kSecond)->Iterations(3);
BENCHMARK_CAPTURE(run_phases, lines, InputKind::Lines)->Unit(benchmark::kSecond)->Iterations(3);

}  // namespace
}  // namespace thalweg::bench
