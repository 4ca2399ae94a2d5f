#pragma once

/// Options of what changes heights.

#include <thalweg/pipeline/condition.hpp>

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

namespace thalweg::cli {

/// Values as typed.
struct ConditionArguments {
  std::string steps, norm = "sum";
  double max_m = 0;
  std::vector<std::string> outlets;
};

/// The same with --outlets, for a run that chooses diagonals.
void add_condition_options(CLI::App& command, ConditionArguments& arguments);
/// Adds --condition, --condition-norm and --condition-max. `when`: what the help says of when heights
/// change.
void add_condition_options(CLI::App& command, ConditionArguments& arguments, const std::string& when);
/// Throws: Error{Usage}, also for an option that goes with --condition where that is not given; `companions`
/// are such options of the command.
ConditionConfig parse_condition(const CLI::App& command, const ConditionArguments& arguments,
                                const std::vector<std::string>& companions);

}  // namespace thalweg::cli
