// Two textbook rules, nothing else.
//
// 1. Dominance: a label may be fixed if, summed over the factors that hold its variable, the worst it can
// cost
//    more than the other label is no more than nothing. (The worst of a sum is at most the sum of the worsts,
//    also in lexicographic order: costs are an ordered group.) Repeated while it finds anything.
// 2. Elimination: all factors that hold a variable become one over their other variables, with the cheaper
// label
//    for each of their labellings; always the variable with the fewest neighbours. Walked back for the
//    labels.
#include "verify/plain_solver.hpp"

#include <algorithm>
#include <deque>
#include <set>
#include <utility>

namespace thalweg::verify {

namespace {

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

std::size_t place_of(const Factor& factor, Index q) {
  return static_cast<std::size_t>(std::lower_bound(factor.scope.begin(), factor.scope.end(), q) -
                                  factor.scope.begin());
}

class Minimiser {
 public:
  Minimiser(std::size_t variables, std::vector<Factor> factors, std::size_t width_limit, Progress& progress)
      : factors_(std::move(factors)),
        of_(variables),
        fixed_(variables, kOpen),
        width_limit_(width_limit),
        progress_(progress) {
    Index number = 0;
    for (const Factor& factor : factors_) {
      if (factor.scope.empty()) constant_ = plus(constant_, factor.table.front());
      for (const Index q : factor.scope) of_[q].push_back(number);
      ++number;
    }
  }

  std::optional<PlainOptimum> run() {
    fix_dominant();
    if (!eliminate_all()) return std::nullopt;
    PlainOptimum optimum{constant_, std::vector<bool>(of_.size())};
    for (std::size_t q = 0; q < of_.size(); ++q) optimum.labels[q] = fixed_[q] == 1;
    for (auto step = steps_.rbegin(); step != steps_.rend(); ++step) {
      std::size_t index = 0;
      for (std::size_t i = 0; i < step->scope.size(); ++i) {
        index |= static_cast<std::size_t>(optimum.labels[step->scope[i]]) << i;
      }
      optimum.labels[step->variable] = step->choice[index];
    }
    return optimum;
  }

 private:
  static constexpr std::int8_t kOpen = -1;
  struct Step {
    Index variable;
    std::vector<Index> scope;
    std::vector<bool> choice;
  };

  // The most that `label` of q can cost more than the other label.
  [[nodiscard]] Cost worst(Index q, std::size_t label) const {
    Cost sum{};
    for (const Index f : of_[q]) {
      const Factor& factor = factors_[f];
      const std::size_t bit = std::size_t{1} << place_of(factor, q);
      Cost most{};
      bool first = true;
      for (std::size_t i = 0; i < factor.table.size(); ++i) {
        if ((i & bit) != 0) continue;
        const Cost difference = label == 0 ? minus(factor.table[i], factor.table[i | bit])
                                           : minus(factor.table[i | bit], factor.table[i]);
        if (first || difference > most) most = difference;
        first = false;
      }
      sum = plus(sum, most);
    }
    return sum;
  }

  void fix_dominant() {
    constexpr std::size_t kStep = 4096;
    std::deque<Index> queue;
    std::vector<bool> queued(of_.size(), true);
    for (Index q = 0; q < of_.size(); ++q) queue.push_back(q);
    for (std::size_t steps = 0; !queue.empty(); ++steps) {
      if (steps % kStep == 0) progress_.check();
      const Index q = queue.front();
      queue.pop_front();
      queued[q] = false;
      if (fixed_[q] != kOpen) continue;
      for (const std::size_t label : {std::size_t{0}, std::size_t{1}}) {
        if (worst(q, label) > Cost{}) continue;
        fix(q, label, [&](Index neighbour) {
          if (queued[neighbour]) return;
          queued[neighbour] = true;
          queue.push_back(neighbour);
        });
        break;
      }
    }
  }

