// One row of higher_order.md: what an order gives on one set of points, exactly and by the heuristics.
// Usage: bench_higher_order FOLDER SAMPLE lines|none K|auto; FOLDER holds SAMPLE.csv (x,y,z) and lines.gpkg
// with the layers valleys_3d and ridges_3d. Seconds are of processor time, all threads together.
#include <thalweg/optimize/pit_heuristics.hpp>
#include <thalweg/order/useful_triangles.hpp>
#include <thalweg/pipeline/build.hpp>
#include <thalweg/terrain/pits.hpp>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace thalweg::bench {
namespace {

/// The largest order that `auto` may take.
constexpr std::size_t kMostOfAuto = 3;

double lap() {
  static std::clock_t last = 0;
  const std::clock_t now = std::clock(), before = last;
  last = now;
  return static_cast<double>(now - before) / CLOCKS_PER_SEC;
}

struct Row {
  BuiltTin built;
  FixedFaces faces;
  OptimizeOptions options;
  Progress progress;

  [[nodiscard]] FaceOptimizeResult best(std::vector<Objective> criteria,
                                        std::optional<std::size_t> order_sum_after = std::nullopt) {
    FaceOptimizeOptions wanted{.common = options, .order_sum_after = order_sum_after};
    wanted.common.criteria = std::move(criteria);
    return optimize_faces(built.tin, faces, wanted, progress);
  }
  [[nodiscard]] std::size_t pits_by(PitHeuristic heuristic) const {
    std::vector<Triangle> triangles;
    for (const OrderTriangle& t : remove_pits(built.tin, faces, heuristic, progress)) {
      triangles.push_back(t.corners);
    }
    const Tin tin({built.tin.points().begin(), built.tin.points().end()},
                  {built.tin.heights().begin(), built.tin.heights().end()}, std::move(triangles),
                  built.tin.constraint_edges());
    return find_pits(tin).interior;
  }
};

BuiltTin read_delaunay(const std::string& folder, const std::string& sample, bool lines) {
  BuildConfig config;
  config.points = {{folder + "/" + sample + ".csv", {}}};
  if (lines) {
    config.lines = {{{folder + "/lines.gpkg", "valleys_3d"}, EdgeKind::Valley},
                    {{folder + "/lines.gpkg", "ridges_3d"}, EdgeKind::Ridge}};
  }
  if (folder.ends_with("_lonlat")) config.read.assigned_crs = "EPSG:4326";
  config.labelling.order = 0;
  config.labelling.criteria.clear();
  Progress progress;
  return build_tin(config, {}, progress);
}

void print_value(const CriterionResult& line, int digits) {
  std::printf(" %.*f | ", digits, line.result);
  if (line.optimal) {
    std::printf("optimal |");
  } else {
    std::printf("bound %.*f |", digits, line.bound);
  }
}

void print_figures(const FaceOptimizeResult& result) {
  std::printf(" %zu | %zu | %zu | %zu | %zu |", result.faces, result.partial_faces, result.largest_face,
              result.labels, result.largest_piece);
}

/// Each value is printed as soon as it is known, for what comes later may take too long.
void print_order(Row& row, double listing) {
  lap();
  const FaceOptimizeResult pits = row.best({Criterion::LocalMinima, Criterion::NormalAngleSum});
  const double of_pits = lap();
  const std::size_t flip = row.pits_by(PitHeuristic::Flip);
  const double of_flip = lap();
  const std::size_t hull = row.pits_by(PitHeuristic::Hull);
  const double of_hull = lap();
  print_value(pits.criteria[0], 0);
  std::printf(" %zu | %zu |", flip, hull);
  print_value(pits.criteria[1], 2);
  print_figures(pits);
  std::printf(" %.2f | %.2f | %.2f | %.2f |", listing, of_pits, of_flip, of_hull);
  std::fflush(stdout);
  for (const auto& [criterion, digits] :
       {std::pair(Criterion::EdgeLength, 0), std::pair(Criterion::MaxAngle, 3),
        std::pair(Criterion::NormalAngleMax, 2)}) {
    const FaceOptimizeResult alone = row.best({criterion});
    print_value(alone.criteria[0], digits);
    std::printf(" %.2f |", lap());
    std::fflush(stdout);
  }
  std::printf("\n");
}

void print_auto(Row& row, double listing) {
  lap();
  const FaceOptimizeResult result =
      row.best({Criterion::LocalMinima, Criterion::NormalAngleSum}, std::size_t{1});
  const double choosing = lap();
  std::vector<std::size_t> histogram(kMostOfAuto + 1, 0);
  for (const OrderTriangle& t : result.triangles) ++histogram[t.order];
  print_value(result.criteria[0], 0);
  print_value(result.criteria[1], 0);
  for (const std::size_t count : histogram) std::printf(" %zu |", count);
  print_value(result.criteria[2], 2);
  std::printf(" %.2f | %.2f |\n", listing, choosing);
}

void print_row(const std::array<std::string, 4>& words) {
  const auto& [folder, sample, lines, order] = words;
  Row row{read_delaunay(folder, sample, lines == "lines"), {}, {}, {}};
  row.options.horizontal_metres_per_unit = row.built.report.crs.horizontal_metres_per_unit;
  row.options.vertical_metres_per_unit = row.built.report.crs.vertical_metres_per_unit;
  const std::size_t k = order == "auto" ? kMostOfAuto : std::strtoul(order.c_str(), nullptr, 10);
  lap();
  const ConstrainedOrder ground(row.built.tin);
  row.faces = find_fixed_faces(row.built.tin, find_useful_triangles(ground, {.max_order = k}, row.progress),
                               {}, row.progress)
                  .value();
  const double listing = lap();
  std::printf("| %s, %s | %s | %s |", std::filesystem::path(folder).filename().c_str(), sample.c_str(),
              lines.c_str(), order.c_str());
  if (order == "auto") {
    print_auto(row, listing);
  } else {
    print_order(row, listing);
  }
}

}  // namespace
}  // namespace thalweg::bench

int main(int count, char** arguments) {
  if (count != 5) {
    std::fprintf(stderr, "usage: bench_higher_order FOLDER SAMPLE lines|none K|auto\n");
    return 2;
  }
  thalweg::bench::print_row({arguments[1], arguments[2], arguments[3], arguments[4]});
  return 0;
}
