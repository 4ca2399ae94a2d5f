// The definitions' names, in the order of the enumeration.
#include <thalweg/base/error.hpp>
#include <thalweg/order/definition.hpp>

#include <algorithm>
#include <string>

namespace thalweg {

namespace {

constexpr std::array<std::string_view, 8> kNames = {"std",       "pathcon",  "sees-triang", "sees-vtx",
                                                    "conf-edge", "sees-opp", "sees-3vtx",   "empty-quad"};

}  // namespace

std::string_view definition_name(OrderDefinition definition) {
  return kNames[static_cast<std::size_t>(definition)];
}

OrderDefinition parse_definition(std::string_view name) {
  const auto found = std::find(kNames.begin(), kNames.end(), name);
  if (found != kNames.end()) return kOrderDefinitions[static_cast<std::size_t>(found - kNames.begin())];
  std::string names;
  for (const std::string_view known : kNames) names += (names.empty() ? "" : ", ") + std::string(known);
  throw Error(ErrorCode::Usage, "'" + std::string(name) +
                                    "' is no definition of the constrained order; choose one of " + names);
}

}  // namespace thalweg
