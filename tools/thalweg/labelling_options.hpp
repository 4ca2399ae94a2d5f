#pragma once

/// Options that `build` and `optimize` share.

#include "command.hpp"

#include <thalweg/pipeline/build.hpp>

#include <string>

namespace thalweg::cli {

/// Values as typed, before they are turned into a LabellingConfig.
struct LabellingArguments {
  std::string order = "1";
  std::string definition = "sees-opp";
  std::string optimize = "local-minima,normal-angle-sum";
  std::uint64_t effort = 0;
  std::string reference;
};

void add_labelling_options(CLI::App& command, LabellingArguments& arguments);
void add_output_options(CLI::App& command, OutputConfig& output);
/// Throws: Error{Usage} that names the option and what it takes.
LabellingConfig parse_labelling(const LabellingArguments& arguments);
/// Prints the summary that --format asks for, unless quiet; the report to stdout for `--report -`.
void print_report(const Report& report, const Common& common, const OutputConfig& output);

}  // namespace thalweg::cli
