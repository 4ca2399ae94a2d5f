// Simplification of a million cells: fractal terrain on a lattice, to a share of its vertices. Counters:
// processor seconds of the greedy insertion a million cells, and microseconds a vertex inserted.
#include <thalweg/delaunay/ground.hpp>
#include <thalweg/delaunay/simplify.hpp>

#include <benchmark/benchmark.h>

#include <ctime>
#include <random>
#include <utility>
#include <vector>

namespace thalweg {
namespace {

constexpr std::size_t kSide = 1025;

// Diamond-square: each halving of the step halves the roughness.
std::vector<double> fractal_heights() {
  std::mt19937_64 engine(1);
  const auto noise = [&engine](double size) {
    return size * (static_cast<double>(engine() >> 11U) * 0x1p-52 - 1);
  };
  std::vector<double> z(kSide * kSide, 0);
  const auto at = [&z](std::size_t x, std::size_t y) -> double& { return z[y * kSide + x]; };
  double size = 400;
  for (std::size_t step = kSide - 1; step > 1; step /= 2, size /= 2) {
    const std::size_t half = step / 2;
    for (std::size_t y = half; y < kSide; y += step) {
      for (std::size_t x = half; x < kSide; x += step) {
        at(x, y) = (at(x - half, y - half) + at(x + half, y - half) + at(x - half, y + half) +
                    at(x + half, y + half)) /
                       4 +
                   noise(size);
      }
    }
    for (std::size_t y = 0; y < kSide; y += half) {
      for (std::size_t x = (y / half % 2 == 0) ? half : 0; x < kSide; x += step) {
        double sum = 0;
        int count = 0;
        const auto add = [&](std::size_t px, std::size_t py) {
          if (px >= kSide || py >= kSide) return;  // below zero wraps around
          sum += at(px, py);
          ++count;
        };
        add(x - half, y);
        add(x + half, y);
        add(x, y - half);
        add(x, y + half);
        at(x, y) = sum / count + noise(size);
      }
    }
  }
  return z;
}

Tin dense_tin() {
  Survey survey;
  survey.sources = {{"dem", ""}};
  survey.points.runs = {{0, 0}};
  survey.points.z = fractal_heights();
  for (std::size_t i = 0; i < kSide * kSide; ++i) {
    survey.points.xy.push_back(
        {500000 + 10.0 * static_cast<double>(i % kSide), 5200000 - 10.0 * static_cast<double>(i / kSide)});
  }
  Progress progress;
  return build_ground(survey, {.numbering = Numbering::AlongCurve}, progress).tin;
}

void simplify_to_share(benchmark::State& state) {
  static const Tin dense = dense_tin();
  const std::size_t wanted = dense.vertex_count() * static_cast<std::size_t>(state.range(0)) / 100;
  double seconds = 0;
  std::size_t vertices = 0;
  for (auto _ : state) {
    Progress progress;
    const std::clock_t before = std::clock();
    vertices += simplify(dense, {.max_vertices = wanted}, progress).tin.vertex_count();
    seconds += static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC;
  }
  state.counters["s/Mcell"] = seconds * 1e6 / static_cast<double>(dense.vertex_count() * state.iterations());
  state.counters["us/vertex"] = seconds * 1e6 / static_cast<double>(vertices);
}
BENCHMARK(simplify_to_share)->Arg(1)->Arg(5)->Arg(20)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace thalweg
