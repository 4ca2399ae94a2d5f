#pragma once

/// The drainage network and the grounds along it as an input file of EPA SWMM 5.

#include "pipeline/drain_layers.hpp"

#include <thalweg/pipeline/drain.hpp>

#include <span>
#include <string>

namespace thalweg {

struct SwmmView {
  const SurfaceFlow& flow;
  const PitTable& table;
  const Spilling& spilling;
  std::span<const Reach> network;
  std::span<const VertexId> outlets;
};

struct SwmmFile {
  std::string text;
  SwmmReport report;
};

/// Refuses what does not end in .inp. Throws: Error{Usage}.
void check_swmm_path(const std::string& path);

/// Nodes are where reaches begin, meet and end. A pit at which reaches end is a storage unit, with the mean
/// area of its water and, where it spills, a conduit from its spill height to where its water goes on; other
/// ends are outfalls, one for each reach, as SWMM wants. A subcatchment is the ground that drains to a node
/// before any other. Metres, hectares, percent; coordinates as written.
/// Pre: `view` is of `loaded`. Throws: Error{Cancelled}. Complexity: as SurfaceFlow and outline_catchments.
SwmmFile write_swmm(const LoadedTin& loaded, const SwmmView& view, Progress& progress);

}  // namespace thalweg
