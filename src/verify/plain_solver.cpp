// Two textbook rules, nothing else.
//
// 1. Dominance: a label may be fixed if, summed over the factors that hold its variable, the worst it can
//    cost more than the other label is no more than nothing. (The worst of a sum is at most the sum of the
//    worsts, also in lexicographic order: costs are an ordered group.) Repeated while it finds anything.
// 2. Elimination: all factors that hold a variable become one over their other variables, with the cheaper
//    label for each of their labellings; always the variable with the fewest neighbours. Walked back for the
//    labels.
#include "verify/plain_solver.hpp"

#include <algorithm>
#include <deque>
#include <set>
#include <utility>

namespace thalweg::verify {

namespace {

/// Of all tables that are made: of 48 bytes each, so that no problem takes more than 1.6 GB.
constexpr std::size_t kMostEntries = std::size_t{1} << 25U;

class Minimiser {
 public:
  Minimiser(std::size_t variables, std::vector<Factor> factors, std::size_t width_limit, Progress& progress)
      : sum_(variables, std::move(factors)),
        label_(variables, false),
        width_limit_(width_limit),
        progress_(progress) {}

  std::optional<PlainOptimum> run() {
    fix_dominant();
    if (!eliminate_all()) return std::nullopt;
    std::for_each(steps_.rbegin(), steps_.rend(), [&](const auto& step) {
      std::size_t index = 0;
      for (std::size_t i = 0; i < step.scope.size(); ++i) {
        index |= static_cast<std::size_t>(label_[step.scope[i]]) << i;
      }
      label_[step.variable] = step.choice[index];
    });
    return PlainOptimum{sum_.constant(), std::move(label_)};
  }

 private:
  void fix_dominant() {
    constexpr std::size_t kStep = 4096;
    std::deque<Index> queue;
    std::vector<bool> queued(sum_.size(), true);
    for (Index q = 0; q < sum_.size(); ++q) queue.push_back(q);
    for (std::size_t steps = 0; !queue.empty(); ++steps) {
      if (steps % kStep == 0) progress_.check();
      const Index q = queue.front();
      queue.pop_front();
      queued[q] = false;
      if (!sum_.is_open(q)) continue;
      for (const bool label : {false, true}) {
        if (sum_.worst(q, label) > Cost{}) continue;
        label_[q] = label;
        for (const Index neighbour : sum_.fix(q, label)) {
          if (queued[neighbour]) continue;
          queued[neighbour] = true;
          queue.push_back(neighbour);
        }
        break;
      }
    }
  }

  bool eliminate_all() {
    std::vector<std::size_t> degree(sum_.size(), 0);
    std::set<std::pair<std::size_t, Index>> open;
    for (Index q = 0; q < sum_.size(); ++q) {
      if (!sum_.is_open(q)) continue;
      degree[q] = sum_.neighbours(q).size();
      open.emplace(degree[q], q);
    }
    std::size_t entries = 0;
    while (!open.empty()) {
      progress_.check();
      const auto [width, q] = *open.begin();
      entries += std::size_t{1} << std::min(width, width_limit_);
      if (width > width_limit_ || entries > kMostEntries) return false;
      open.erase(open.begin());
      steps_.push_back(sum_.eliminate(q));
      for (const Index neighbour : steps_.back().scope) {
        open.erase({degree[neighbour], neighbour});
        degree[neighbour] = sum_.neighbours(neighbour).size();
        open.emplace(degree[neighbour], neighbour);
      }
    }
    return true;
  }

  FactorSum sum_;
  std::vector<bool> label_;
  std::size_t width_limit_;
  Progress& progress_;
  std::vector<Elimination> steps_;
};

}  // namespace

std::optional<PlainOptimum> minimise(std::size_t variables, std::vector<Factor> factors,
                                     std::size_t width_limit, Progress& progress) {
  return Minimiser(variables, std::move(factors), width_limit, progress).run();
}

}  // namespace thalweg::verify
