// The main job's phases on a million points, next to CGAL's constrained Delaunay triangulation of the bare
// points in the same run. Counters: seconds of processor time, all threads together, and `ratio`, those of
// orders and optimisation over CGAL's. The points are given along no order: random, or a lattice row by row;
// `lines` adds 50 000 constraint segments, which CGAL is spared.
#include <thalweg/delaunay/ground.hpp>
#include <thalweg/optimize/optimize.hpp>
#include <thalweg/order/quadrilaterals.hpp>

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <benchmark/benchmark.h>

#include <ctime>
#include <random>
#include <vector>

namespace thalweg {
namespace {

constexpr std::size_t kSide = 1000;
constexpr std::size_t kPoints = kSide * kSide;
constexpr std::size_t kLines = 50000;

double processor_seconds() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

Survey random_survey() {
  std::mt19937_64 engine(1);
  const auto real = [&engine](double low, double high) {
    return low + (high - low) * (static_cast<double>(engine() >> 11U) * 0x1p-53);
  };
  Survey survey;
  survey.sources = {{"points", ""}};
  survey.points.runs = {{0, 0}};
  for (std::size_t i = 0; i < kPoints; ++i) {
    survey.points.xy.push_back({real(0, 1e5), real(0, 1e5)});
    survey.points.z.push_back(real(0, 500));
  }
  return survey;
}

Survey lattice_survey() {
  Survey survey = random_survey();
  for (std::size_t i = 0; i < kPoints; ++i) {
    survey.points.xy[i] = {500000 + 30.0 * static_cast<double>(i % kSide),
                           5200000 - 30.0 * static_cast<double>(i / kSide)};
  }
  return survey;
}

// Each segment runs from a cell's corner to the opposite one, in a cell of its own.
Survey lattice_survey_with_lines() {
  Survey survey = lattice_survey();
  for (std::size_t i = 0; i < kLines; ++i) {
    const std::size_t cell = i * (kPoints / kLines);
    if (cell % kSide + 1 == kSide || cell / kSide + 1 == kSide) continue;
    const std::size_t opposite = cell + kSide + 1;
    survey.lines.push_back({.kind = EdgeKind::Valley,
                            .xy = {survey.points.xy[cell], survey.points.xy[opposite]},
                            .z = {survey.points.z[cell], survey.points.z[opposite]},
                            .source = 0,
                            .feature = static_cast<std::int64_t>(i),
                            .part = 0});
  }
  return survey;
}

double seconds_of_cgal(const Survey& survey) {
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  std::vector<Kernel::Point_2> points;
  points.reserve(survey.points.xy.size());
  for (const Point2 p : survey.points.xy) points.emplace_back(p.x, p.y);
  const double start = processor_seconds();
  CGAL::Constrained_Delaunay_triangulation_2<Kernel> cdt;
  cdt.insert(points.begin(), points.end());
  const double seconds = processor_seconds() - start;
  benchmark::DoNotOptimize(cdt.number_of_vertices());
  return seconds;
}

void run_phases(benchmark::State& state, Survey (*make)()) {
  const Survey survey = make();
  double cgal = 0, ground_seconds = 0, orders = 0, optimize = 0;
  for (auto _ : state) {
    cgal += seconds_of_cgal(survey);
    Progress progress;
    double start = processor_seconds();
    const auto lap = [&start] {
      const double now = processor_seconds(), seconds = now - start;
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

BENCHMARK_CAPTURE(run_phases, random, &random_survey)->Unit(benchmark::kSecond)->Iterations(3);
BENCHMARK_CAPTURE(run_phases, lattice, &lattice_survey)->Unit(benchmark::kSecond)->Iterations(3);
BENCHMARK_CAPTURE(run_phases, lines, &lattice_survey_with_lines)->Unit(benchmark::kSecond)->Iterations(3);

}  // namespace
}  // namespace thalweg
