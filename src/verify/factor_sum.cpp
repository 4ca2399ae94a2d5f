// Tables over labels; every step is written as it is defined.
#include "verify/factor_sum.hpp"

#include <algorithm>
#include <utility>

namespace thalweg::verify {

Cost plus(const Cost& a, const Cost& b) {
  Cost sum{};
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] = a[i] + b[i];
  return sum;
}

Cost minus(const Cost& a, const Cost& b) {
  Cost difference{};
  for (std::size_t i = 0; i < difference.size(); ++i) difference[i] = a[i] - b[i];
  return difference;
}

namespace {

std::size_t place_of(const std::vector<Index>& scope, Index q) {
  return static_cast<std::size_t>(std::lower_bound(scope.begin(), scope.end(), q) - scope.begin());
}

/// The factor with its variables in ascending order.
Factor sorted(const Factor& factor) {
  Factor result{factor.scope, std::vector<Cost>(factor.table.size())};
  std::sort(result.scope.begin(), result.scope.end());
  for (std::size_t i = 0; i < factor.table.size(); ++i) {
    std::size_t index = 0;
    for (std::size_t j = 0; j < factor.scope.size(); ++j) {
      index |= (i >> j & 1U) << place_of(result.scope, factor.scope[j]);
    }
    result.table[index] = factor.table[i];
  }
  return result;
}

Factor without(const Factor& factor, std::size_t place, bool label) {
  Factor rest;
  const std::size_t bit = std::size_t{1} << place;
  for (std::size_t j = 0; j < factor.scope.size(); ++j) {
    if (j != place) rest.scope.push_back(factor.scope[j]);
  }
  for (std::size_t i = 0; i < factor.table.size(); ++i) {
    if (((i & bit) != 0) == label) rest.table.push_back(factor.table[i]);
  }
  return rest;
}

/// The factor without the variables on which it does not depend.
Factor without_idle(Factor factor) {
  for (std::size_t place = factor.scope.size(); place-- > 0;) {
    Factor off = without(factor, place, false);
    if (off.table == without(factor, place, true).table) factor = std::move(off);
  }
  return factor;
}

}  // namespace

Cost cost_of(std::span<const Factor> factors, const std::vector<bool>& labels) {
  Cost sum{};
  for (const Factor& factor : factors) {
    std::size_t at = 0;
    for (std::size_t i = 0; i < factor.scope.size(); ++i)
      at |= (labels[factor.scope[i]] ? std::size_t{1} : 0U) << i;
    sum = plus(sum, factor.table[at]);
  }
  return sum;
}

FactorSum::FactorSum(std::size_t variables, std::vector<Factor> factors)
    : of_(variables), open_(variables, true) {
  for (Factor& factor : factors) attach(without_idle(std::move(factor)));
}

void FactorSum::attach(Factor factor) {
  if (factor.scope.empty()) {
    constant_ = plus(constant_, factor.table.front());
    return;
  }
  for (const Index q : factor.scope) of_[q].push_back(static_cast<Index>(factors_.size()));
  factors_.push_back(std::move(factor));
}

void FactorSum::detach(Index factor) {
  for (const Index q : factors_[factor].scope) std::erase(of_[q], factor);
  factors_[factor] = {};
}

void FactorSum::replace(Index factor, Factor by) {
  detach(factor);
  if (by.scope.empty()) {
    constant_ = plus(constant_, by.table.front());
    return;
  }
  for (const Index q : by.scope) of_[q].push_back(factor);
  factors_[factor] = std::move(by);
}

std::vector<Index> FactorSum::neighbours(Index q) const {
  std::vector<Index> all;
  for (const Index f : of_[q]) all.insert(all.end(), factors_[f].scope.begin(), factors_[f].scope.end());
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  std::erase(all, q);
  return all;
}

