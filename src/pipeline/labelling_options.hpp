#pragma once

/// Options of what is optimised, which several commands and faces share.

#include <thalweg/pipeline/build.hpp>

#include <CLI/CLI.hpp>

#include <string>

namespace thalweg::cli {

/// Orders are written as 16-bit numbers; faces become too large long before.
constexpr unsigned kLargestOrder = 1000;

/// Values as typed, before they are turned into a LabellingConfig.
struct LabellingArguments {
  std::string order = "1";
  std::string order_max;
  std::string definition = "sees-opp";
  std::string optimize = "local-minima,normal-angle-sum";
  std::string method = "exact";
  std::uint64_t effort = 0;
  std::string reference;
};

/// The names that --definition takes, separated by commas.
std::string definition_names();
void add_labelling_options(CLI::App& command, LabellingArguments& arguments);
/// Throws (both): Error{Usage} that names the option and what it takes.
unsigned parse_order(const std::string& option, const std::string& text);
LabellingConfig parse_labelling(const LabellingArguments& arguments);

}  // namespace thalweg::cli
