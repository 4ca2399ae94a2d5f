#pragma once

/// Conditioning of a TIN that was read.

#include "pipeline/loaded_tin.hpp"

#include <thalweg/io/pending_outputs.hpp>
#include <thalweg/pipeline/drain.hpp>

#include <span>
#include <vector>

namespace thalweg {

struct ConditionedTin {
  Tin tin;
  std::vector<HeightChange> changes;
  ConditionReport report;
};

/// The TIN with the heights that `config.condition` asks for. Pre: it asks for something. Throws:
/// Error{Cancelled}.
ConditionedTin condition_tin(const LoadedTin& loaded, std::span<const VertexId> outlets,
                             const DrainConfig& config, Progress& progress);

/// Writes the TIN to `config.conditioned_path` aside. Throws: as write_tin.
void write_conditioned(const LoadedTin& loaded, const DrainConfig& config, PendingOutputs& outputs,
                       Progress& progress);

}  // namespace thalweg