Cost FactorSum::worst(Index q, bool label) const {
  Cost sum{};
  for (const Index f : of_[q]) {
    const Factor& factor = factors_[f];
    const std::size_t bit = std::size_t{1} << place_of(factor.scope, q);
    Cost most{};
    bool first = true;
    for (std::size_t i = 0; i < factor.table.size(); ++i) {
      if ((i & bit) != 0) continue;
      const Cost rise = minus(factor.table[i | bit], factor.table[i]);
      const Cost difference = label ? rise : minus(Cost{}, rise);
      if (first || difference > most) most = difference;
      first = false;
    }
    sum = plus(sum, most);
  }
  return sum;
}

std::vector<Index> FactorSum::fix(Index q, bool label) {
  std::vector<Index> touched = neighbours(q);
  const std::vector<Index> own = of_[q];
  for (const Index f : own) {
    replace(f, without_idle(without(factors_[f], place_of(factors_[f].scope, q), label)));
  }
  open_[q] = false;
  return touched;
}

Elimination FactorSum::eliminate(Index q) {
  Factor joined{neighbours(q), {}};
  Elimination step{q, joined.scope, {}};
  const std::size_t size = std::size_t{1} << joined.scope.size();
  for (std::size_t i = 0; i < size; ++i) {
    std::array<Cost, 2> costs{};
    for (const Index f : of_[q]) {
      const Factor& factor = factors_[f];
      for (std::size_t label = 0; label < 2; ++label) {
        std::size_t index = 0;
        for (std::size_t j = 0; j < factor.scope.size(); ++j) {
          const Index v = factor.scope[j];
          index |= (v == q ? label : i >> place_of(joined.scope, v) & 1U) << j;
        }
        costs[label] = plus(costs[label], factor.table[index]);
      }
    }
    step.choice.push_back(costs[1] < costs[0]);
    joined.table.push_back(std::min(costs[0], costs[1]));
  }
  const std::vector<Index> gone = of_[q];
  for (const Index f : gone) detach(f);
  attach(std::move(joined));
  open_[q] = false;
  return step;
}

Index FactorSum::add_variable() {
  of_.emplace_back();
  open_.push_back(true);
  return static_cast<Index>(of_.size() - 1);
}

void FactorSum::add_factor(const Factor& factor) {
  attach(sorted(factor));
}

void FactorSum::add_cost(Index q, const Cost& cost) {
  attach({{q}, {Cost{}, cost}});
}

Cost FactorSum::cost_of_both(const Factor& pair) {
  return minus(plus(pair.table[3], pair.table[0]), plus(pair.table[1], pair.table[2]));
}

void FactorSum::split_pair(Index f) {
  const Factor pair = factors_[f];
  const Cost of_both = cost_of_both(pair);
  constant_ = plus(constant_, pair.table[0]);
  factors_[f].table = {Cost{}, Cost{}, Cost{}, of_both};
  if (of_both == Cost{}) detach(f);
  add_cost(pair.scope[0], minus(pair.table[1], pair.table[0]));
  add_cost(pair.scope[1], minus(pair.table[2], pair.table[0]));
}

void FactorSum::split_loose_pairs() {
  const auto count = static_cast<Index>(factors_.size());
  for (Index f = 0; f < count; ++f) {
    if (factors_[f].scope.size() == 2 && cost_of_both(factors_[f]) == Cost{}) split_pair(f);
  }
}

void FactorSum::keep_only(std::span<const Index> kept) {
  std::vector<bool> inside(of_.size(), false);
  for (const Index q : kept) inside[q] = true;
  for (Index f = 0; f < factors_.size(); ++f) {
    const Factor& factor = factors_[f];
    if (factor.scope.empty()) continue;
    if (std::all_of(factor.scope.begin(), factor.scope.end(), [&](Index q) { return inside[q]; })) continue;
    constant_ = plus(constant_, *std::min_element(factor.table.begin(), factor.table.end()));
    detach(f);
  }
}

Cost FactorSum::bound() const {
  Cost sum = constant_;
  for (const Factor& factor : factors_) {
    if (!factor.scope.empty()) sum = plus(sum, *std::min_element(factor.table.begin(), factor.table.end()));
  }
  return sum;
}

}  // namespace thalweg::verify
