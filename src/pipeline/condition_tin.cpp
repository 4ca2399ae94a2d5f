// Metres to the TIN's unit and back around `condition_heights`.
#include "pipeline/condition_tin.hpp"

#include "delaunay/provenance.hpp"

#include <thalweg/base/error.hpp>
#include <thalweg/io/write_tin.hpp>
#include <thalweg/terrain/pits.hpp>
#include <thalweg/terrain/surface_flow.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <string>
#include <utility>

namespace thalweg {

namespace {

double squared_distance(Point2 p, Point2 a, Point2 b) {
  const double x = b.x - a.x, y = b.y - a.y, squared = x * x + y * y;
  const double share = squared > 0 ? std::clamp(((p.x - a.x) * x + (p.y - a.y) * y) / squared, 0.0, 1.0) : 0;
  const double dx = a.x + share * x - p.x, dy = a.y + share * y - p.y;
  return dx * dx + dy * dy;
}

/// Which of the lines is nearest to the point, the first of several. Pre: there are lines.
std::size_t nearest_line(const Survey& survey, Point2 p) {
  std::size_t nearest = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t line = 0; line < survey.lines.size(); ++line) {
    const std::vector<Point2>& xy = survey.lines[line].xy;
    for (std::size_t i = 0; i + 1 < xy.size(); ++i) {
      const double distance = squared_distance(p, xy[i], xy[i + 1]);
      if (!(distance < least)) continue;
      least = distance;
      nearest = line;
    }
  }
  return nearest;
}

}  // namespace

std::string condition_word(ConditionStep step) {
  switch (step) {
    case ConditionStep::MonotoneValleys:
      return "monotone-valleys";
    case ConditionStep::Fill:
      return "fill";
    case ConditionStep::Breach:
      return "breach";
  }
  return {};
}

std::vector<ConditionStep> parse_condition(const std::string& text) {
  constexpr std::array kSteps = {ConditionStep::MonotoneValleys, ConditionStep::Fill, ConditionStep::Breach};
  std::vector<ConditionStep> steps;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const std::string word = text.substr(begin, end - begin);
    const auto* const step = std::find_if(kSteps.begin(), kSteps.end(),
                                          [&](ConditionStep known) { return condition_word(known) == word; });
    if (step == kSteps.end()) {
      throw Error(ErrorCode::Usage,
                  fmt::format("--condition '{}' is not known; give one or more of monotone-valleys, fill, "
                              "breach, separated by commas",
                              word));
    }
    if (std::find(steps.begin(), steps.end(), *step) != steps.end()) {
      throw Error(ErrorCode::Usage, "--condition names '" + word + "' twice");
    }
    steps.push_back(*step);
    begin = end + 1;
  }
  return steps;
}

namespace {

/// Interior pits, but those in which an outlet is.
std::size_t count_pits(const Tin& tin, std::span<const VertexId> outlets, Progress& progress) {
  if (outlets.empty()) return find_pits(tin).interior;
  const SurfaceFlow flow(tin, outlets, progress);
  return static_cast<std::size_t>(std::ranges::count(flow.sinks(), Sink::Kind::Pit, &Sink::kind));
}

}  // namespace

ConditionedTin condition_tin(const Tin& tin, double metres_per_unit, std::span<const VertexId> outlets,
                             const ConditionConfig& config, Progress& progress) {
  progress.start_phase("condition heights");
  ConditionOptions options{.steps = config.steps, .norm = config.norm, .max_change = {}};
  if (config.max_m) options.max_change = *config.max_m / metres_per_unit;
  ConditionResult result = condition_heights(tin, outlets, options, progress);
  ConditionedTin conditioned;
  ConditionReport& report = conditioned.report;
  report = {.changed = result.changes.size(),
            .filled = result.filled,
            .breached = result.breached,
            .left = config.changes_pits() ? std::optional(result.left) : std::nullopt,
            .pits_before = count_pits(tin, outlets, progress)};
  for (const HeightChange& change : result.changes) {
    const double size = std::abs(change.after - change.before) * metres_per_unit;
    report.sum_m += size;
    report.max_m = std::max(report.max_m, size);
  }
  conditioned.tin = tin.with_heights(std::move(result.heights));
  conditioned.changes = std::move(result.changes);
  progress.advance(1);
  return conditioned;
}

