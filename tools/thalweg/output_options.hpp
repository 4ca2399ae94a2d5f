#pragma once

/// Where results go, for commands that make a TIN.

#include "command.hpp"

#include <thalweg/pipeline/build.hpp>

#include <functional>

namespace thalweg::cli {

void add_output_options(CLI::App& command, OutputConfig& output);
/// What prints the summary that --format asks for, unless quiet; the report to stdout for `--report -`.
std::function<void(const Report&)> report_printer(const Common& common, const OutputConfig& output);

}  // namespace thalweg::cli
