#pragma once

/// Flow as values of the vertices and edges of a mesh.

#include "pipeline/drain_layers.hpp"

#include <thalweg/io/pending_outputs.hpp>
#include <thalweg/io/write_tin.hpp>
#include <thalweg/pipeline/drain.hpp>

#include <cstdint>
#include <span>

namespace thalweg {

/// What `drain` found.
struct FlowView {
  const SurfaceFlow& flow;
  const Spilling& spilling;
  std::span<const std::uint32_t> end_of_sink;  ///< by sink: the number of its catchment
  const PitTable& pits;
  std::span<const Catchment> catchments;
};

/// Refuses what cannot hold values. Throws: Error{Usage}.
void check_mesh_path(const std::string& path);

/// Writes the mesh to `config.mesh_path` aside: vertices have their catchment (of which they are in the
/// polygon: where water runs along the rim to one that is not there, that of the ground beside), the depth of
/// water on them if all pits were full, and the area upstream of the channels that end there; edges what they
/// are to water, the area upstream and the Strahler order. Throws: as write_tin. Complexity: n log n.
void write_flow_mesh(const LoadedTin& loaded, const FlowView& flow, const DrainConfig& config,
                     PendingOutputs& outputs, Progress& progress);

}  // namespace thalweg