void check_condition(const ConditionConfig& config, const LabellingConfig& labelling,
                     const OutputConfig& output) {
  if (config.steps.empty() && !output.changes_path.empty()) {
    throw Error(ErrorCode::Usage, "--condition-layer needs --condition; say what to change");
  }
  if (!config.changes_pits() || labelling.criteria.empty() || labelling.criteria.front().is_of_pits()) return;
  throw Error(ErrorCode::Usage, "--condition fill or breach removes pits, which " +
                                    labelling.criteria.front().name() +
                                    " may bring back; put local-minima or pit-depth first in --optimize");
}

std::vector<ReportChange> list_changes(std::span<const HeightChange> changes, std::span<const Point2> written,
                                       std::span<const VertexId> number) {
  std::vector<ReportChange> list;
  for (const HeightChange& change : changes) {
    const VertexId v = change.vertex;
    list.push_back({.vertex = (number.empty() ? v : number[v.index()]).index(),
                    .x = written[v.index()].x,
                    .y = written[v.index()].y,
                    .before = change.before,
                    .after = change.after,
                    .step = condition_word(change.step)});
  }
  std::sort(list.begin(), list.end(),
            [](const ReportChange& a, const ReportChange& b) { return a.vertex < b.vertex; });
  return list;
}

Survey drawn_valleys(const Survey& survey, const ConditionConfig& config) {
  Survey valleys;
  if (!config.makes_valleys_monotone()) return valleys;
  valleys.sources = survey.sources;
  std::copy_if(survey.lines.begin(), survey.lines.end(), std::back_inserter(valleys.lines),
               [](const SurveyLine& line) { return has(line.kind, EdgeKind::Valley); });
  return valleys;
}

std::optional<std::string> note_of_no_valley(const Tin& tin, const ConditionConfig& config) {
  if (!config.makes_valleys_monotone()) return std::nullopt;
  for (std::size_t i = 0; i < tin.halfedge_count(); ++i) {
    if (has(tin.kind(HalfedgeId{i}), EdgeKind::Valley)) return std::nullopt;
  }
  return "the TIN has no drawn valley, so monotone-valleys changes nothing (--valleys of build draws them)";
}

std::optional<std::string> note_of_large_change(std::span<const ReportChange> changes, const Plane& plane,
                                                const Survey& drawn) {
  // More than errors of heights explain: on five DEMs, two of them from radar, 16 m is the most.
  constexpr double kLargeMetres = 20;
  const auto size = [&](const ReportChange& change) {
    const bool counts = change.step == condition_word(ConditionStep::MonotoneValleys);
    return counts ? std::abs(change.after - change.before) * plane.vertical_metres_per_unit() : 0;
  };
  const auto large = std::count_if(changes.begin(), changes.end(),
                                   [&](const ReportChange& change) { return size(change) > kLargeMetres; });
  if (large == 0) return std::nullopt;
  const ReportChange& most =
      *std::max_element(changes.begin(), changes.end(),
                        [&](const ReportChange& a, const ReportChange& b) { return size(a) < size(b); });
  const std::string line =
      drawn.lines.empty()
          ? ""
          : ", on " + describe_line(drawn, nearest_line(drawn, plane.to_plane(Point2{most.x, most.y})));
  return fmt::format(
      "monotone-valleys changes {} {} of drawn valleys by more than {} m, the largest by {:.2f} m: "
      "vertex {} at {:.10g}, {:.10g}, from {:.10g} to {:.10g}{}; if a line crosses a ridge there or a height "
      "is wrong, mend "
      "that, or limit changes with --condition-max",
      large, large == 1 ? "height" : "heights", kLargeMetres, size(most), most.vertex, most.x, most.y,
      most.before, most.after, line);
}

FeatureLayer change_layer(std::span<const ReportChange> changes, const Plane& plane) {
  FeatureLayer layer{.name = "conditioned",
                     .geometry = FeatureGeometry::Point,
                     .has_z = true,
                     .fields = {{"vertex", FieldType::Integer},
                                {"z_before", FieldType::Real},
                                {"z_after", FieldType::Real},
                                {"change_m", FieldType::Real},
                                {"step", FieldType::Text}},
                     .features = {}};
  const double metres = plane.vertical_metres_per_unit();
  for (const ReportChange& change : changes) {
    layer.features.push_back({{{{{plane.without_jump({change.x, change.y})}, {change.after}}}},
                              {static_cast<std::int64_t>(change.vertex), change.before, change.after,
                               (change.after - change.before) * metres, change.step}});
  }
  return layer;
}

void write_conditioned(const LoadedTin& loaded, const DrainConfig& config, PendingOutputs& outputs,
                       Progress& progress) {
  write_tin(config.conditioned_path, loaded.view(loaded.inner_pits()), {}, outputs,
            config.overwrite ? Overwrite::Yes : Overwrite::No, progress);
}

}  // namespace thalweg
