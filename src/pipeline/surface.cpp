// From ground to files.
//
// 1. Diagonals are chosen (choose_diagonals.cpp).
// 2. The chosen TIN is checked in the plane and in the written coordinates, and its pits are counted again by
//    plain code, before anything is written.
// 3. The outcome gets the ids of the outputs; all files are written aside and renamed together.
#include "pipeline/surface.hpp"

#include "base/lower_case.hpp"
#include "base/parallel.hpp"
#include "base/release.hpp"
#include "pipeline/choose_diagonals.hpp"
#include "pipeline/condition_tin.hpp"
#include "pipeline/digest.hpp"
#include "pipeline/higher_order.hpp"
#include "pipeline/lengths.hpp"

#include <thalweg/base/error.hpp>
#include <thalweg/geodesy/geodesic.hpp>
#include <thalweg/io/picture.hpp>
#include <thalweg/io/write_features.hpp>
#include <thalweg/io/write_tin.hpp>
#include <thalweg/mesh/change_tin.hpp>
#include <thalweg/mesh/rim.hpp>
#include <thalweg/mesh/validate.hpp>
#include <thalweg/terrain/consistency.hpp>
#include <thalweg/terrain/pit_changes.hpp>
#include <thalweg/terrain/pits.hpp>
#include <thalweg/terrain/statistics.hpp>

#include <sys/resource.h>
#include <tbb/parallel_invoke.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>
#include <tuple>
#include <utility>

namespace thalweg {

double Stopwatch::lap() {
  const Clock::time_point now = Clock::now();
  const double seconds = std::chrono::duration<double>(now - last_).count();
  last_ = now;
  return seconds;
}

double Stopwatch::total() const {
  return std::chrono::duration<double>(Clock::now() - start_).count();
}

RunOutputs::RunOutputs(const OutputConfig& config, const std::vector<std::string>& sources)
    : pending(sources) {
  const Overwrite mode = config.overwrite ? Overwrite::Yes : Overwrite::No;
  if (config.path.empty()) return;
  check_write_options(config.path, {.format = config.format, .creation_options = config.creation_options});
  const auto reserve = [&](const std::string& path) {
    return path.empty() || path == "-" ? std::string() : pending.add(path, mode);
  };
  if (!config.problem_path.empty() && std::filesystem::path(config.problem_path).extension() != ".cfn") {
    throw Error(ErrorCode::Usage, "--dump-problem writes .cfn, not '" + config.problem_path + "'");
  }
  report = reserve(config.report_path);
  picture = reserve(config.picture_path);
  problem = reserve(config.problem_path);
  proof = reserve(config.proof_path);
  pending.plan(config.path, mode);
  if (config.changes_path.empty()) return;
  check_features_path(config.changes_path);
  pending.plan(config.changes_path, mode);
}

namespace {

// Elements that a thread takes at once.
constexpr std::size_t kBlock = 8192;

template <class Value>
std::vector<Value> renumbered(std::span<const Value> values, std::span<const VertexId> number) {
  std::vector<Value> moved(values.size());
  for_each_block(values.size(), kBlock, Progress(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) moved[number[v].index()] = values[v];
  });
  return moved;
}

// Where something is wrong it is looked for again under the ids that the user knows.
void refuse_violations(const Tin& tin, const Terrain& terrain, const Progress& progress) {
  std::vector<Violation> violations = validate(tin, terrain.continuous);
  if (violations.empty()) return;
  if (!terrain.number.empty()) {
    violations = validate(renumber(tin, terrain.number, progress).tin,
                          renumbered<Point2>(terrain.continuous, terrain.number));
  }
  throw Error(ErrorCode::InvalidTin, "the TIN breaks law " + std::to_string(violations.front().code) + ": " +
                                         violations.front().what + " (" + std::to_string(violations.size()) +
                                         " violations); nothing was written");
}

ReportFirstOrder describe_structure(const OptimizeResult& result, const LabellingConfig& labelling) {
  return {.definition = std::string(definition_name(labelling.definition)),
          .quadrilaterals = result.quadrilaterals,
          .flipped = static_cast<std::size_t>(std::count(result.flipped.begin(), result.flipped.end(), 1)),
          .fixed_by_elimination = result.fixed_by_elimination,
          .pieces = result.pieces,
          .largest_piece = result.largest_piece,
          .width = result.width};
}

std::vector<ReportCriterion> describe_criteria(const OptimizeResult& result) {
  std::vector<ReportCriterion> criteria;
  for (const CriterionResult& c : result.criteria) {
    criteria.push_back({c.name, c.unit, c.direction, c.delaunay, c.result, c.bound, c.optimal, c.method});
  }
  return criteria;
}

std::size_t peak_memory_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::size_t>(usage.ru_maxrss) * 1024;
}

}  // namespace

