// Variable splitting.
//
// 1. A set of variables is chosen without which the problem is narrow. Each of them is replaced, in every
//    term that has it, by a copy of its own. If copies had to agree, nothing would have changed; as they need
//    not, the minimum, found by dynamic programming, is a bound. Cuts around nodes are kept, all others are
//    left out, which also only lowers it.
// 2. The copies share the variable's cost. Any shares that add up to it give a bound; they are moved from
//    copies that have label 0 to copies that have label 1, by Polyak's step towards the known upper value,
//    halved after rounds without gain. Shares are integers of the first level and add up exactly.
// Based on: Guignard, Kim, Lagrangean decomposition, 1987; Held, Wolfe, Crowder, Validation of subgradient
// optimization, 1974; for the splitting Choi, Chavira, Darwiche, Node splitting, 2007.
#include "optimize/relaxation.hpp"

#include "optimize/piece.hpp"

#include <algorithm>
#include <cmath>

namespace thalweg {

namespace {

template <std::size_t Criteria>
class Relaxation {
 public:
  Relaxation(const Labelling<Criteria>& problem, std::uint32_t width_limit) : problem_(problem) {
    const std::vector<Label> none(problem.size(), Label::Open);
    const std::vector<Cut> cuts = failed_cuts(problem.link, problem.node_count, none);
    pairs_ = pairs_of(problem);
    tables_ = problem.tables;
    Clauses shortened = shorten<Criteria>(problem, pairs_, cuts, width_limit);
    clauses_ = std::move(shortened.clauses);
    unary_ = problem.unary.all();
    unary_.resize(shortened.variable_count);
    split(width_limit);
    order_ =
        find_elimination_order(unary_.size(), interactions(sum()), static_cast<std::uint32_t>(unary_.size()));
  }

  [[nodiscard]] std::uint64_t entries() const { return table_entries(order_); }

  Relaxed<Criteria> solve(const Progress& progress) {
    Minimum<Criteria> minimum = minimise(sum(), order_, progress);
    copy_label_ = minimum.label;
    Relaxed<Criteria> relaxed{minimum.value, std::move(minimum.label)};
    for (const Original& original : originals_) {
      const bool one = 2 * ones(original) > original.copies.size();
      relaxed.label[original.variable] = one ? Label::One : Label::Zero;
    }
    relaxed.label.resize(problem_.size());
    return relaxed;
  }

  /// Moves shares against the disagreement; false if copies agree.
  bool move_shares(double distance) {
    double norm = 0;
    for (const Original& original : originals_) {
      const auto count = static_cast<double>(original.copies.size()),
                 one = static_cast<double>(ones(original));
      norm += count * one * (count - one);
    }
    if (norm == 0) return false;
    const auto step = static_cast<std::int64_t>(std::max(1.0, std::floor(distance / norm)));
    for (const Original& original : originals_) {
      const auto count = static_cast<std::int64_t>(original.copies.size());
      const auto one = static_cast<std::int64_t>(ones(original));
      for (const std::uint32_t copy : original.copies) {
        unary_[copy].level[0] += step * ((copy_label_[copy] == Label::One ? count : 0) - one);
      }
    }
    return true;
  }

 private:
  struct Original {
    std::uint32_t variable = 0;
    std::vector<std::uint32_t> copies;
  };

  [[nodiscard]] TermSum<Criteria> sum() const { return {unary_.size(), unary_, pairs_, clauses_, &tables_}; }

  [[nodiscard]] std::size_t ones(const Original& original) const {
    return static_cast<std::size_t>(
        std::count_if(original.copies.begin(), original.copies.end(),
                      [&](std::uint32_t copy) { return copy_label_[copy] == Label::One; }));
  }

  void split(std::uint32_t width_limit) {
    const std::vector<std::uint32_t> times(unary_.size(), 0);
    const std::vector<std::uint32_t> removed =
        find_cutset(unary_.size(), interactions(sum()), width_limit, times);
    std::vector<std::uint32_t> original_of(unary_.size(), kNone);
    for (const std::uint32_t variable : removed) {
      original_of[variable] = static_cast<std::uint32_t>(originals_.size());
      originals_.push_back({variable, {}});
    }
    const auto replace = [&](std::uint32_t& variable) {
      if (variable == kNone || original_of[variable] == kNone) return;
      Original& original = originals_[original_of[variable]];
      variable = static_cast<std::uint32_t>(unary_.size());
      unary_.emplace_back();
      original_of.push_back(kNone);
      original.copies.push_back(variable);
    };
    for (PairCost<Criteria>& pair : pairs_) replace(pair.a), replace(pair.b);
    for (Clause& clause : clauses_) {
      for (Literal& literal : clause) replace(literal.variable);
    }
    for (std::size_t t = 0; t < tables_.size(); ++t) {
      for (std::size_t j = 0; j < tables_.scope(t).size(); ++j) {
        std::uint32_t variable = tables_.scope(t)[j];
        replace(variable);
        tables_.replace(t, j, variable);
      }
    }
    for (const Original& original : originals_) {
      Cost<Criteria>& whole = unary_[original.variable];
      const std::int64_t share = whole.level[0] / static_cast<std::int64_t>(original.copies.size());
      for (const std::uint32_t copy : original.copies) {
        unary_[copy].level[0] = share;
        whole.level[0] -= share;
      }
      unary_[original.copies.front()] += whole;
      whole = {};
    }
  }

  const Labelling<Criteria>& problem_;
  std::vector<Cost<Criteria>> unary_;
  std::vector<PairCost<Criteria>> pairs_;
  std::vector<Clause> clauses_;
  Tables<Criteria> tables_;
  std::vector<Original> originals_;
  EliminationOrder order_;
  std::vector<Label> copy_label_;
};

}  // namespace

template <std::size_t Criteria>
Relaxed<Criteria> relax(const Labelling<Criteria>& problem, const Cost<Criteria>& upper,
                        std::uint32_t width_limit, std::uint64_t effort, const Progress& progress) {
  constexpr double kFirstStep = 1, kSmallestStep = 1e-3;
  constexpr int kPatience = 4;
  Relaxation<Criteria> relaxation(problem, width_limit);
  Relaxed<Criteria> best = relaxation.solve(progress);
  double step = kFirstStep;
  Cost<Criteria> current = best.bound;
  for (int idle = 0; relaxation.entries() < effort && step > kSmallestStep; effort -= relaxation.entries()) {
    const auto distance = static_cast<double>(upper.level[0] - current.level[0]);
    if (!(best.bound < upper) || !relaxation.move_shares(step * distance)) break;
    Relaxed<Criteria> next = relaxation.solve(progress);
    current = next.bound;
    if (best.bound < next.bound) {
      best = std::move(next);
      idle = 0;
    } else if (++idle == kPatience) {
      idle = 0;
      step /= 2;
    }
  }
  return best;
}

template Relaxed<1> relax(const Labelling<1>&, const Cost<1>&, std::uint32_t, std::uint64_t, const Progress&);
template Relaxed<2> relax(const Labelling<2>&, const Cost<2>&, std::uint32_t, std::uint64_t, const Progress&);
template Relaxed<4> relax(const Labelling<4>&, const Cost<4>&, std::uint32_t, std::uint64_t, const Progress&);

}  // namespace thalweg
