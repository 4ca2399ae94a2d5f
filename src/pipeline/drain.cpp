// Hydrology of a TIN file.
//
// 1. Read, project, refuse a TIN that is not valid. Outlets go to the nearest corner of the triangle that
//    holds them.
// 2. Condition heights if asked to. Find the flow once; pits, network, catchments and paths are read off it.
// 3. Write all layers aside, then the report; rename together.
#include "base/printable.hpp"
#include "pipeline/condition_tin.hpp"
#include "pipeline/drain_layers.hpp"
#include "pipeline/flow_attributes.hpp"
#include "pipeline/outlets.hpp"
#include "pipeline/swmm.hpp"
#include "pipeline/water_json.hpp"

#include <thalweg/base/error.hpp>
#include <thalweg/io/write_tin.hpp>
#include <thalweg/pipeline/drain.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace thalweg {

namespace {

constexpr double kNetworkShare = 0.001;  // of the TIN, where no area is asked for
constexpr double kMostSeeds = 1e7;

double distance(Point2 a, Point2 b) {
  return std::hypot(a.x - b.x, a.y - b.y);
}

std::vector<VertexId> place_outlets(const LoadedTin& loaded, const std::optional<TriangleGrid>& grid,
                                    const DrainConfig& config, DrainReport& report, Progress& progress) {
  std::vector<VertexId> outlets;
  for (const Point2 given : read_places(config.outlets, loaded.crs, progress)) {
    const VertexId nearest = outlet_at(given, loaded.tin, *grid, loaded.plane);
    const Point2 p = loaded.plane.to_plane(given);
    outlets.push_back(nearest);
    report.outlets.push_back(
        {.distance_m = distance(loaded.tin.point(nearest), p) * loaded.plane.metres_per_unit()});
  }
  return outlets;
}

/// Seeds as written, and in the plane; those that were given come first.
struct Seeds {
  std::vector<std::pair<Point2, Point2>> places;
  std::size_t given = 0;
};

Seeds list_seeds(const LoadedTin& loaded, const DrainConfig& config, Progress& progress) {
  Seeds seeds;
  for (const Point2 p : read_places(config.seeds, loaded.crs, progress)) {
    seeds.places.emplace_back(p, loaded.plane.to_plane(p));
  }
  seeds.given = seeds.places.size();
  if (!config.seed_spacing_m) return seeds;
  const double spacing = *config.seed_spacing_m / loaded.plane.metres_per_unit();
  const Box2 box = bounding_box(loaded.tin.points());
  const double columns = std::ceil(box.width() / spacing), rows = std::ceil(box.height() / spacing);
  if (columns * rows > kMostSeeds) {
    throw Error(ErrorCode::SizeLimit,
                fmt::format("--seed-spacing {} gives {:.0f} seeds, more than {:.0f}; take a wider one",
                            *config.seed_spacing_m, columns * rows, kMostSeeds));
  }
  for (double row = 0; row < rows; ++row) {
    for (double column = 0; column < columns; ++column) {
      const Point2 p{box.x_min + (column + 0.5) * spacing, box.y_min + (row + 0.5) * spacing};
      seeds.places.emplace_back(loaded.plane.to_written(p), p);
    }
  }
  return seeds;
}

std::vector<SeededPath> follow_seeds(const LoadedTin& loaded, const SurfaceFlow& flow,
                                     const std::optional<TriangleGrid>& grid, const DrainConfig& config,
                                     DrainReport& report, Progress& progress) {
  const auto [places, given] = list_seeds(loaded, config, progress);
  std::vector<SeededPath> paths;
  progress.start_phase("follow paths");
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (i % 256 == 0) progress.advance(static_cast<double>(i) / static_cast<double>(places.size()));
    const auto& [written, p] = places[i];
    if (const auto t = grid->find(p)) {
      paths.push_back({written, flow.path_from(*t, p)});
    } else if (i < given) {  // a lattice over the box of a TIN leaves it at every bay
      ++report.seeds_outside;
    }
  }
  report.flow_paths = paths.size();
  if (report.seeds_outside > 0) {
    report.notes.push_back(fmt::format("{} seeds are outside of the TIN", report.seeds_outside));
  }
  progress.advance(1);
  return paths;
}