ReportTin describe_tin(const Tin& tin, const Plane& plane, std::span<const Point2> written) {
  const TinStatistics statistics = measure(tin, plane.scale());
  ReportTin report;
  report.vertices = tin.vertex_count();
  report.triangles = tin.triangle_count();
  report.edges = tin.edge_count();
  report.constraint_edges = tin.constraint_edges().size();
  report.hull_vertices = statistics.hull_vertices;
  report.area_m2 = statistics.area_m2;
  report.lengths = plane_lengths(tin, plane.metres_per_unit());
  if (plane.projected()) {
    const std::vector<Point2> lonlat = plane.to_lonlat(written);
    report.area_geodesic_m2 = geodesic_area_m2(lonlat, rim_loops(tin), plane.ellipsoid());
    report.lengths_geodesic = geodesic_lengths(tin, lonlat, plane.ellipsoid());
  }
  report.min_angle_deg = statistics.min_angle_deg;
  report.angle_histogram = statistics.angle_histogram;
  report.flat_triangles = statistics.flat_triangles;
  return report;
}

ReportCrs describe_plane(const Plane& plane, const CrsInfo& crs) {
  return {.wkt = crs.wkt,
          .metric_projection = plane.proj_string(),
          .horizontal_metres_per_unit = crs.horizontal_metres_per_unit,
          .vertical_metres_per_unit = crs.vertical_metres_per_unit};
}

ReportPits describe_pits(const PitSummary& pits) {
  return {.interior = pits.interior, .boundary = pits.boundary, .lake = pits.lake};
}

void note_assumptions(const CrsInfo& crs, std::span<const Point2> written, Report& report) {
  note_crs(crs, written, report.notes);
  if (crs.known && !crs.vertical_unit_told && crs.vertical_metres_per_unit != 1) {
    report.notes.emplace_back(
        "the CRS does not tell the unit of heights: that of its coordinates is assumed (" +
        std::to_string(crs.vertical_metres_per_unit) + " m)");
  }
}

