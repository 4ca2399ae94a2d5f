// Processor time and memory of orders and optimisation for the default criteria, on growing input, next to
// CGAL's constrained Delaunay triangulation of the bare points in the same run. Usage: bench_scaling [N...];
// default 10000 100000 1000000. Prints rows of a markdown table: microseconds of processor time a point (all
// threads together), and bytes a point that the peak of orders and optimisation lies above what the ground
// holds. Points at random, on a jittered lattice, on a lattice; heights are fractal.
#include <thalweg/delaunay/ground.hpp>
#include <thalweg/optimize/optimize.hpp>
#include <thalweg/order/quadrilaterals.hpp>

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <malloc.h>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <random>
#include <string>
#include <vector>

namespace thalweg::bench {
namespace {

double processor_seconds() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

/// A value of 0 to 1 for a node of a lattice.
double node_value(std::int64_t i, std::int64_t j, std::uint64_t octave) {
  std::uint64_t h = static_cast<std::uint64_t>(i) * 0x9e3779b97f4a7c15U ^
                    static_cast<std::uint64_t>(j) * 0xc2b2ae3d27d4eb4fU ^ octave * 0x165667b19e3779f9U;
  h = (h ^ (h >> 31U)) * 0xbf58476d1ce4e5b9U;
  h = (h ^ (h >> 29U)) * 0x94d049bb133111ebU;
  return static_cast<double>((h ^ (h >> 32U)) >> 11U) * 0x1p-53;
}

/// Bilinear noise of nine octaves, each of half the wavelength and 0.6 times the amplitude: from kilometres
/// down to a few cells of 30 m.
double fractal_height(Point2 p) {
  double height = 0, amplitude = 400, wavelength = 12800;
  for (std::uint64_t octave = 0; octave < 9; ++octave) {
    const double x = p.x / wavelength, y = p.y / wavelength;
    const double i = std::floor(x), j = std::floor(y), fx = x - i, fy = y - j;
    const auto at = [&](int di, int dj) {
      return node_value(static_cast<std::int64_t>(i) + di, static_cast<std::int64_t>(j) + dj, octave);
    };
    height += amplitude *
              ((1 - fy) * ((1 - fx) * at(0, 0) + fx * at(1, 0)) + fy * ((1 - fx) * at(0, 1) + fx * at(1, 1)));
    amplitude *= 0.6;
    wavelength /= 2;
  }
  return height;
}

enum class Kind { Random, Jittered, Lattice };

Survey make_survey(Kind kind, std::size_t points) {
  std::mt19937_64 engine(1);
  const auto real = [&engine] { return static_cast<double>(engine() >> 11U) * 0x1p-53; };
  const auto side = static_cast<std::size_t>(std::llround(std::sqrt(static_cast<double>(points))));
  constexpr double kCell = 30;
  Survey survey;
  survey.sources = {{"points", ""}};
  survey.points.runs = {{0, 0}};
  for (std::size_t i = 0; i < side * side; ++i) {
    Point2 p{static_cast<double>(i % side), static_cast<double>(i / side)};
    if (kind == Kind::Jittered) p = {p.x + 0.8 * real() - 0.4, p.y + 0.8 * real() - 0.4};
    if (kind == Kind::Random) p = {static_cast<double>(side) * real(), static_cast<double>(side) * real()};
    p = {kCell * p.x, kCell * p.y};
    survey.points.xy.push_back(p);
    survey.points.z.push_back(fractal_height(p));
  }
  return survey;
}

double seconds_of_cgal(const Survey& survey) {
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  std::vector<Kernel::Point_2> points;
  for (const Point2 p : survey.points.xy) points.emplace_back(p.x, p.y);
  const double start = processor_seconds();
  CGAL::Constrained_Delaunay_triangulation_2<Kernel> cdt;
  cdt.insert(points.begin(), points.end());
  return cdt.number_of_vertices() == 0 ? 0 : processor_seconds() - start;
}

/// A line of /proc/self/status, in bytes.
double status_bytes(const std::string& key) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with(key)) return 1024 * std::stod(line.substr(key.size() + 1));
  }
  return 0;
}

/// What is resident from here on counts for the peak.
double start_peak() {
  malloc_trim(0);
  std::ofstream("/proc/self/clear_refs") << "5";
  return status_bytes("VmRSS");
}

void print_row(const char* name, Kind kind, std::size_t points) {
  const Survey survey = make_survey(kind, points);
  const auto count = static_cast<double>(survey.points.xy.size());
  const double cgal = seconds_of_cgal(survey);
  Progress progress;
  const Ground ground = build_ground(survey, {.numbering = Numbering::AlongCurve}, progress);
  const double resident = start_peak();
  const double start = processor_seconds();
  const auto quadrilaterals = find_quadrilaterals(ground.tin, {}, progress);
  const double orders = processor_seconds() - start;
  const OptimizeResult result = optimize_first_order(ground.tin, quadrilaterals, {}, progress);
  const double both = processor_seconds() - start;
  const double bytes = status_bytes("VmHWM") - resident;
  const bool proved = result.criteria[0].optimal && result.criteria[1].optimal;
  std::printf("| %s | %.0f | %zu | %.2f | %.2f | %.2f | %.2f | %.0f | %s | %zu | %zu |\n", name, count,
              quadrilaterals.size(), 1e6 * cgal / count, 1e6 * orders / count, 1e6 * (both - orders) / count,
              both / cgal, bytes / count, proved ? "optimal" : "open", result.largest_piece, result.width);
  std::fflush(stdout);
}

}  // namespace
}  // namespace thalweg::bench

int main(int argc, char** argv) {
  using thalweg::bench::Kind;
  std::vector<std::size_t> sizes;
  for (int i = 1; i < argc; ++i) sizes.push_back(std::strtoull(argv[i], nullptr, 10));
  if (sizes.empty()) sizes = {10'000, 100'000, 1'000'000};
  std::puts(
      "| points | n | quadrilaterals | CGAL, us | orders, us | optimise, us | ratio | bytes | | largest | "
      "width |");
  std::puts("|---|---|---|---|---|---|---|---|---|---|---|");
  for (const std::size_t n : sizes) thalweg::bench::print_row("random", Kind::Random, n);
  for (const std::size_t n : sizes) thalweg::bench::print_row("jittered lattice", Kind::Jittered, n);
  for (const std::size_t n : sizes) thalweg::bench::print_row("lattice", Kind::Lattice, n);
  return 0;
}