void describe(const LoadedTin& loaded, const SurfaceFlow& flow, const PitTable& table,
              const Spilling& spilling, DrainReport& report) {
  const double square = loaded.plane.metres_per_unit() * loaded.plane.metres_per_unit();
  report.vertices = loaded.tin.vertex_count();
  report.triangles = loaded.tin.triangle_count();
  std::size_t given = 0;
  for (const Sink& sink : flow.sinks()) {
    report.area_m2 += sink.area * square;
    if (sink.kind == Sink::Kind::Lake) ++report.lakes;
    if (sink.kind == Sink::Kind::Pit) ++report.interior_pits;
    const auto index = static_cast<std::size_t>(&sink - flow.sinks().data());
    if (spilling.overflow[index].valid()) ++report.pits_passed;
    const Sink::Kind end = flow.sinks()[spilling.end[index].index()].kind;
    if (end != Sink::Kind::Outlet && end != Sink::Kind::Given) continue;
    report.drained_area_m2 += sink.area * square;
    if (sink.kind == Sink::Kind::Given) ++given;
  }
  report.interior_by_depth = table.interior_by_depth;
  report.fill_volume_m3 = table.fill_volume_m3;
  report.broken_cycles = flow.broken_cycles();
  if (given < report.outlets.size())
    report.notes.emplace_back("several outlets lie at the same vertex: they are one");
  note_crs(loaded.crs, loaded.tin.points(), report.notes);
}

/// By the sink in which water ends.
std::vector<double> sum_areas(const SurfaceFlow& flow, std::span<const std::uint32_t> end_of_sink,
                              double square) {
  std::vector<double> area_m2(end_of_sink.size(), 0);
  for (std::size_t s = 0; s < area_m2.size(); ++s) area_m2[end_of_sink[s]] += flow.sinks()[s].area * square;
  return area_m2;
}

void describe_outlets(const SurfaceFlow& flow, std::span<const VertexId> outlets,
                      std::span<const double> area_m2, DrainReport& report) {
  for (std::size_t s = 0; s < area_m2.size(); ++s) {
    if (flow.sinks()[s].kind == Sink::Kind::Outlet && area_m2[s] > 0) ++report.rim_outlets;
  }
  for (std::size_t i = 0; i < outlets.size(); ++i) {
    report.outlets[i].catchment_area_m2 = area_m2[flow.sink_of(outlets[i]).index()];
  }
}

void write_model(const LoadedTin& loaded, const SwmmView& view, const DrainConfig& config,
                 DrainReport& report, PendingOutputs& outputs, Progress& progress) {
  const Overwrite mode = config.overwrite ? Overwrite::Yes : Overwrite::No;
  const SwmmFile model = write_swmm(loaded, view, progress);
  report.swmm = model.report;
  if (model.report.outfalls == 0) {
    report.notes.emplace_back(
        std::string("the model has no outfall, without which SWMM does not run: ") +
        (view.network.empty() ? "the network has no reach; see --min-area"
                              : "all of the network ends in pits; see --pass-pits, --condition, --outlets"));
  }
  write_text(outputs.add(config.swmm_path, mode), config.swmm_path, model.text);
}

std::vector<std::string> sources_of(const DrainConfig& config) {
  std::vector<std::string> sources = {config.input};
  for (const SourceSpec& outlets : config.outlets) sources.push_back(outlets.path);
  for (const SourceSpec& seeds : config.seeds) sources.push_back(seeds.path);
  return sources;
}

/// Refuses what would be refused after long work.
void plan_outputs(const DrainConfig& config, PendingOutputs& outputs, Overwrite mode) {
  check_features_path(config.output);
  outputs.plan(config.output, mode);
  if (!config.mesh_path.empty()) {
    check_mesh_path(config.mesh_path);
    outputs.plan(config.mesh_path, mode);
  }
  if (!config.swmm_path.empty()) {
    check_swmm_path(config.swmm_path);
    outputs.plan(config.swmm_path, mode);
  }
  if (config.conditioned_path.empty()) return;
  check_write_options(config.conditioned_path, {});
  outputs.plan(config.conditioned_path, mode);
}

void check_tin(const Tin& tin, const std::string& path) {
  refuse_broken(tin, path);
  if (tin.triangle_count() == 0) {
    throw Error(ErrorCode::EmptyInput, path + ": has no triangle, so no water runs; give a TIN with some");
  }
}

/// Changes heights if that is asked for. The triangles stay, so what finds them goes on to hold.
std::vector<HeightChange> condition(LoadedTin& loaded, std::span<const VertexId> outlets,
                                    const DrainConfig& config, DrainReport& report, Progress& progress) {
  if (config.condition.steps.empty()) return {};
  ConditionedTin conditioned =
      condition_tin(loaded.tin, loaded.plane.vertical_metres_per_unit(), outlets, config.condition, progress);
  loaded.tin = std::move(conditioned.tin);
  report.conditioned = conditioned.report;
  return std::move(conditioned.changes);
}

