#pragma once

/// Conditioning of a TIN in its plane.

#include "pipeline/loaded_tin.hpp"

#include <thalweg/io/pending_outputs.hpp>
#include <thalweg/io/write_features.hpp>
#include <thalweg/mesh/survey.hpp>
#include <thalweg/pipeline/build.hpp>
#include <thalweg/pipeline/condition.hpp>
#include <thalweg/pipeline/drain.hpp>

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace thalweg {

struct ConditionedTin {
  Tin tin;
  std::vector<HeightChange> changes;
  ConditionReport report;
};

/// The TIN with the heights that `config` asks for. `metres_per_unit` of heights. Pre: it asks for something.
/// Throws: Error{Cancelled}.
ConditionedTin condition_tin(const Tin& tin, double metres_per_unit, std::span<const VertexId> outlets,
                             const ConditionConfig& config, Progress& progress);

/// Refuses conditioning that what else is asked for would undo, and a layer of changes without any. Throws:
/// Error{Usage}.
void check_condition(const ConditionConfig& config, const LabellingConfig& labelling,
                     const OutputConfig& output);

/// Changes under the ids of the outputs, in their order. `written`, `number`: by vertex, its place and its id
/// there; no numbers: the same.
std::vector<ReportChange> list_changes(std::span<const HeightChange> changes, std::span<const Point2> written,
                                       std::span<const VertexId> number);
/// The valleys of a survey, if they are to be made monotone: for the note below.
Survey drawn_valleys(const Survey& survey, const ConditionConfig& config);
/// A note if valleys are to be made monotone, and none is drawn.
std::optional<std::string> note_of_no_valley(const Tin& tin, const ConditionConfig& config);
/// A note if monotone valleys took a height far from where it was, with the place: more likely a line or a
/// height is wrong. Heights in the TIN's unit. `drawn`: valleys in the plane, of which that at the place is
/// named; none: none is.
std::optional<std::string> note_of_large_change(std::span<const ReportChange> changes, const Plane& plane,
                                                const Survey& drawn);
/// Points with their new height; heights in the TIN's unit.
FeatureLayer change_layer(std::span<const ReportChange> changes, const Plane& plane);

/// Writes the TIN to `config.conditioned_path` aside. Throws: as write_tin.
void write_conditioned(const LoadedTin& loaded, const DrainConfig& config, PendingOutputs& outputs,
                       Progress& progress);

}  // namespace thalweg
