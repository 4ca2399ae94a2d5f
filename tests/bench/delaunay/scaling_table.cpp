// Processor time and memory on growing input, next to CGAL's constrained Delaunay triangulation of the bare
// points in the same run. Usage: bench_scaling [--without-cgal] [N...]; default 10000 100000 1000000. Prints
// rows of a markdown table: microseconds of processor time a point (all threads together) of CGAL, the
// ground, orders, optimisation for the default criteria, and the three together; that of orders and
// optimisation, and that of all, over CGAL's; bytes a point by which the peak lies above the survey.
#include "bench/delaunay/inputs.hpp"

#include <thalweg/delaunay/ground.hpp>
#include <thalweg/optimize/optimize.hpp>
#include <thalweg/order/quadrilaterals.hpp>

#include <cstdio>
#include <cstdlib>
#include <string_view>
#include <vector>

namespace thalweg::bench {
namespace {

void print_row(InputKind kind, std::size_t points, bool with_cgal) {
  const Survey survey = make_survey(kind, points);
  const auto count = static_cast<double>(survey.points.xy.size());
  const double cgal = with_cgal ? seconds_of_cgal(survey, {}).processor : 0;
  Progress progress;
  const double resident = start_peak();
  Seconds start = Seconds::now();
  const auto lap = [&start] {
    const Seconds now = Seconds::now();
    const double seconds = (now - start).processor;
    start = now;
    return seconds;
  };
  const Ground ground = build_ground(survey, {.numbering = Numbering::AlongCurve}, progress);
  const double triangulate = lap();
  const auto quadrilaterals = find_quadrilaterals(ground.tin, {}, progress);
  const double orders = lap();
  const OptimizeResult result = optimize_first_order(ground.tin, quadrilaterals, {}, progress);
  const double optimize = lap();
  const double bytes = peak_bytes() - resident;
  const bool proved = result.criteria[0].optimal && result.criteria[1].optimal;
  const auto micro = [count](double seconds) { return 1e6 * seconds / count; };
  std::printf("| %s | %.0f | %.2f | %.2f | %.2f | %.2f | %.2f |",
              kInputNames[static_cast<std::size_t>(kind)].data(), count, micro(cgal), micro(triangulate),
              micro(orders), micro(optimize), micro(triangulate + orders + optimize));
  if (with_cgal) {
    std::printf(" %.2f | %.2f |", (orders + optimize) / cgal, (triangulate + orders + optimize) / cgal);
  } else {
    std::printf(" | |");
  }
  std::printf(" %.0f | %s | %zu | %zu |\n", bytes / count, proved ? "optimal" : "open", result.largest_piece,
              result.width);
  std::fflush(stdout);
}

}  // namespace
}  // namespace thalweg::bench

int main(int argc, char** argv) {
  using thalweg::bench::InputKind;
  std::vector<std::size_t> sizes;
  bool with_cgal = true;
  for (int i = 1; i < argc; ++i) {
    if (std::string_view(argv[i]) == "--without-cgal") {
      with_cgal = false;
    } else {
      sizes.push_back(std::strtoull(argv[i], nullptr, 10));
    }
  }
  if (sizes.empty()) sizes = {10'000, 100'000, 1'000'000};
  std::puts(
      "| points | n | CGAL, us | ground, us | orders, us | optimise, us | together, us | orders, optimise / "
      "CGAL | "
      "all / CGAL | bytes | | largest | width |");
  std::puts("|---|---|---|---|---|---|---|---|---|---|---|---|---|");
  for (const InputKind kind : {InputKind::Uniform, InputKind::Jittered, InputKind::Lattice}) {
    for (const std::size_t n : sizes) thalweg::bench::print_row(kind, n, with_cgal);
  }
  return 0;
}
