// What flow, pits, network and catchments cost on growing input, next to the triangulation of the same points
// in the same run. Usage: bench_drainage_table [N...]; default 10000 100000 1000000. Prints rows of a
// markdown table: microseconds a point of processor time, all threads together, the least of several runs;
// the ratio to the triangulation, and that of the times on the clock. Points at random and on a lattice;
// heights are fractal; the network is of all channels that drain a hundred cells.
#include "bench/fractal_terrain.hpp"
#include "bench/seconds.hpp"

#include <thalweg/delaunay/triangulate.hpp>
#include <thalweg/terrain/catchments.hpp>
#include <thalweg/terrain/network.hpp>
#include <thalweg/terrain/pit_table.hpp>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <numeric>
#include <vector>

namespace thalweg::bench {
namespace {

enum Step : std::size_t { Triangulation, Flow, Pits, Network, Catchments, Drainage, kSteps };

/// The least of all runs.
class Stopwatch {
 public:
  Stopwatch() { least_.fill({kForever, kForever}); }
  void start() { start_ = Seconds::now(); }
  void stop(Step step) {
    const Seconds lap = Seconds::now() - start_;
    least_[step] = {std::min(least_[step].wall, lap.wall), std::min(least_[step].processor, lap.processor)};
  }
  [[nodiscard]] Seconds least(Step step) const { return least_[step]; }

 private:
  static constexpr double kForever = std::numeric_limits<double>::infinity();
  Seconds start_;
  std::array<Seconds, kSteps> least_;
};

constexpr double kMinArea = 100 * 900;  // of the network: a hundred cells

struct Counts {
  std::size_t pits = 0, reaches = 0, catchments = 0;
};

Counts drain(const Tin& tin, double min_area, Stopwatch& whole, Stopwatch& step) {
  Progress progress;
  whole.start();
  step.start();
  const SurfaceFlow flow(tin, {}, progress);
  step.stop(Flow);
  step.start();
  const PitTable table = tabulate_pits(flow, {}, progress);
  step.stop(Pits);
  step.start();
  const std::vector<Reach> network = find_network(flow, let_spill(flow, table, 0), min_area, progress);
  step.stop(Network);
  step.start();
  std::vector<std::uint32_t> group(flow.sinks().size());
  std::iota(group.begin(), group.end(), 0U);
  const std::vector<Catchment> catchments = outline_catchments(flow, group, progress);
  step.stop(Catchments);
  whole.stop(Drainage);
  return {table.pits.size(), network.size(), catchments.size()};
}

void print_row(const char* name, Pattern pattern, std::size_t count) {
  const TerrainPoints points = fractal_terrain(pattern, count);
  const auto n = static_cast<double>(points.xy.size());
  const int runs = count < 1'000'000 ? 9 : count > 2'000'000 ? 2 : 4;
  Stopwatch whole, step;
  Counts counts;
  for (int run = 0; run < runs; ++run) {
    Progress progress;
    step.start();
    const Tin tin = triangulate(points.xy, points.z, {}, progress);
    step.stop(Triangulation);
    counts = drain(tin, kMinArea, whole, step);
  }
  const Seconds all = whole.least(Drainage), triangulation = step.least(Triangulation);
  const auto micros = [&](Step s) { return 1e6 * step.least(s).processor / n; };
  std::printf("| %s | %.0f | %zu | %zu | %zu | %.2f | %.2f | %.2f | %.2f | %.2f | %.2f | %.2f | %.2f |\n",
              name, n, counts.pits, counts.reaches, counts.catchments, micros(Triangulation), micros(Flow),
              micros(Pits), micros(Network), micros(Catchments), 1e6 * all.processor / n,
              all.processor / triangulation.processor, all.wall / triangulation.wall);
  std::fflush(stdout);
}

}  // namespace
}  // namespace thalweg::bench

int main(int argc, char** argv) {
  using thalweg::bench::Pattern;
  std::vector<std::size_t> sizes;
  for (int i = 1; i < argc; ++i) sizes.push_back(std::strtoull(argv[i], nullptr, 10));
  if (sizes.empty()) sizes = {10'000, 100'000, 1'000'000};
  std::puts(
      "| points | n | pits | reaches | catchments | triangulate, us | flow | pits | network | catchments | "
      "all "
      "| ratio | on the clock |");
  std::puts("|---|---|---|---|---|---|---|---|---|---|---|---|---|");
  for (const std::size_t n : sizes) thalweg::bench::print_row("random", Pattern::Random, n);
  for (const std::size_t n : sizes) thalweg::bench::print_row("lattice", Pattern::Lattice, n);
  return 0;
}
