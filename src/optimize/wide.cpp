// Between a labelling and a bound.
//
// 1. Start: of labels 0 throughout, which are the best where nothing is gained, those of a relaxation
//    (relaxation.cpp), and those known before, the ones that cost least; where labels fail a cut, all links
//    of that cut are chosen.
// 2. Improve: keep the labels of a set of variables without which the problem is narrow, and find the best
//    labels of all others together, exactly. The variables that were kept least often are kept next, so that
//    each becomes free. Until several sets in a row bring nothing.
// 3. Raise the bound of the relaxation towards the value reached.
// A third of the effort goes to 2, the rest to 3; tables are narrower than allowed where that buys enough
// rounds. Once value and bound meet, nothing more is done.
#include "optimize/wide.hpp"

#include "optimize/piece.hpp"
#include "optimize/relaxation.hpp"

#include <algorithm>

namespace thalweg {

namespace {

constexpr std::uint64_t kRounds = 64;  // for which the effort shall suffice
constexpr int kPatience = 8;

template <std::size_t Criteria>
class Improver {
 public:
  Improver(const Labelling<Criteria>& problem, std::uint32_t width_limit, const Progress& progress)
      : problem_(problem), width_limit_(width_limit), progress_(progress), times_(problem.size(), 0) {
    const std::vector<PairCost<Criteria>> pairs = pairs_of(problem);
    const std::vector<Cost<Criteria>> unary = problem.unary.all();
    edges_ = interactions(TermSum<Criteria>{problem.size(), unary, pairs, {}, &problem.tables});
  }

  /// Pre: `label` connects what can be connected.
  Solution<Criteria> run(std::vector<Label>&& label, std::uint64_t effort) {
    Solution<Criteria> best;
    best.label = std::move(label);
    best.value = cost_of<Criteria>(problem_, best.label);
    for (int idle = 0; idle < kPatience && best.figures.table_entries < effort; ++idle) {
      Solution<Criteria> next = improve(best.label);
      next.figures.table_entries += best.figures.table_entries;
      if (next.value < best.value) {
        best = std::move(next);
        idle = -1;
      } else {
        best.figures.table_entries = next.figures.table_entries;
      }
    }
    return best;
  }

 private:
  Solution<Criteria> improve(const std::vector<Label>& start) {
    std::vector<Label> label(problem_.size(), Label::Open);
    for (const std::uint32_t q : find_cutset(problem_.size(), edges_, width_limit_, times_)) {
      label[q] = start[q];
      ++times_[q];
    }
    std::vector<std::uint32_t> open;
    for (std::uint32_t q = 0; q < label.size(); ++q) {
      if (label[q] == Label::Open) open.push_back(q);
    }
    const Labelling<Criteria> part = fix_labels<Criteria>(problem_, label, open);
    // Cuts can make a piece wider than the set promised; it keeps its labels, which connect it.
    const WideSolver<Criteria> keep = [&](const Labelling<Criteria>& piece,
                                          std::span<const std::uint32_t> variables) {
      Solution<Criteria> kept;
      for (const std::uint32_t i : variables) kept.label.push_back(start[open[i]]);
      kept.figures.table_entries = piece.size();
      return kept;
    };
    Solution<Criteria> solution = decompose<Criteria>(part, width_limit_, keep, progress_);
    for (std::size_t i = 0; i < open.size(); ++i) label[open[i]] = solution.label[i];
    solution.value = cost_of<Criteria>(problem_, label);
    solution.label = std::move(label);
    solution.figures.table_entries += problem_.size();
    return solution;
  }

