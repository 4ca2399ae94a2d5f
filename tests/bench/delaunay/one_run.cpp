// One measurement of tools/dev/bench, in a process of its own.
//
//   bench_one_run WHAT INPUT POINTS THREADS
// prints seconds, and the bytes by which the peak lies above the input, as JSON. WHAT: cgal; triangulate,
// of points that are known to be distinct; ground, as `thalweg build` does it, from a survey; solve, the
// same and orders and the default criteria.
//
//   bench_one_run write INPUT POINTS FOLDER
// writes points.csv, points.f64 (x, y as doubles) and, where there are lines, lines.csv (WKT).
#include "bench/delaunay/inputs.hpp"

#include <thalweg/delaunay/ground.hpp>
#include <thalweg/optimize/optimize.hpp>
#include <thalweg/order/quadrilaterals.hpp>

#include <tbb/global_control.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace thalweg::bench {
namespace {

void write(const Survey& survey, const std::string& folder) {
  using File = std::unique_ptr<std::FILE, decltype([](std::FILE* file) { std::fclose(file); })>;
  const auto open = [&folder](const char* name) {
    return File(std::fopen((folder + "/" + name).c_str(), "wb"));
  };
  const auto& xy = survey.points.xy;
  const File points = open("points.csv");
  std::fputs("x,y,z\n", points.get());
  for (std::size_t i = 0; i < xy.size(); ++i) {
    std::fprintf(points.get(), "%.17g,%.17g,%.17g\n", xy[i].x, xy[i].y, survey.points.z[i]);
  }
  const File doubles = open("points.f64");
  std::fwrite(xy.data(), sizeof(Point2), xy.size(), doubles.get());
  if (survey.lines.empty()) return;
  const File lines = open("lines.csv");
  std::fputs("id,WKT\n", lines.get());
  for (const SurveyLine& line : survey.lines) {
    std::fprintf(lines.get(), "%lld,\"LINESTRING Z (%.17g %.17g %.17g,%.17g %.17g %.17g)\"\n",
                 static_cast<long long>(line.feature), line.xy[0].x, line.xy[0].y, line.z[0], line.xy[1].x,
                 line.xy[1].y, line.z[1]);
  }
}

/// What the work takes, without freeing its result; nothing if there is no result.
std::optional<Seconds> measured(std::string_view what, Survey& survey,
                                const std::vector<ConstraintEdge>& edges) {
  if (what == "cgal") return seconds_of_cgal(survey, edges);
  Progress progress;
  const Seconds start = Seconds::now();
  if (what == "triangulate") {
    const Tin tin = triangulate(std::move(survey.points.xy), std::move(survey.points.z), edges, progress);
    return Seconds::now() - start;
  }
  const Ground ground = build_ground(survey, {.numbering = Numbering::AlongCurve}, progress);
  if (what == "ground") return Seconds::now() - start;
  survey = {};
  const auto quadrilaterals = find_quadrilaterals(ground.tin, {}, progress);
  const OptimizeResult result = optimize_first_order(ground.tin, quadrilaterals, {}, progress);
  if (!result.criteria[0].optimal || !result.criteria[1].optimal) return {};
  return Seconds::now() - start;
}

int run(std::string_view what, InputKind kind, std::size_t count, const char* last) {
  Survey survey = make_survey(kind, count);
  if (what == "write") return write(survey, last), 0;
  const auto edges = line_edges(survey);
  const tbb::global_control threads(tbb::global_control::max_allowed_parallelism,
                                    std::strtoull(last, nullptr, 10));
  const double resident = start_peak();
  const auto seconds = measured(what, survey, edges);
  if (!seconds) return 1;
  std::printf("{\"wall\": %.6f, \"processor\": %.6f, \"bytes\": %.0f}\n", seconds->wall, seconds->processor,
              peak_bytes() - resident);
  return 0;
}

}  // namespace
}  // namespace thalweg::bench

int main(int argc, char** argv) {
  using namespace thalweg::bench;
  constexpr std::array<std::string_view, 5> kWork{"cgal", "triangulate", "ground", "solve", "write"};
  const auto* input = argc == 5 ? std::ranges::find(kInputNames, argv[2]) : kInputNames.end();
  if (input == kInputNames.end() || std::ranges::count(kWork, argv[1]) == 0) {
    std::fputs("usage: bench_one_run WHAT INPUT POINTS THREADS|FOLDER\n", stderr);
    return 2;
  }
  const auto kind = static_cast<InputKind>(input - kInputNames.begin());
  return run(argv[1], kind, std::strtoull(argv[3], nullptr, 10), argv[4]);
}