namespace {

bool draws_water(const Tin& tin) {
  const std::span<const EdgeKind> kinds = tin.arrays().kinds;
  return std::any_of(kinds.begin(), kinds.end(),
                     [](EdgeKind kind) { return has(kind, EdgeKind::Valley | EdgeKind::Ridge); });
}

/// Whether drawn valleys and ridges hold, under the ids of the outputs.
Consistency consistency_of(const Tin& tin, const Terrain& terrain, const RunContext& run) {
  Consistency consistency = check_consistency(tin, run.plane.scale());
  for (Inconsistency& place : consistency.places) {
    if (terrain.number.empty()) continue;
    place.from = terrain.number[place.from.index()];
    place.to = terrain.number[place.to.index()];
  }
  return consistency;
}

/// What is told of the Delaunay triangulation next to the result. Returns its pits if a picture wants them.
std::vector<std::uint8_t> describe_delaunay(const Labelled& labelled, const Terrain& terrain,
                                            const RunContext& run, Report& report) {
  PitSummary pits;
  tbb::parallel_invoke(
      [&] { pits = find_pits(labelled.delaunay); },
      [&] { report.tin.angle_histogram_delaunay = measure_angles(labelled.delaunay, run.plane.scale()); });
  report.pits_delaunay = describe_pits(pits);
  if (draws_water(labelled.delaunay)) {
    report.consistency = {consistency_of(labelled.delaunay, terrain, run), {}};
  }
  if (run.outputs.picture.empty()) return {};
  return mark_pits(labelled.delaunay, pits.is_pit);
}

/// Flips what was chosen, and measures errors at points left out before and after. Takes the Delaunay
/// triangulation, of which none needs more then.
void flip_chosen(Labelled& labelled, const Terrain& terrain, const RunContext& run, Report& report) {
  release(labelled.quadrilaterals);
  if (run.labelling.by_faces()) return;
  const auto take = [&](FlippedTin flipped) {
    labelled.tin = std::move(flipped.tin);
    labelled.flips = std::move(flipped.diagonals);
  };
  if (!report.simplification) {
    take(flip_edges(std::move(labelled.delaunay), labelled.flips));
    return;
  }
  take(flip_edges(labelled.delaunay, labelled.flips));
  const double unit = run.plane.vertical_metres_per_unit();
  const SourceError delaunay = measure_error(labelled.delaunay, terrain.left_out);
  const SourceError result =
      measure_error(labelled.tin, relocated(terrain.left_out, labelled.delaunay, labelled.tin));
  report.simplification->barred_diagonals = labelled.barred;
  report.simplification->largest_error_m = {delaunay.largest * unit, result.largest * unit};
  report.simplification->rms_error_m = {delaunay.rms * unit, result.rms * unit};
}

void check_pit_count(const OptimizeResult& result, const PitSummary& pits) {
  for (const CriterionResult& c : result.criteria) {
    if (c.name != "local-minima" || c.result == static_cast<double>(pits.interior)) continue;
    throw Error(ErrorCode::Internal, "the optimiser counts " + std::to_string(c.result) +
                                         " pits, the TIN has " + std::to_string(pits.interior));
  }
}

/// Refuses a TIN that breaks a law, and measures it; returns its pits.
PitSummary describe_result(const Labelled& labelled, const Terrain& terrain, const RunContext& run,
                           Report& report, const Progress& progress) {
  PitSummary pits;
  ReportTin tin;
  tbb::parallel_invoke([&] { refuse_violations(labelled.tin, terrain, progress); },
                       [&] { report.digest = digest_of(labelled.tin, terrain.written); },
                       [&] { tin = describe_tin(labelled.tin, run.plane, terrain.written); },
                       [&] { pits = find_pits(labelled.tin); });
  check_pit_count(labelled.result, pits);
  tin.dropped_rim_triangles = report.tin.dropped_rim_triangles;
  tin.vertices_left_out = report.tin.vertices_left_out;
  tin.angle_histogram_delaunay = report.tin.angle_histogram_delaunay;
  tin.max_order = labelled.of_order_1.empty() && labelled.new_diagonals.empty() ? 0 : 1;
  if (labelled.higher_order) {
    tin.max_order = *std::max_element(labelled.orders.begin(), labelled.orders.end());
  }
  report.tin = tin;
  report.crs = describe_plane(run.plane, run.crs);
  report.first_order = describe_structure(labelled.result, run.labelling);
  report.higher_order = labelled.higher_order;
  report.criteria = describe_criteria(labelled.result);
  report.pits_result = describe_pits(pits);
  if (report.consistency) report.consistency->result = consistency_of(labelled.tin, terrain, run);
  return pits;
}

/// Which heights changed, under the ids of the outputs.
void describe_changes(const Labelled& labelled, const Terrain& terrain, const RunContext& run,
                      Report& report) {
  if (!labelled.conditioned) return;
  const std::span<const Point2> written =
      terrain.written.empty() ? labelled.tin.points() : std::span<const Point2>(terrain.written);
  report.conditioned = {{}, *labelled.conditioned, list_changes(labelled.changes, written, terrain.number)};
  for (const ConditionStep step : run.condition.steps) {
    report.conditioned->steps.push_back(condition_word(step));
  }
  const auto note = note_of_large_change(report.conditioned->changes, run.plane, run.drawn_valleys);
  if (note) report.notes.push_back(*note);
  const auto idle = note_of_no_valley(labelled.tin, run.condition);
  if (idle) report.notes.push_back(*idle);
}

void write_changes(const Report& report, const RunContext& run, Progress& progress) {
  write_features(run.output.changes_path, std::array{change_layer(report.conditioned->changes, run.plane)},
                 run.crs.wkt, run.outputs.pending, run.output.overwrite ? Overwrite::Yes : Overwrite::No,
                 progress);
}

// What is written, under the ids of the outputs.
struct Outcome {
  BuiltTin built;
  std::vector<std::uint8_t> pits_before;  ///< one vertex a pit of the Delaunay TIN, if a picture is wanted
  std::vector<std::array<VertexId, 2>> new_diagonals;
};

std::vector<std::uint16_t> orders_of(const Tin& tin, std::span<const HalfedgeId> new_diagonals,
                                     std::span<const Triangle> of_order_1) {
  std::vector<std::uint16_t> orders(tin.triangle_count(), 0);
  for (std::size_t t = 0; !of_order_1.empty() && t < orders.size(); ++t) {
    orders[t] = std::ranges::binary_search(of_order_1, tin.triangle(TriangleId{t})) ? 1 : 0;
  }
  for (const HalfedgeId diagonal : new_diagonals) {
    for (const HalfedgeId h : {diagonal, tin.twin(diagonal)}) orders[Tin::triangle_of(h).index()] = 1;
  }
  return orders;
}

Outcome outcome_of(Labelled labelled, Terrain terrain, std::vector<std::uint8_t> pits_before,
                   PitSummary after, const Progress& progress) {
  std::vector<std::uint16_t> orders = labelled.higher_order
                                          ? std::move(labelled.orders)
                                          : orders_of(labelled.tin, labelled.flips, labelled.of_order_1);
  Outcome outcome{.built = {.tin = std::move(labelled.tin),
                            .written = std::move(terrain.written),
                            .vertex_source = std::move(terrain.vertex_source),
                            .is_pit = std::move(after.is_pit)},
                  .pits_before = std::move(pits_before),
                  .new_diagonals = std::move(labelled.new_diagonals)};
  BuiltTin& built = outcome.built;
  labelled = Labelled();
  const std::span<const VertexId> number = terrain.number;
  if (number.empty()) {
    built.orders = std::move(orders);
    return outcome;
  }
  RenumberedTin renumbered_tin = renumber(std::move(built.tin), number, progress);
  built.tin = std::move(renumbered_tin.tin);
  built.orders.resize(orders.size());
  for_each_block(orders.size(), kBlock, progress, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) built.orders[renumbered_tin.place[t].index()] = orders[t];
  });
  built.written = renumbered<Point2>(built.written, number);
  built.vertex_source = renumbered<std::uint8_t>(built.vertex_source, number);
  if (!outcome.pits_before.empty())
    outcome.pits_before = renumbered<std::uint8_t>(outcome.pits_before, number);
  built.is_pit = renumbered<std::uint8_t>(built.is_pit, number);
  for (auto& [a, b] : outcome.new_diagonals) {
    std::tie(a, b) = std::minmax(number[a.index()], number[b.index()]);
  }
  tbb::parallel_sort(outcome.new_diagonals.begin(), outcome.new_diagonals.end());
  return outcome;
}

