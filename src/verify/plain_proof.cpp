// One function a kind of step.
//
// Why the sum of what the steps leave is a bound. Cuts that hold, and spanning forests with all other links
// there, are less than the condition that everything is connected; so the least cost under them is a bound.
// Under them, a label that costs at most d more than the other one, whatever the rest, may be taken: that
// raises the least cost by at most d, which is taken off again. (Clauses are costs of the first component: if
// a label breaks one, d shows it.) Elimination leaves the least cost as it is; minima taken one by one only
// lower it. All this is of costs as a whole, compared component by component from the first: a component
// tells something only where those before are reached.
#include "verify/plain_proof.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <deque>
#include <map>
#include <stdexcept>
#include <utility>

namespace thalweg::verify {

namespace {

/// A step that cannot be taken; becomes the stage's fault.
struct Refused : std::runtime_error {
  using std::runtime_error::runtime_error;
};

class Machine {
 public:
  Machine(const ProofStage& stage, std::size_t variables, std::vector<Factor> factors,
          const PlainPlateaus* plateaus, Progress& progress)
      : stage_(stage),
        variables_(variables),
        sum_(variables, std::move(factors)),
        plateaus_(plateaus),
        progress_(progress) {
    sum_.split_loose_pairs();
  }

  Cost run() {
    for (const ProofStep& step : stage_.steps) {
      progress_.check();
      line_ = step.line;
      take(step);
    }
    finish_forests();
    return minus(sum_.bound(), lost_);
  }

  [[nodiscard]] std::size_t line() const { return line_; }

 private:
  void take(const ProofStep& step) {
    switch (step.kind) {
      case StepKind::Cut:
        return cut(literals(step));
      case StepKind::Fix:
        return fix(literals(step));
      case StepKind::Eliminate:
        for (const std::int64_t v : step.numbers) eliminate(open(v));
        return;
      case StepKind::Forest:
        return forest(step);
      case StepKind::Conflict:
        return conflict(step);
    }
  }

  Index open(std::int64_t variable) const {
    if (variable < 0 || variable >= static_cast<std::int64_t>(sum_.size())) {
      throw Refused(fmt::format("there is no variable {}", variable));
    }
    const auto v = static_cast<Index>(variable);
    if (!sum_.is_open(v)) throw Refused(fmt::format("variable {} is decided already", variable));
    return v;
  }

  std::vector<PlainLiteral> literals(const ProofStep& step) const {
    std::vector<PlainLiteral> all;
    std::vector<std::int64_t> variables;
    for (const std::int64_t number : step.numbers) {
      all.push_back({open(number / 2), number % 2 == 1});
      variables.push_back(number / 2);
    }
    std::sort(variables.begin(), variables.end());
    if (std::adjacent_find(variables.begin(), variables.end()) != variables.end()) {
      throw Refused("a variable stands twice");
    }
    return all;
  }

  static Factor clause(std::span<const PlainLiteral> any_of) {
    Factor factor;
    for (const PlainLiteral& literal : any_of) factor.scope.push_back(literal.quadrilateral);
    factor.table.resize(std::size_t{1} << any_of.size());
    std::size_t failing = 0;
    for (std::size_t i = 0; i < any_of.size(); ++i) failing |= std::size_t{any_of[i].label ? 0U : 1U} << i;
    factor.table[failing][0] = 1;
    return factor;
  }

  void cut(const std::vector<PlainLiteral>& any_of) {
    if (plateaus_ == nullptr || !plateaus_->links().is_cut(any_of))
      throw Refused("the diagonals cut nothing");
    constexpr std::size_t kShort = 3;
    if (any_of.size() == 1) {
      sum_.fix(any_of[0].quadrilateral, any_of[0].label);
      return;
    }
    if (any_of.size() <= kShort) {
      sum_.add_factor(clause(any_of));
      return;
    }
    PlainLiteral carried = any_of[0];
    for (std::size_t i = 1; i + 2 < any_of.size(); ++i) {
      const Index next = sum_.add_variable();
      sum_.add_factor(clause(std::array{carried, any_of[i], PlainLiteral{next, true}}));
      carried = {next, false};
    }
    sum_.add_factor(clause(std::array{carried, any_of[any_of.size() - 2], any_of.back()}));
  }

