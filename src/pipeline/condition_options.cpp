// Options of what changes heights.
#include "pipeline/condition_options.hpp"

#include "pipeline/source_options.hpp"

#include <thalweg/base/error.hpp>

namespace thalweg::cli {

void add_condition_options(CLI::App& command, ConditionArguments& arguments, const std::string& when) {
  command.add_option("--condition", arguments.steps,
                     "change heights as little as possible: monotone-valleys (drawn valleys never rise "
                     "downstream), fill, breach (pits; with both the one that changes less); separated by "
                     "commas. " +
                         when);
  command
      .add_option("--condition-norm", arguments.norm, "what is least in valleys: changes, or their squares")
      ->check(CLI::IsMember({"sum", "squares"}))
      ->default_str("sum");
  command
      .add_option("--condition-max", arguments.max_m,
                  "no height changes by more, metres; what would need more is left")
      ->check(non_negative_number())
      ->default_str("none");
}

void add_condition_options(CLI::App& command, ConditionArguments& arguments) {
  add_condition_options(
      command, arguments,
      "Valleys before diagonals are chosen; pits after that, and then diagonals are chosen again");
  command
      .add_option("--outlets", arguments.outlets,
                  "points where water leaves, which --condition leaves open; repeatable")
      ->expected(1)
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

ConditionConfig parse_condition(const CLI::App& command, const ConditionArguments& arguments,
                                const std::vector<std::string>& companions) {
  ConditionConfig config;
  if (command.count("--condition") > 0) {
    config.steps = thalweg::parse_condition(arguments.steps);
  } else {
    std::vector<std::string> options = {"--condition-norm", "--condition-max"};
    options.insert(options.end(), companions.begin(), companions.end());
    for (const std::string& option : options) {
      if (command.count(option) == 0) continue;
      throw Error(ErrorCode::Usage, option + " needs --condition; say what to change");
    }
  }
  if (command.count("--condition-norm") > 0 && !config.makes_valleys_monotone()) {
    throw Error(ErrorCode::Usage,
                "--condition-norm is about monotone-valleys, which --condition does not ask for");
  }
  if (!arguments.outlets.empty() && !config.changes_pits()) {
    throw Error(ErrorCode::Usage,
                "--outlets is about pits, which --condition does not ask to fill or breach");
  }
  config.norm = arguments.norm == "sum" ? ChangeNorm::Sum : ChangeNorm::Squares;
  if (command.count("--condition-max") > 0) config.max_m = arguments.max_m;
  for (const std::string& file : arguments.outlets) config.outlets.push_back(parse_source(file));
  return config;
}

}  // namespace thalweg::cli
