// Options about sources that `build` and `order` share.
#include "pipeline/source_options.hpp"

#include "pipeline/one_of.hpp"

#include <thalweg/base/error.hpp>

#include <charconv>
#include <cmath>
#include <string>
#include <vector>

namespace thalweg::cli {

namespace {

void add_lines(const std::vector<std::string>& files, EdgeKind kind, std::vector<LineSource>& lines) {
  for (const std::string& file : files) lines.push_back({parse_source(file), kind});
}

std::vector<unsigned> parse_classes(const std::vector<std::string>& lists) {
  constexpr unsigned kMost = 255;
  std::vector<unsigned> classes;
  for (const std::string& list : lists) {
    for (const std::string& word : CLI::detail::split(list, ',')) {
      unsigned value = 0;
      if (!CLI::detail::lexical_cast(word, value) || value > kMost) {
        throw CLI::ValidationError("--classes", "takes numbers from 0 to 255, as 2,9, not '" + list + "'");
      }
      classes.push_back(value);
    }
  }
  return classes;
}

}  // namespace

CLI::Validator positive_number() {
  return {[](const std::string& text) {
            double value = 0;
            const bool right = CLI::detail::lexical_cast(text, value) && std::isfinite(value) && value > 0;
            return right ? std::string() : "takes a number above 0, not '" + text + "'";
          },
          "ABOVE 0"};
}

CLI::Validator non_negative_number() {
  return {[](const std::string& text) {
            double value = 0;
            const bool right = CLI::detail::lexical_cast(text, value) && std::isfinite(value) && value >= 0;
            return right ? std::string() : "takes a number from 0 on, not '" + text + "'";
          },
          "FROM 0"};
}

Box2 parse_box(const std::string& option, const std::string& text) {
  std::vector<double> numbers;
  const char* at = text.data();
  const char* const end = at + text.size();
  while (at < end) {
    double value = 0;
    const auto [rest, error] = std::from_chars(at, end, value);
    if (error != std::errc() || !std::isfinite(value) || (rest != end && *rest != ',' && *rest != ' ')) break;
    numbers.push_back(value);
    at = rest == end ? end : rest + 1;
  }
  if (numbers.size() != 4 || at != end || !(numbers[0] <= numbers[2]) || !(numbers[1] <= numbers[3])) {
    throw Error(ErrorCode::Usage, option + " takes xmin,ymin,xmax,ymax, not '" + text + "'");
  }
  return {numbers[0], numbers[1], numbers[2], numbers[3]};
}

void add_source_options(CLI::App& command, SourceArguments& a, ReadOptions& read) {
  const auto lines = [&](const char* name, std::vector<std::string>& files, const char* what) {
    command.add_option(name, files, what)
        ->expected(1)
        ->allow_extra_args(false)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  };
  lines("--ridges", a.ridges, "ridge lines; repeatable");
  lines("--valleys", a.valleys, "valley lines; repeatable");
  lines("--breaklines", a.breaklines, "other lines that the TIN keeps; repeatable");
  lines("--boundary", a.boundary, "areas to keep; points outside are dropped; repeatable");
  lines("--holes", a.holes, "areas to cut out; repeatable");
  lines(
      "--lakes", a.lakes,
      "areas that are flat, at the z of the geometry or --line-z-field, else the lowest height of the shore; "
      "repeatable");
  command.add_option("--z-field", read.z_field, "attribute or column with the height of points");
  command.add_option("--line-z-field", read.line_z_field, "attribute with the height of lines");
  command.add_option("--kind-field", read.kind_field, "attribute that says ridge or valley");
  command.add_option("--where", read.where, "attribute filter, SQL");
  take_one_of<PositionForm>(
      command.add_option("--coords", read.coords,
                         "text: positions are dms (degrees, minutes, seconds), utm or mgrs"),
      {{"dms", PositionForm::Dms}, {"utm", PositionForm::Utm}, {"mgrs", PositionForm::Mgrs}});
  command.add_option("--geoid", read.geoid,
                     "geoid model, as egm2008-5, that heights are taken off, to be above it");
  take_one_of<HeightsAbove>(
      command.add_option("--heights-above", read.heights_above, "what heights are above before --geoid"),
      {{"ellipsoid", HeightsAbove::Ellipsoid}, {"geoid", HeightsAbove::Geoid}})
      ->default_str("ellipsoid");
  command
      .add_option_function<std::vector<std::string>>(
          "--classes",
          [&read](const std::vector<std::string>& lists) { read.classes = parse_classes(lists); },
          "LAS: classes that are points, as 2,9 (2 is ground); repeatable")
      ->expected(1)
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  take_one_of<LasReturns>(
      command.add_option("--returns", read.returns, "LAS: all, first, last returns of a pulse"),
      {{"all", LasReturns::All}, {"first", LasReturns::First}, {"last", LasReturns::Last}})
      ->default_str("all");
  command.add_option(
      "--bbox", a.bbox,
      "xmin,ymin,xmax,ymax in the CRS of the TIN: only what lies there; lines that touch it, whole");
  command.add_option("--s-crs", read.source_crs, "CRS of the sources, in place of their own (-s_srs)");
  command.add_option("--t-crs", read.target_crs, "CRS to transform to (-t_srs)");
  command.add_option("--a-crs", read.assigned_crs, "CRS to assign without transforming (-a_srs)");
  take_one_of<NodataMode>(command.add_option("--nodata", read.nodata,
                                             "nodata inside of a DEM: bridge-holes, bridge-all, bridge-none"),
                          {{"bridge-holes", NodataMode::BridgeHoles},
                           {"bridge-all", NodataMode::BridgeAll},
                           {"bridge-none", NodataMode::BridgeNone}})
      ->default_str("bridge-holes");
}

void add_crossing_option(CLI::App& command, GroundOptions& ground) {
  take_one_of<CrossingRule>(
      command.add_option("--crossing", ground.crossing, "height where lines cross, touch or overlap"),
      {{"auto", CrossingRule::Auto},
       {"error", CrossingRule::Error},
       {"lower", CrossingRule::Lower},
       {"higher", CrossingRule::Higher},
       {"mean", CrossingRule::Mean},
       {"first", CrossingRule::First},
       {"last", CrossingRule::Last}})
      ->default_str(ground.crossing == CrossingRule::Error ? "error" : "auto");
}

void require_lines_to_cross(CrossingRule crossing, CrossingRule by_default,
                            std::span<const LineSource> lines) {
  if (!lines.empty() || crossing == by_default) return;
  throw Error(ErrorCode::Usage, "--crossing is about lines (--ridges, --valleys, ...), and none are given");
}

void apply_sources(const SourceArguments& arguments, ReadOptions& read, std::vector<LineSource>& lines) {
  add_lines(arguments.ridges, EdgeKind::Ridge, lines);
  add_lines(arguments.valleys, EdgeKind::Valley, lines);
  add_lines(arguments.breaklines, EdgeKind::Breakline, lines);
  add_lines(arguments.boundary, EdgeKind::Boundary, lines);
  add_lines(arguments.holes, EdgeKind::Hole, lines);
  add_lines(arguments.lakes, EdgeKind::Lake, lines);
  if (!arguments.bbox.empty()) read.bbox = parse_box("--bbox", arguments.bbox);
  if (read.geoid.empty() && read.heights_above != HeightsAbove::Ellipsoid) {
    throw Error(ErrorCode::Usage, "--heights-above serves --geoid, the model between the two; name one");
  }
}

}  // namespace thalweg::cli