/// What was changed, as a layer; notes in the report where a height changed by much.
FeatureLayer changed_heights(const LoadedTin& loaded, std::span<const HeightChange> changes,
                             const ConditionConfig& condition, DrainReport& report) {
  const std::vector<ReportChange> list = list_changes(changes, loaded.written_points(), {});
  const auto note = note_of_large_change(list, loaded.plane, {});
  if (note) report.notes.push_back(*note);
  const auto idle = note_of_no_valley(loaded.tin, condition);
  if (idle) report.notes.push_back(*idle);
  return change_layer(list, loaded.plane);
}

}  // namespace

DrainReport drain_tin(const DrainConfig& config, Progress& progress) {
  const Overwrite mode = config.overwrite ? Overwrite::Yes : Overwrite::No;
  PendingOutputs outputs(sources_of(config));
  const bool to_file = !config.report_path.empty() && config.report_path != "-";
  const std::string report_path = to_file ? outputs.add(config.report_path, mode) : std::string();
  plan_outputs(config, outputs, mode);
  DrainReport report;
  report.input = config.input;

  progress.start_phase("read");
  LoadedTin loaded = load_tin(config.input, progress);
  report.notes = loaded.notes;
  check_tin(loaded.tin, config.input);
  std::optional<TriangleGrid> grid;
  if (!config.outlets.empty() || !config.seeds.empty() || config.seed_spacing_m) grid.emplace(loaded.tin);
  const std::vector<VertexId> outlets = place_outlets(loaded, grid, config, report, progress);
  const std::vector<HeightChange> changes = condition(loaded, outlets, config, report, progress);
  const SurfaceFlow flow(loaded.tin, outlets, progress);
  const MetricScale scale = loaded.plane.scale();
  const PitTable table = tabulate_pits(flow, scale, progress);
  const Spilling spilling = let_spill(flow, table, config.pass_pits_m);
  report.pass_pits_m = config.pass_pits_m;
  describe(loaded, flow, table, spilling, report);
  const double square = scale.horizontal_metres_per_unit * scale.horizontal_metres_per_unit;
  std::vector<std::uint32_t> end_of_sink;
  for (const SinkId end : spilling.end) end_of_sink.push_back(end.value());
  const std::vector<double> area_m2 = sum_areas(flow, end_of_sink, square);
  describe_outlets(flow, outlets, area_m2, report);
  report.consistency = check_consistency(loaded.tin, scale);

  report.min_area_m2 = config.min_area_m2.value_or(kNetworkShare * report.area_m2);
  const std::vector<Reach> network = find_network(flow, spilling, report.min_area_m2 / square, progress);
  report.reaches = network.size();
  for (const Reach& reach : network) report.strahler = std::max(report.strahler, reach.strahler);

  const std::vector<Catchment> catchments = outline_catchments(flow, end_of_sink, progress);
  report.catchments = catchments.size();
  const std::vector<SeededPath> paths = follow_seeds(loaded, flow, grid, config, report, progress);

  std::vector<FeatureLayer> layers = {
      pit_layer(loaded, table), path_layer(loaded, flow, paths), network_layer(loaded, flow, network),
      catchment_layer(loaded, flow, catchments, area_m2), inconsistency_layer(loaded, report.consistency)};
  if (report.conditioned) layers.push_back(changed_heights(loaded, changes, config.condition, report));
  write_features(config.output, layers, loaded.crs.wkt, outputs, mode, progress);
  if (!config.mesh_path.empty()) {
    write_flow_mesh(loaded, {flow, spilling, end_of_sink, table, catchments}, config, outputs, progress);
  }
  if (!config.swmm_path.empty()) {
    write_model(loaded, {flow, table, spilling, network, outlets}, config, report, outputs, progress);
  }
  if (!config.conditioned_path.empty()) write_conditioned(loaded, config, outputs, progress);
  if (to_file) write_text(report_path, config.report_path, to_json(report));
  progress.check();
  if (config.announce) config.announce(report);
  outputs.commit();
  return report;
}

