// Options of what is optimised.
#include "pipeline/labelling_options.hpp"

#include <thalweg/base/error.hpp>
#include <thalweg/optimize/criterion.hpp>
#include <thalweg/order/definition.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <limits>
#include <sstream>
#include <string>

namespace thalweg::cli {

std::string definition_names() {
  std::string names;
  for (const OrderDefinition definition : kOrderDefinitions) {
    names += (names.empty() ? "" : ", ") + std::string(definition_name(definition));
  }
  return names;
}

namespace {

std::string criterion_names() {
  std::string names;
  for (const CriterionTraits& traits : all_criteria()) {
    names += (names.empty() ? "" : ", ") + std::string(traits.name);
  }
  return names;
}

}  // namespace

void add_labelling_options(CLI::App& command, LabellingArguments& arguments) {
  command
      .add_option("--order", arguments.order,
                  "largest constrained order of a triangle; 0 is the constrained Delaunay triangulation; "
                  "auto: no more than fewest pits take")
      ->capture_default_str();
  command.add_option("--order-max", arguments.order_max, "largest order with --order auto (default: 3)");
  command.add_option("--definition", arguments.definition, "which constrained order: " + definition_names())
      ->capture_default_str();
  command
      .add_option("--optimize", arguments.optimize,
                  "none, or criteria in order of priority, separated by commas: " + criterion_names() +
                      "; or weighted sums, as 2*edge-length+flat-triangles")
      ->capture_default_str();
  command
      .add_option(
          "--method", arguments.method,
          "how local-minima, the first criterion, gets few: exact; or a published heuristic, to compare "
          "with: flip, hull. These do not look at the criteria after it; bounds are those of exact")
      ->capture_default_str();
  command.add_option("--reference", arguments.reference,
                     "what vertical-error is measured against: a DEM, or points");
  command.add_option("--effort", arguments.effort, "work limit, a count (default: the optimiser's own)")
      ->check([](const std::string& text) {  // CLI11 takes -1 for the largest number
        std::uint64_t count = 0;
        const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), count);
        const bool whole = error == std::errc() && rest == text.data() + text.size();
        return whole && count > 0 ? std::string() : "'" + text + "' is not a whole number from 1 on";
      });
}

namespace {

/// The largest at which all triangulations of every face can be listed, on random points.
constexpr unsigned kDefaultLargest = 3;

std::vector<Objective> parse_criteria(const std::string& text) {
  std::vector<Objective> criteria;
  if (text == "none") return criteria;
  std::istringstream list(text);
  for (std::string name; std::getline(list, name, ',');) {
    Objective objective = parse_objective(name);
    if (std::find(criteria.begin(), criteria.end(), objective) != criteria.end()) {
      throw Error(ErrorCode::Usage, "--optimize names '" + name + "' twice");
    }
    criteria.push_back(std::move(objective));
  }
  if (criteria.empty()) throw Error(ErrorCode::Usage, "--optimize is empty; give criteria or none");
  return criteria;
}

std::optional<PitHeuristic> parse_method(const std::string& text) {
  if (text == "exact") return std::nullopt;
  if (text == "flip") return PitHeuristic::Flip;
  if (text == "hull") return PitHeuristic::Hull;
  throw Error(ErrorCode::Usage, "--method takes exact, flip or hull, not '" + text + "'");
}

/// Heuristics need pits to count, and an order that leaves a choice.
void check_heuristic(const LabellingConfig& config, const std::string& method) {
  if (!config.heuristic) return;
  if (config.criteria.empty() || !config.criteria[0].is(Criterion::LocalMinima)) {
    throw Error(ErrorCode::Usage,
                "--method " + method + ": the first criterion of --optimize must be local-minima");
  }
  if (config.least_orders || config.order == 0) {
    throw Error(ErrorCode::Usage, "--method " + method + " goes with an --order of 1 or more, not with auto");
  }
}

}  // namespace

unsigned parse_order(const std::string& option, const std::string& text) {
  unsigned order = 0;
  const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), order);
  if (error == std::errc() && rest == text.data() + text.size() && order <= kLargestOrder) return order;
  throw Error(ErrorCode::Usage,
              fmt::format("{} takes a whole number from 0 to {}, not '{}'", option, kLargestOrder, text));
}

LabellingConfig parse_labelling(const LabellingArguments& arguments) {
  LabellingConfig config;
  config.least_orders = arguments.order == "auto";
  if (config.least_orders) {
    config.order =
        arguments.order_max.empty() ? kDefaultLargest : parse_order("--order-max", arguments.order_max);
    if (config.order < 2) throw Error(ErrorCode::Usage, "--order auto needs an --order-max of 2 or more");
  } else {
    config.order = parse_order("--order", arguments.order);
    if (!arguments.order_max.empty()) {
      throw Error(ErrorCode::Usage,
                  "--order-max goes with --order auto, not with --order " + arguments.order);
    }
  }
  config.definition = parse_definition(arguments.definition);
  config.criteria = parse_criteria(arguments.optimize);
  if (config.least_orders && (config.criteria.empty() || !config.criteria[0].is(Criterion::LocalMinima))) {
    throw Error(ErrorCode::Usage, "--order auto: the first criterion of --optimize must be local-minima");
  }
  config.heuristic = parse_method(arguments.method);
  check_heuristic(config, arguments.method);
  if (arguments.effort > 0) {
    if (config.criteria.empty()) {
      throw Error(ErrorCode::Usage,
                  "--effort limits the search for the best diagonals; --optimize none has none");
    }
    if (config.order == 0) {
      throw Error(ErrorCode::Usage,
                  "--effort limits the search for the best diagonals; --order 0 leaves none");
    }
    config.effort = arguments.effort;
  }
  const auto needs_reference = [](const Objective& objective) { return objective.needs_reference(); };
  const bool needed = std::any_of(config.criteria.begin(), config.criteria.end(), needs_reference);
  if (needed == arguments.reference.empty()) {
    throw Error(ErrorCode::Usage,
                needed ? "vertical-error is measured against a DEM or points; name them with --reference"
                       : "--reference " + arguments.reference +
                             " serves vertical-error, which --optimize does not name");
  }
  if (needed) config.reference = parse_source(arguments.reference);
  return config;
}

}  // namespace thalweg::cli
