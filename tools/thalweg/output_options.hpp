#pragma once

/// Where results go, for commands that make a TIN.

#include "command.hpp"

#include <thalweg/pipeline/build.hpp>

namespace thalweg::cli {

void add_output_options(CLI::App& command, OutputConfig& output);
/// Prints the summary that --format asks for, unless quiet; the report to stdout for `--report -`.
void print_report(const Report& report, const Common& common, const OutputConfig& output);

}  // namespace thalweg::cli