  /// Labels that lose nothing are taken first, as long as there are any; then the others.
  void fix(const std::vector<PlainLiteral>& wanted) {
    std::map<Index, bool> open;
    std::deque<Index> queue;
    for (const PlainLiteral& literal : wanted) {
      open[literal.quadrilateral] = literal.label;
      queue.push_back(literal.quadrilateral);
    }
    while (!queue.empty()) {
      const Index q = queue.front();
      queue.pop_front();
      const auto found = open.find(q);
      if (found == open.end() || sum_.worst(q, found->second) > Cost{}) continue;
      const bool label = found->second;
      open.erase(found);
      for (const Index neighbour : sum_.fix(q, label)) {
        if (open.contains(neighbour)) queue.push_back(neighbour);
      }
    }
    for (const auto& [q, label] : open) {
      const Cost worst = sum_.worst(q, label);
      if (worst > Cost{}) lost_ = plus(lost_, worst);
      sum_.fix(q, label);
    }
  }

  void eliminate(Index q) {
    constexpr std::size_t kWidest = 20;
    if (sum_.neighbours(q).size() > kWidest) throw Refused(fmt::format("variable {} has too many others", q));
    sum_.eliminate(q);
  }

  void forest(const ProofStep& step) {
    if (plateaus_ == nullptr) throw Refused("there are no links");
    std::vector<Index> set;
    for (const std::int64_t v : step.numbers) {
      set.push_back(open(v));
      if (set.back() >= variables_ || std::exchange(in_forest_[set.back()], true)) {
        throw Refused(fmt::format("variable {} is in two forests, or has no link", v));
      }
    }
    forests_.push_back(std::move(set));
  }

  void finish_forests() {
    if (forests_.empty()) return;
    std::vector<Cost> rise(variables_);
    for (const auto& [q, in] : in_forest_) {
      if (!sum_.is_open(q) || !sum_.neighbours(q).empty()) {
        throw Refused(fmt::format("variable {} of a forest has costs in common with others", q));
      }
      rise[q] = sum_.worst(q, true);
      sum_.eliminate(q);
    }
    lost_ = minus(lost_, plateaus_->links().least_forests(forests_, rise));
  }

  void conflict(const ProofStep& step) {
    std::vector<Index> kept;
    for (const std::int64_t v : step.numbers) kept.push_back(open(v));
    sum_.keep_only(kept);
    for (const Index v : kept) eliminate(v);
  }

  const ProofStage& stage_;
  std::size_t variables_;
  FactorSum sum_;
  const PlainPlateaus* plateaus_;
  Progress& progress_;
  std::size_t line_ = 0;
  Cost lost_{};
  std::vector<std::vector<Index>> forests_;
  std::map<Index, bool> in_forest_;
};

}  // namespace

std::optional<std::vector<PlainQuadrilateral>> in_order_of(
    const Proof& proof, const std::vector<PlainQuadrilateral>& quadrilaterals) {
  if (proof.quadrilaterals.size() != quadrilaterals.size()) return std::nullopt;
  std::map<std::pair<Index, Index>, PlainQuadrilateral> by_diagonal;
  for (const PlainQuadrilateral& q : quadrilaterals) by_diagonal[std::minmax(q.u, q.v)] = q;
  std::vector<PlainQuadrilateral> ordered;
  for (const std::vector<std::int64_t>& corners : proof.quadrilaterals) {
    if (corners.size() != 4) return std::nullopt;
    const auto corner = [&](std::size_t i) { return static_cast<Index>(corners[i]); };
    const auto found = by_diagonal.find(std::minmax(corner(1), corner(3)));
    if (found == by_diagonal.end() ||
        std::minmax(found->second.s, found->second.t) != std::minmax(corner(0), corner(2))) {
      return std::nullopt;
    }
    ordered.push_back(found->second);
    by_diagonal.erase(found);
  }
  return ordered;
}

StageBound take_steps(const ProofStage& stage, std::size_t variables, std::vector<Factor> factors,
                      const PlainPlateaus* plateaus, Progress& progress) {
  Machine machine(stage, variables, std::move(factors), plateaus, progress);
  try {
    return {machine.run(), {}};
  } catch (const Refused& refused) {
    return {{}, fmt::format("line {} of the proof: {}", machine.line(), refused.what())};
  }
}

}  // namespace thalweg::verify