  template <class Touch>
  void fix(Index q, std::size_t label, const Touch& touch) {
    fixed_[q] = static_cast<std::int8_t>(label);
    for (const Index f : of_[q]) {
      Factor& factor = factors_[f];
      const std::size_t place = place_of(factor, q), bit = std::size_t{1} << place;
      std::vector<Cost> table;
      for (std::size_t i = 0; i < factor.table.size(); ++i) {
        if (((i & bit) != 0) == (label == 1)) table.push_back(factor.table[i]);
      }
      factor.table = std::move(table);
      factor.scope.erase(factor.scope.begin() + static_cast<std::ptrdiff_t>(place));
      if (factor.scope.empty()) constant_ = plus(constant_, factor.table.front());
      for (const Index neighbour : factor.scope) touch(neighbour);
    }
    of_[q].clear();
  }

  [[nodiscard]] std::vector<Index> neighbours(Index q) const {
    std::vector<Index> all;
    for (const Index f : of_[q]) all.insert(all.end(), factors_[f].scope.begin(), factors_[f].scope.end());
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    all.erase(std::remove(all.begin(), all.end(), q), all.end());
    return all;
  }

  bool eliminate_all() {
    std::vector<std::size_t> degree(of_.size(), 0);
    std::set<std::pair<std::size_t, Index>> open;
    for (Index q = 0; q < of_.size(); ++q) {
      if (fixed_[q] != kOpen) continue;
      degree[q] = neighbours(q).size();
      open.emplace(degree[q], q);
    }
    while (!open.empty()) {
      progress_.check();
      const auto [width, q] = *open.begin();
      if (width > width_limit_) return false;
      open.erase(open.begin());
      for (const Index neighbour : eliminate(q)) {
        open.erase({degree[neighbour], neighbour});
        degree[neighbour] = neighbours(neighbour).size();
        open.emplace(degree[neighbour], neighbour);
      }
    }
    return true;
  }

  std::vector<Index> eliminate(Index q) {
    Factor joined{neighbours(q), {}};
    Step step{q, joined.scope, {}};
    const std::size_t size = std::size_t{1} << joined.scope.size();
    for (std::size_t i = 0; i < size; ++i) {
      std::array<Cost, 2> costs{};
      for (const Index f : of_[q]) {
        const Factor& factor = factors_[f];
        for (std::size_t label = 0; label < 2; ++label) {
          std::size_t index = 0;
          for (std::size_t j = 0; j < factor.scope.size(); ++j) {
            const Index v = factor.scope[j];
            const std::size_t bit = v == q ? label : i >> place_of(joined, v) & 1U;
            index |= bit << j;
          }
          costs[label] = plus(costs[label], factor.table[index]);
        }
      }
      step.choice.push_back(costs[1] < costs[0]);
      joined.table.push_back(std::min(costs[0], costs[1]));
    }
    const std::vector<Index> gone = of_[q];
    for (const Index f : gone) {
      for (const Index v : factors_[f].scope) std::erase(of_[v], f);
      factors_[f] = {};
    }
    steps_.push_back(std::move(step));
    if (joined.scope.empty()) {
      constant_ = plus(constant_, joined.table.front());
      return {};
    }
    for (const Index v : joined.scope) of_[v].push_back(static_cast<Index>(factors_.size()));
    factors_.push_back(joined);
    return joined.scope;
  }

  std::vector<Factor> factors_;
  std::vector<std::vector<Index>> of_;
  std::vector<std::int8_t> fixed_;
  std::size_t width_limit_;
  Progress& progress_;
  Cost constant_{};
  std::vector<Step> steps_;
};

}  // namespace

std::optional<PlainOptimum> minimise(std::size_t variables, std::vector<Factor> factors,
                                     std::size_t width_limit, Progress& progress) {
  return Minimiser(variables, std::move(factors), width_limit, progress).run();
}

}  // namespace thalweg::verify
