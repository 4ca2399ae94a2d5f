// What a TIN file is: measured, checked, drawn.
#include "base/lower_case.hpp"
#include "base/printable.hpp"
#include "pipeline/digest.hpp"
#include "pipeline/lengths.hpp"
#include "pipeline/loaded_tin.hpp"
#include "pipeline/surface.hpp"

#include <thalweg/base/error.hpp>
#include <thalweg/io/picture.hpp>
#include <thalweg/io/read_tin.hpp>
#include <thalweg/pipeline/inspect.hpp>
#include <thalweg/terrain/pit_changes.hpp>
#include <thalweg/terrain/pits.hpp>
#include <thalweg/terrain/volume.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

namespace thalweg {

namespace {

nlohmann::ordered_json histogram_json(std::span<const std::size_t> bins) {
  return nlohmann::ordered_json(std::vector<std::size_t>(bins.begin(), bins.end()));
}

VolumeInfo in_metres(std::string reference, const Volumes& v, const MetricScale& scale) {
  const double area = scale.horizontal_metres_per_unit * scale.horizontal_metres_per_unit;
  const double volume = area * scale.vertical_metres_per_unit;
  return {std::move(reference), v.above * volume,    v.below * volume,
          v.area_above * area,  v.area_below * area, v.area * area};
}

// The other TIN in the plane of the first.
Tin load_into(const LoadedTin& loaded, const std::string& path, Progress& progress) {
  LoadedTin other = load_tin(path, progress);
  if (other.crs.known != loaded.crs.known ||
      (other.crs.known && !means_same_crs(other.crs.wkt, loaded.crs.wkt))) {
    const auto name = [](const CrsInfo& crs) { return crs.known ? crs.name : "unknown"; };
    throw Error(ErrorCode::BadCrs, path + " is in CRS " + name(other.crs) + ", the first TIN in " +
                                       name(loaded.crs) + "; build both in one CRS (--t-crs, --a-crs)");
  }
  if (!loaded.plane.projected()) return std::move(other.tin);
  return {loaded.plane.to_plane(other.written, progress),
          {other.tin.heights().begin(), other.tin.heights().end()},
          {other.tin.triangles().begin(), other.tin.triangles().end()},
          {}};
}

std::vector<VolumeInfo> measure_volumes(const LoadedTin& loaded, const VolumeConfig& config,
                                        Progress& progress) {
  std::vector<VolumeInfo> volumes;
  const MetricScale scale = loaded.plane.scale();
  if (config.above) {
    volumes.push_back(in_metres(fmt::format("height {}", *config.above),
                                volume_above(loaded.tin, *config.above, progress), scale));
  }
  if (!config.between.empty()) {
    const Tin base = load_into(loaded, config.between, progress);
    volumes.push_back(in_metres(config.between, volume_between(loaded.tin, base, progress), scale));
  }
  return volumes;
}

}  // namespace

TinInfo inspect_tin(const std::string& path, Progress& progress, const VolumeConfig& volumes) {
  progress.start_phase("read");
  const LoadedTin loaded = load_tin(path, progress);
  progress.start_phase("measure");
  TinInfo info;
  info.path = path;
  info.notes = loaded.notes;
  info.crs_name = loaded.crs.known ? loaded.crs.name : "";
  for (const Point2 p : loaded.written_points()) info.extent.add(loaded.plane.without_jump(p));
  info.tin = describe_tin(loaded.tin, loaded.plane, loaded.written);
  info.statistics = measure(loaded.tin, loaded.plane.scale());
  info.pits = describe_pits(find_pits(loaded.tin));
  info.volumes = measure_volumes(loaded, volumes, progress);
  info.digest = digest_of(loaded.tin, loaded.written);
  if (loaded.plane.projected()) {
    info.violations = validate(loaded.tin, loaded.plane.to_lonlat(loaded.written));
  } else {
    info.violations = validate(loaded.tin);
  }
  progress.advance(1);
  return info;
}

std::string to_json(const TinInfo& info) {
  using Json = nlohmann::ordered_json;
  Json violations = Json::array();
  for (const Violation& v : info.violations) violations.push_back({{"code", v.code}, {"what", v.what}});
  Json volumes = Json::array();
  for (const VolumeInfo& v : info.volumes) {
    volumes.push_back({{"reference", v.reference},
                       {"above_m3", v.above_m3},
                       {"below_m3", v.below_m3},
                       {"net_m3", v.above_m3 - v.below_m3},
                       {"area_above_m2", v.area_above_m2},
                       {"area_below_m2", v.area_below_m2},
                       {"area_m2", v.area_m2}});
  }
  const Json json = {
      {"path", info.path},
      {"digest", info.digest},
      {"crs", info.crs_name},
      {"extent", {info.extent.x_min, info.extent.y_min, info.extent.x_max, info.extent.y_max}},
      {"z_range", {info.statistics.z_min, info.statistics.z_max}},
      {"vertices", info.tin.vertices},
      {"triangles", info.tin.triangles},
      {"edges", info.tin.edges},
      {"constraint_edges", info.tin.constraint_edges},
      {"hull_vertices", info.tin.hull_vertices},
      {"area_m2", info.tin.area_m2},
      {"area_geodesic_m2", info.tin.area_geodesic_m2 ? Json(*info.tin.area_geodesic_m2) : Json(nullptr)},
      {"lengths_m", lengths_json(info.tin.lengths)},
      {"lengths_geodesic_m",
       info.tin.lengths_geodesic ? lengths_json(*info.tin.lengths_geodesic) : Json(nullptr)},
      {"min_angle_deg", info.tin.min_angle_deg},
      {"angle_histogram", info.tin.angle_histogram},
      {"aspect_histogram", histogram_json(info.statistics.aspect_histogram)},
      {"slope_histogram", histogram_json(info.statistics.slope_histogram)},
      {"flat_triangles", info.tin.flat_triangles},
      {"pits",
       {{"interior", info.pits.interior}, {"boundary", info.pits.boundary}, {"lake", info.pits.lake}}},
      {"volumes", volumes},
      {"valid", info.violations.empty()},
      {"violations", violations},
      {"notes", info.notes}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string to_text(const TinInfo& info) {
  std::string text;
  auto out = std::back_inserter(text);
  const auto row = [&](const std::string& name, const std::string& value) {
    fmt::format_to(out, "{:<26}{}\n", name, value);
  };
  row("TIN", info.path);
  row("CRS", info.crs_name.empty() ? "unknown" : info.crs_name);
  row("extent",
      fmt::format("{} {} {} {}", info.extent.x_min, info.extent.y_min, info.extent.x_max, info.extent.y_max));
  row("heights", fmt::format("{} .. {}", info.statistics.z_min, info.statistics.z_max));
  row("vertices", fmt::format("{}", info.tin.vertices));
  row("triangles", fmt::format("{}", info.tin.triangles));
  row("edges",
      fmt::format("{}, of which {} are constraint edges", info.tin.edges, info.tin.constraint_edges));
  row("area, m2", fmt::format("{:.1f}", info.tin.area_m2));
  if (info.tin.area_geodesic_m2)
    row("area on the ellipsoid, m2", fmt::format("{:.1f}", *info.tin.area_geodesic_m2));
  row("lengths, m", lengths_text(info.tin.lengths));
  if (info.tin.lengths_geodesic) row("on the ellipsoid, m", lengths_text(*info.tin.lengths_geodesic));
  row("pits", fmt::format("{} inside, {} on the boundary", info.pits.interior, info.pits.boundary));
  row("flat triangles", fmt::format("{}", info.tin.flat_triangles));
  row("smallest angle, degrees", fmt::format("{:.3f}", info.tin.min_angle_deg));
  const auto bins = [](std::span<const std::size_t> counts) {
    std::string line;
    for (const std::size_t count : counts) line += fmt::format("{:>9}", count);
    return line;
  };
  fmt::format_to(out, "{:<26}{}\n", "smallest angle, 10 deg bins", bins(info.tin.angle_histogram));
  fmt::format_to(out, "{:<26}{}\n", "slope, 10 degree bins", bins(info.statistics.slope_histogram));
  fmt::format_to(out, "{:<26}{}\n", "aspect N..NW, level", bins(info.statistics.aspect_histogram));
  for (const VolumeInfo& v : info.volumes) {
    row("volume to " + v.reference,
        fmt::format("{:.3f} m3 above (on {:.1f} m2), {:.3f} m3 below (on {:.1f} m2)", v.above_m3,
                    v.area_above_m2, v.below_m3, v.area_below_m2));
  }
  row("digest", info.digest);
  row("valid", info.violations.empty() ? "yes" : fmt::format("NO, {} violations", info.violations.size()));
  constexpr std::size_t kShown = 20;
  for (std::size_t i = 0; i < std::min(kShown, info.violations.size()); ++i) {
    fmt::format_to(out, "  {} {}\n", info.violations[i].code, info.violations[i].what);
  }
  for (const std::string& note : info.notes) fmt::format_to(out, "Note: {}\n", printable(note));
  return text;
}

void view_tin(const ViewConfig& config, Progress& progress) {
  PendingOutputs outputs({config.input});
  const std::string path = outputs.add(config.output, config.overwrite ? Overwrite::Yes : Overwrite::No);
  progress.start_phase("read");
  const LoadedTin loaded = load_tin(config.input, progress);
  const std::vector<std::uint8_t> pits = mark_pits(loaded.tin, find_pits(loaded.tin).is_pit);
  progress.start_phase("draw");
  const PictureScene scene{.tin = loaded.tin,
                           .horizontal_metres_per_unit = loaded.plane.metres_per_unit(),
                           .vertical_metres_per_unit = loaded.plane.vertical_metres_per_unit(),
                           .pits_before = {},
                           .pits_after = pits,
                           .flipped = {},
                           .title = std::filesystem::path(config.input).filename().string(),
                           .target = config.output,
                           .width_px = config.width_px};
  draw_picture(path, extension_of(config.output), scene, progress);
  progress.advance(1);
  outputs.commit();
}

}  // namespace thalweg
