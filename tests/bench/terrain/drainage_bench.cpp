// Flow, pits, network and catchments beside the triangulation of the same points: hills with noise.
#include <thalweg/delaunay/triangulate.hpp>
#include <thalweg/terrain/catchments.hpp>
#include <thalweg/terrain/network.hpp>
#include <thalweg/terrain/pit_table.hpp>

#include <benchmark/benchmark.h>

#include <cmath>
#include <numeric>
#include <random>
#include <vector>

namespace thalweg {
namespace {

struct Points {
  std::vector<Point2> xy;
  std::vector<double> z;
};

Points hills(std::size_t count) {
  std::mt19937_64 random(20240601);
  const auto real = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  const double side = 10 * std::sqrt(static_cast<double>(count));
  Points points;
  for (std::size_t i = 0; i < count; ++i) {
    const Point2 p{side * real(), side * real()};
    points.xy.push_back(p);
    points.z.push_back(40 * std::sin(p.x / 300) * std::cos(p.y / 400) + 6 * std::sin(p.x / 41 + p.y / 57) +
                       real());
  }
  return points;
}

Tin tin_of(const Points& points) {
  Progress progress;
  return triangulate(points.xy, points.z, {}, progress);
}

void triangulation(benchmark::State& state) {
  const Points points = hills(static_cast<std::size_t>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(tin_of(points));
}

void drainage(benchmark::State& state) {
  const Tin tin = tin_of(hills(static_cast<std::size_t>(state.range(0))));
  for (auto _ : state) {
    Progress progress;
    const SurfaceFlow flow(tin, {}, progress);
    const PitTable table = tabulate_pits(flow, {}, progress);
    const std::vector<Reach> network = find_network(flow, let_spill(flow, table, 0), 1e6, progress);
    std::vector<std::uint32_t> group(flow.sinks().size());
    std::iota(group.begin(), group.end(), 0U);
    const std::vector<Catchment> catchments = outline_catchments(flow, group, progress);
    state.counters["pits"] = static_cast<double>(table.pits.size());
    state.counters["reaches"] = static_cast<double>(network.size());
    state.counters["catchments"] = static_cast<double>(catchments.size());
  }
}

BENCHMARK(triangulation)
    ->RangeMultiplier(10)
    ->Range(10'000, 1'000'000)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime();
BENCHMARK(drainage)
    ->RangeMultiplier(10)
    ->Range(10'000, 1'000'000)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime();

}  // namespace
}  // namespace thalweg
