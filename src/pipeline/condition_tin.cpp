// Metres to the TIN's unit and back around `condition_heights`; the triangles stay.
#include "pipeline/condition_tin.hpp"

#include "pipeline/drain_layers.hpp"

#include <thalweg/base/error.hpp>
#include <thalweg/io/write_tin.hpp>
#include <thalweg/terrain/pits.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace thalweg {

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
    steps.push_back(*step);
    begin = end + 1;
  }
  return steps;
}

ConditionedTin condition_tin(const LoadedTin& loaded, std::span<const VertexId> outlets,
                             const DrainConfig& config, Progress& progress) {
  progress.start_phase("condition heights");
  const double metres = loaded.plane.vertical_metres_per_unit();
  ConditionOptions options{.steps = config.condition, .norm = config.condition_norm, .max_change = {}};
  if (config.condition_max_m) options.max_change = *config.condition_max_m / metres;
  ConditionResult result = condition_heights(loaded.tin, outlets, options, progress);
  ConditionedTin conditioned;
  ConditionReport& report = conditioned.report;
  report = {.changed = result.changes.size(),
            .filled = result.filled,
            .breached = result.breached,
            .left = result.left,
            .pits_before = find_pits(loaded.tin).interior};
  for (const HeightChange& change : result.changes) {
    const double size = std::abs(change.after - change.before) * metres;
    report.sum_m += size;
    report.max_m = std::max(report.max_m, size);
  }
  conditioned.tin =
      Tin({loaded.tin.points().begin(), loaded.tin.points().end()}, std::move(result.heights),
          {loaded.tin.triangles().begin(), loaded.tin.triangles().end()}, loaded.tin.constraint_edges());
  conditioned.changes = std::move(result.changes);
  progress.advance(1);
  return conditioned;
}

void write_conditioned(const LoadedTin& loaded, const DrainConfig& config, PendingOutputs& outputs,
                       Progress& progress) {
  std::vector<std::uint8_t> is_pit = find_pits(loaded.tin).is_pit;
  std::replace(is_pit.begin(), is_pit.end(), static_cast<std::uint8_t>(PitKind::Boundary), std::uint8_t{0});
  const TinView view{.tin = loaded.tin,
                     .written_xy = loaded.written,
                     .crs_wkt = loaded.crs.wkt,
                     .crs_authority = loaded.crs.authority,
                     .is_pit = is_pit};
  write_tin(config.conditioned_path, view, {}, outputs, config.overwrite ? Overwrite::Yes : Overwrite::No,
            progress);
}

}  // namespace thalweg
