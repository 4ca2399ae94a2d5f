#pragma once

/// The options of the main job by name, for all faces that let users name them.

#include "pipeline/condition_options.hpp"
#include "pipeline/labelling_options.hpp"
#include "pipeline/source_options.hpp"

#include <thalweg/pipeline/build.hpp>

#include <CLI/CLI.hpp>

#include <cstddef>
#include <cstdint>

namespace thalweg::cli {

/// Values as typed.
struct BuildArguments {
  SourceArguments sources;
  LabellingArguments labelling;
  ConditionArguments condition;
  BuildConfig config;  ///< what is set at once: read, ground, snap
  double max_edge_m = 0;
  double max_error_m = 0;
  std::size_t max_points = 0;
  std::uint64_t memory_limit_bytes = 0;
};

/// Adds the options that say what is built, not where it goes: sources of lines and areas, how they are read,
/// ground, simplification, labelling, conditioning.
void add_build_options(CLI::App& command, BuildArguments& arguments);
/// The configuration but for points and output. Pre: the command has parsed. Throws: Error{Usage,
/// Unsupported}.
BuildConfig config_of(const CLI::App& command, BuildArguments arguments);

}  // namespace thalweg::cli
