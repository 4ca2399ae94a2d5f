#pragma once

/// Options that take one of some names.

#include <CLI/CLI.hpp>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace thalweg::cli {

/// Lets an option take these names, in upper or lower case, and nothing else.
template <class Value>
CLI::Option* take_one_of(CLI::Option* option, const std::vector<std::pair<std::string, Value>>& values) {
  std::vector<std::string> names;
  names.reserve(values.size());
  for (const auto& [name, value] : values) names.push_back(name);
  const auto check = [names](std::string& text) {
    const std::string lower = CLI::detail::to_lower(text);
    if (std::find(names.begin(), names.end(), lower) == names.end())
      return "takes one of " + CLI::detail::join(names, ", ") + ", not '" + text + "'";
    text = lower;
    return std::string();
  };
  // What is added last sees the text first.
  option->transform(CLI::Transformer(values).description(""));
  return option->transform(CLI::Validator(check, "{" + CLI::detail::join(names, ",") + "}"));
}

}  // namespace thalweg::cli