void write_problem(const Labelled& labelled, const RunContext& run, Progress& progress) {
  std::ofstream file(run.outputs.problem, std::ios::binary);
  dump_problem(file, labelled.delaunay, labelled.quadrilaterals, labelled.options, progress);
  file.close();
  if (!file) {
    throw Error(ErrorCode::WriteFailed,
                run.output.problem_path + " could not be written whole; is the disk full?");
  }
}

void draw_result(const Outcome& outcome, const RunContext& run, Progress& progress) {
  const std::vector<std::uint8_t> pits_after = mark_pits(outcome.built.tin, outcome.built.is_pit);
  const PictureScene scene{.tin = outcome.built.tin,
                           .horizontal_metres_per_unit = run.plane.metres_per_unit(),
                           .vertical_metres_per_unit = run.plane.vertical_metres_per_unit(),
                           .pits_before = outcome.pits_before,
                           .pits_after = pits_after,
                           .flipped = outcome.new_diagonals,
                           .title = std::filesystem::path(run.output.path).filename().string(),
                           .target = run.output.picture_path};
  draw_picture(run.outputs.picture, extension_of(run.output.picture_path), scene, progress);
}

}  // namespace

void write_tin_of(const BuiltTin& built, const OutputConfig& output, PendingOutputs& pending,
                  Progress& progress) {
  const TinView view{.tin = built.tin,
                     .written_xy = built.written,
                     .crs_wkt = built.crs.wkt,
                     .crs_authority = built.crs.authority,
                     .is_pit = built.is_pit,
                     .vertex_source = built.vertex_source,
                     .triangle_orders = built.orders,
                     .conflicts = built.report.command == "build"
                                      ? std::optional<std::span<const Conflict>>(built.report.conflicts)
                                      : std::nullopt};
  write_tin(output.path, view, {.format = output.format, .creation_options = output.creation_options},
            pending, output.overwrite ? Overwrite::Yes : Overwrite::No, progress);
}

void finish_run(Terrain terrain, const RunContext& run, BuiltTin& built, Progress& progress) {
  Report& report = built.report;
  Labelled labelled = choose_diagonals(terrain, run, report.timings_s, progress);

  progress.start_phase("check");
  if (!run.outputs.problem.empty()) write_problem(labelled, run, progress);
  std::vector<std::uint8_t> pits_before = describe_delaunay(labelled, terrain, run, report);
  progress.advance(0.2);
  flip_chosen(labelled, terrain, run, report);
  progress.advance(0.4);
  PitSummary pits = describe_result(labelled, terrain, run, report, progress);
  describe_changes(labelled, terrain, run, report);
  progress.advance(1);
  report.timings_s.check = run.watch.lap();

  progress.start_phase("write");
  Outcome outcome =
      outcome_of(std::move(labelled), std::move(terrain), std::move(pits_before), std::move(pits), progress);
  outcome.built.crs = run.crs;
  outcome.built.report = std::move(built.report);
  if (!run.output.changes_path.empty()) write_changes(outcome.built.report, run, progress);
  if (!run.output.path.empty()) write_tin_of(outcome.built, run.output, run.outputs.pending, progress);
  if (!run.outputs.picture.empty()) draw_result(outcome, run, progress);
  built = std::move(outcome.built);
  report.timings_s.write = run.watch.lap();
  report.timings_s.total = run.watch.total();
  report.peak_memory_bytes = peak_memory_bytes();
  if (!run.outputs.report.empty()) write_text(run.outputs.report, run.output.report_path, to_json(report));
  progress.advance(1);
  if (run.output.announce) run.output.announce(report);
  run.outputs.pending.commit();
}

}  // namespace thalweg
