#pragma once

/// Costs as vectors of integers, compared lexicographically: an ordered group, so that elimination, dynamic
/// programming and minimum spanning trees work on them as on numbers.

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace thalweg {

/// Levels: `Criteria` criteria by priority, then the number of flips, then the tie rule.
template <std::size_t Criteria>
struct Cost {
  static constexpr std::size_t kLevels = Criteria + 2;
  std::array<std::int64_t, kLevels> level{};

  /// Worse than every sum of costs; stays so whatever is added.
  static constexpr Cost infeasible() {
    Cost cost;
    cost.level[0] = std::numeric_limits<std::int64_t>::max();
    return cost;
  }
  [[nodiscard]] constexpr bool is_infeasible() const { return level[0] == infeasible().level[0]; }

  constexpr Cost& operator+=(const Cost& other) {
    const bool impossible = is_infeasible() || other.is_infeasible();
    for (std::size_t i = 0; i < kLevels; ++i) level[i] += impossible ? 0 : other.level[i];
    if (impossible) level[0] = infeasible().level[0];
    return *this;
  }
  /// Pre: both are feasible.
  constexpr Cost& operator-=(const Cost& other) {
    for (std::size_t i = 0; i < kLevels; ++i) level[i] -= other.level[i];
    return *this;
  }
  friend constexpr Cost operator-(Cost a, const Cost& b) { return a -= b; }
  friend constexpr bool operator==(const Cost&, const Cost&) = default;
  friend constexpr bool operator<(const Cost& a, const Cost& b) {
    for (std::size_t i = 0; i < kLevels; ++i) {
      if (a.level[i] != b.level[i]) return a.level[i] < b.level[i];
    }
    return false;
  }
};

/// What two labels 1 at neighbours cost beyond their own costs; flips and ties never couple.
template <std::size_t Criteria>
using Weight = std::array<std::int64_t, Criteria>;

template <std::size_t Criteria>
constexpr void add(Cost<Criteria>& cost, const Weight<Criteria>& weight) {
  for (std::size_t i = 0; i < Criteria; ++i) cost.level[i] += weight[i];
}

/// Without a branch.
template <std::size_t Criteria>
constexpr void add_if(Weight<Criteria>& sum, const Weight<Criteria>& weight, bool wanted) {
  for (std::size_t i = 0; i < Criteria; ++i) sum[i] += weight[i] & -static_cast<std::int64_t>(wanted);
}

/// As comparing with an empty weight, but without a call of memcmp.
template <std::size_t Criteria>
constexpr bool is_zero(const Weight<Criteria>& weight) {
  std::int64_t bits = 0;
  for (const std::int64_t value : weight) bits |= value;
  return bits == 0;
}

template <std::size_t Criteria>
constexpr bool is_negative(const Weight<Criteria>& weight) {
  return weight < Weight<Criteria>{};
}

}  // namespace thalweg