  const Labelling<Criteria>& problem_;
  std::uint32_t width_limit_;
  const Progress& progress_;
  std::vector<NodePair> edges_;
  std::vector<std::uint32_t> times_;  ///< by variable: how often it was kept
};

/// The labelling with all links chosen of the cuts that it fails.
template <std::size_t Criteria>
std::vector<Label> connected(const Labelling<Criteria>& problem, std::vector<Label>&& label) {
  for (const Cut& cut : failed_cuts(problem.link, problem.node_count, label)) {
    for (const Literal& literal : cut) label[literal.variable] = literal.label;
  }
  return std::move(label);
}

}  // namespace

template <std::size_t Criteria>
std::int64_t least_of_level(const Labelling<Criteria>& problem, std::size_t level) {
  std::int64_t sum = 0;
  for (std::size_t q = 0; q < problem.size(); ++q) {
    sum += std::min<std::int64_t>(problem.unary[q].level[level], 0);
  }
  if (level >= Criteria) return sum;
  for (const PairCost<Criteria>& pair : pairs_of(problem))
    sum += std::min<std::int64_t>(pair.weight[level], 0);
  for (std::size_t t = 0; t < problem.tables.size(); ++t) {
    std::int64_t least = problem.tables.entries(t).front()[level];
    for (const Weight<Criteria>& entry : problem.tables.entries(t)) least = std::min(least, entry[level]);
    sum += least;
  }
  return sum;
}

template <std::size_t Criteria>
Solution<Criteria> bracket(const Labelling<Criteria>& problem, std::span<const Label> known,
                           std::int64_t first_level_bound, std::uint32_t width_limit, std::uint64_t effort,
                           const Progress& progress) {
  std::uint32_t width = width_limit;
  while (width > 1 && (problem.size() << width) > effort / kRounds) --width;
  Cost<Criteria> bound;
  bound.level[0] = first_level_bound;
  for (std::size_t l = 1; l < Cost<Criteria>::kLevels; ++l) bound.level[l] = least_of_level(problem, l);
  Solution<Criteria> solution;
  solution.label = connected(problem, std::vector<Label>(problem.size(), Label::Zero));
  solution.value = cost_of<Criteria>(problem, solution.label);
  const auto start_with = [&](std::vector<Label>&& label) {
    const Cost<Criteria> value = cost_of<Criteria>(problem, label);
    if (value < solution.value) solution = {std::move(label), value, {}, {}};
  };
  if (bound < solution.value) {
    Relaxed<Criteria> relaxed = relax(problem, Cost<Criteria>::infeasible(), width, 0, progress);
    bound = std::max(bound, relaxed.bound);
    start_with(connected(problem, std::move(relaxed.label)));
    if (!known.empty()) start_with(connected(problem, {known.begin(), known.end()}));
  }
  if (bound < solution.value) {
    solution = Improver<Criteria>(problem, width, progress).run(std::move(solution.label), effort / 3);
  }
  // Of flips and ties no bound is asked for.
  const bool proved = Criteria == 1 && bound.level[0] == solution.value.level[0];
  if (!proved && bound < solution.value) {
    bound = std::max(bound, relax(problem, solution.value, width, effort - effort / 3, progress).bound);
  }
  solution.bound = bound;
  const std::uint64_t entries = solution.figures.table_entries;
  solution.figures = {};
  solution.figures.width = width;
  solution.figures.table_entries = entries;
  solution.figures.used_relaxation = true;
  return solution;
}

template std::int64_t least_of_level(const Labelling<1>&, std::size_t);
template Solution<1> bracket(const Labelling<1>&, std::span<const Label>, std::int64_t, std::uint32_t,
                             std::uint64_t, const Progress&);
template std::int64_t least_of_level(const Labelling<2>&, std::size_t);
template Solution<2> bracket(const Labelling<2>&, std::span<const Label>, std::int64_t, std::uint32_t,
                             std::uint64_t, const Progress&);
template std::int64_t least_of_level(const Labelling<4>&, std::size_t);
template Solution<4> bracket(const Labelling<4>&, std::span<const Label>, std::int64_t, std::uint32_t,
                             std::uint64_t, const Progress&);

}  // namespace thalweg
