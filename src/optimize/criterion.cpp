// The table of criteria: the one place where a criterion is declared.
#include <thalweg/optimize/criterion.hpp>

#include <array>
#include <optional>
#include <span>
#include <string_view>

namespace thalweg {

namespace {

constexpr std::array<CriterionTraits, 2> kCriteria = {{
    {Criterion::LocalMinima, "local-minima", "count", Direction::Minimise, Coupling::Plateau,
     Combination::Count},
    {Criterion::NormalAngleSum, "normal-angle-sum", "radians", Direction::Minimise, Coupling::Edge,
     Combination::Sum},
}};

}  // namespace

std::span<const CriterionTraits> all_criteria() {
  return kCriteria;
}

const CriterionTraits& traits_of(Criterion criterion) {
  return kCriteria[static_cast<std::size_t>(criterion)];
}

std::optional<Criterion> find_criterion(std::string_view name) {
  for (const CriterionTraits& traits : kCriteria) {
    if (traits.name == name) return traits.criterion;
  }
  return std::nullopt;
}

}  // namespace thalweg
