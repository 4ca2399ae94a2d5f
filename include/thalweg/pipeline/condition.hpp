#pragma once

/// What of a run changes heights, only on request.

#include <thalweg/io/source.hpp>
#include <thalweg/terrain/condition.hpp>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace thalweg {

struct ConditionConfig {
  std::vector<ConditionStep> steps;  ///< none: no height changes
  ChangeNorm norm = ChangeNorm::Sum;
  std::optional<double> max_m;  ///< no height changes by more
  std::vector<SourceSpec>
      outlets;  ///< of build and optimize: points where water leaves, so that no pit is removed

  [[nodiscard]] bool changes_pits() const {
    return std::any_of(steps.begin(), steps.end(),
                       [](ConditionStep step) { return step != ConditionStep::MonotoneValleys; });
  }
  [[nodiscard]] bool makes_valleys_monotone() const {
    return std::find(steps.begin(), steps.end(), ConditionStep::MonotoneValleys) != steps.end();
  }
};

/// What conditioning changed.
struct ConditionReport {
  std::size_t changed = 0;
  double sum_m = 0;  ///< of the sizes of the changes
  double max_m = 0;
  std::size_t filled = 0;  ///< pits
  std::size_t breached = 0;
  std::optional<std::size_t> left;  ///< of pits that were to be filled or breached
  std::size_t pits_before = 0;      ///< interior ones without an outlet, of the TIN whose heights change
};

/// Reads one or more of monotone-valleys, fill, breach, separated by commas. Throws: Error{Usage}.
std::vector<ConditionStep> parse_condition(const std::string& text);
/// The word for a step, as on the command line.
std::string condition_word(ConditionStep step);

}  // namespace thalweg