std::string to_json(const DrainReport& r) {
  using Json = nlohmann::ordered_json;
  Json classes = Json::array();
  for (std::size_t i = 0; i < r.interior_by_depth.size(); ++i) {
    classes.push_back(
        {{"up_to_m", i < kDepthClassesMetres.size() ? Json(kDepthClassesMetres[i]) : Json(nullptr)},
         {"pits", r.interior_by_depth[i]}});
  }
  Json outlets = Json::array();
  for (const DrainReport::OutletPlace& outlet : r.outlets) {
    outlets.push_back({{"distance_m", outlet.distance_m}, {"catchment_area_m2", outlet.catchment_area_m2}});
  }
  Json json = {
      {"tin",
       {{"path", r.input}, {"vertices", r.vertices}, {"triangles", r.triangles}, {"area_m2", r.area_m2}}},
      {"pits",
       {{"interior", r.interior_pits},
        {"lake", r.lakes},
        {"interior_by_depth", classes},
        {"fill_volume_m3", r.fill_volume_m3}}},
      {"outlets", outlets},
      {"rim_outlets", r.rim_outlets},
      {"drained_area_m2", r.drained_area_m2},
      {"flow_paths", {{"count", r.flow_paths}, {"seeds_outside", r.seeds_outside}}},
      {"network", {{"reaches", r.reaches}, {"min_area_m2", r.min_area_m2}, {"strahler", r.strahler}}},
      {"pass_pits_m", r.pass_pits_m},
      {"pits_passed", r.pits_passed},
      {"catchments", r.catchments},
      {"broken_cycles", r.broken_cycles},
      {"consistency", consistency_json(r.consistency)},
      {"notes", r.notes}};
  if (r.conditioned) json["conditioned"] = condition_json(*r.conditioned);
  if (r.swmm) {
    json["swmm"] = {{"junctions", r.swmm->junctions},         {"outfalls", r.swmm->outfalls},
                    {"storages", r.swmm->storages},           {"conduits", r.swmm->conduits},
                    {"subcatchments", r.swmm->subcatchments}, {"area_m2", r.swmm->area_m2}};
  }
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string to_text(const DrainReport& r) {
  std::string text;
  auto out = std::back_inserter(text);
  const auto row = [&](const char* name, const std::string& value) {
    fmt::format_to(out, "{:<38}{}\n", name, value);
  };
  const Consistency& c = r.consistency;
  row("TIN", r.input);
  row("area, m2", fmt::format("{:.1f}", r.area_m2));
  if (r.conditioned) {
    row("heights changed", fmt::format("{}, by {:.2f} m together, {:.2f} m at most", r.conditioned->changed,
                                       r.conditioned->sum_m, r.conditioned->max_m));
    if (r.conditioned->left) {
      row("pits filled, breached, left",
          fmt::format("{}, {}, {} of {}", r.conditioned->filled, r.conditioned->breached,
                      *r.conditioned->left, r.conditioned->pits_before));
    }
  }
  row("pits inside", fmt::format("{}", r.interior_pits));
  if (r.lakes > 0) row("lakes", fmt::format("{}", r.lakes));
  std::string classes;
  for (std::size_t i = 0; i < r.interior_by_depth.size(); ++i) {
    classes += i < kDepthClassesMetres.size()
                   ? fmt::format("<= {}: {}  ", kDepthClassesMetres[i], r.interior_by_depth[i])
                   : fmt::format("more: {}", r.interior_by_depth[i]);
  }
  row("  by depth, m", classes);
  row("volume to fill them, m3", fmt::format("{:.1f}", r.fill_volume_m3));
  if (r.pits_passed > 0)
    row("pits that spill", fmt::format("{}, up to {} m deep", r.pits_passed, r.pass_pits_m));
  row("area that drains off, m2", fmt::format("{:.1f}", r.drained_area_m2));
  row("outlets on the rim", fmt::format("{}", r.rim_outlets));
  for (const DrainReport::OutletPlace& outlet : r.outlets) {
    row("given outlet",
        fmt::format("moved {:.2f} m, drains {:.1f} m2", outlet.distance_m, outlet.catchment_area_m2));
  }
  row("reaches of the network",
      fmt::format("{}, of {:.1f} m2 and more, Strahler order {}", r.reaches, r.min_area_m2, r.strahler));
  row("catchments", fmt::format("{}", r.catchments));
  if (r.flow_paths > 0) row("flow paths", fmt::format("{}", r.flow_paths));
  row("drawn valleys that drain, m", fmt::format("{:.1f} of {:.1f}", c.draining_length_m, c.valley_length_m));
  row("drawn valley edges that rise",
      fmt::format("{}, by {:.2f} m together, {:.2f} m at most", c.rising_edges, c.rise_sum_m, c.rise_max_m));
  row("drawn ridge edges that are crossed", fmt::format("{} of {}", c.crossed_ridge_edges, c.ridge_edges));
  row("valley edges that are not drawn", fmt::format("{}", c.undrawn_valley_edges));
  row("triangles with valley corners only", fmt::format("{}", c.triangles_on_valleys));
  row("flat triangles, flat edges", fmt::format("{}, {}", c.flat_triangles, c.flat_edges));
  if (r.swmm) {
    row("SWMM: nodes, conduits",
        fmt::format("{}, {}", r.swmm->junctions + r.swmm->outfalls + r.swmm->storages, r.swmm->conduits));
    row("  subcatchments, m2", fmt::format("{}, {:.1f}", r.swmm->subcatchments, r.swmm->area_m2));
  }
  for (const std::string& note : r.notes) fmt::format_to(out, "Note: {}\n", printable(note));
  return text;
}

}  // namespace thalweg
