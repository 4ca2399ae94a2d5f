// From a TIN and its quadrilaterals to a labelling problem, and back.
//
// 1. The problem is put together (first_order_problem.cpp).
// 2. Local minima first, or alone: the labellings whose links connect all they can are those with the fewest
// pits; of
//    them the one of least cost (solver.cpp).
// 3. Local minima after other criteria: solve as if they came first. If the sums that precede them are proved
//    to be no larger without links, the result is best in them, and has fewest pits of all triangulations. If
//    not, solve without links, and report the pits of that with the fewest of all as bound.
#include "optimize/first_order_problem.hpp"
#include "optimize/solver.hpp"

#include <thalweg/optimize/optimize.hpp>

#include <string>
#include <utility>

namespace thalweg {

namespace {

std::string method_name(const SolverFigures& figures) {
  std::string name = "elimination";
  if (figures.used_tables) name += " + dynamic programming";
  if (figures.used_forests) name += " + minimum spanning forest";
  if (figures.used_roof_duality) name += " + roof duality";
  if (figures.used_relaxation) name += " + variable splitting and local search";
  return name;
}

template <std::size_t Criteria>
class Run {
 public:
  Run(const Tin& tin, std::span<const Quadrilateral> quadrilaterals, const OptimizeOptions& options,
      Progress& progress)
      : criteria_(options.criteria), limits_{options.width_limit, options.effort}, progress_(progress) {
    progress_.start_phase("weigh diagonals");
    problem_ = build_problem<Criteria>(tin, quadrilaterals, options, progress);
  }

  OptimizeResult run() {
    progress_.start_phase("choose diagonals");
    choose();
    progress_.advance(1);
    return report();
  }

 private:
  void choose() {
    Labelling<Criteria>& labelling = problem_.labelling;
    labelling.link = problem_.plateaus.link;
    labelling.node_count = problem_.plateaus.node_count;
    solution_ = solve<Criteria>(labelling, problem_.rank, limits_, progress_);
    if (problem_.sums_before_pits == 0) return;
    labelling.link.clear();
    labelling.node_count = 0;
    Solution<Criteria> free = solve<Criteria>(labelling, problem_.rank, limits_, progress_);
    for (std::size_t i = 0; i < problem_.sums_before_pits; ++i) {
      if (solution_.value.level[i] != free.bound.level[i]) {
        solution_ = std::move(free);
        return;
      }
      solution_.bound.level[i] = solution_.value.level[i];
    }
  }

  [[nodiscard]] OptimizeResult report() const {
    OptimizeResult result;
    result.quadrilaterals = problem_.rank.size();
    result.flipped.reserve(problem_.rank.size());
    for (const Label label : solution_.label) result.flipped.push_back(label == Label::One ? 1 : 0);
    result.fixed_by_elimination = solution_.figures.fixed_by_elimination;
    result.pieces = solution_.figures.pieces;
    result.largest_piece = solution_.figures.largest_piece;
    result.width = solution_.figures.width;
    std::size_t level = 0;
    for (const Objective& objective : criteria_) {
      CriterionResult line;
      line.name = objective.name();
      line.unit = objective.unit();
      line.direction = objective.direction() == Direction::Minimise ? "min" : "max";
      objective.is(Criterion::LocalMinima) ? fill_pits(line) : fill_sum(line, level++);
      result.criteria.push_back(std::move(line));
    }
    return result;
  }

  void fill_pits(CriterionResult& line) const {
    const std::vector<Label> kept(problem_.rank.size(), Label::Zero), all(problem_.rank.size(), Label::Open);
    line.delaunay = static_cast<double>(count_pits(problem_.plateaus, kept));
    line.result = static_cast<double>(count_pits(problem_.plateaus, solution_.label));
    line.bound = static_cast<double>(count_pits(problem_.plateaus, all));
    line.optimal = line.result == line.bound;
    line.method = "connectivity";
  }

  /// Bounds compare lexicographically: that of a level holds if all levels before have reached theirs. If
  /// not, the bound of the first level that has not is still one for that level; nothing is known of those
  /// after it.
  void fill_sum(CriterionResult& line, std::size_t level) const {
    const WideSteps delaunay = problem_.delaunay[level];
    const double per_unit = line.direction == "max" ? -kStepsPerUnit : kStepsPerUnit;
    line.delaunay = static_cast<double>(delaunay) / per_unit;
    line.result = static_cast<double>(delaunay + solution_.value.level[level]) / per_unit;
    line.bound = static_cast<double>(delaunay + solution_.bound.level[level]) / per_unit;
    line.optimal = solution_.value.level[level] == solution_.bound.level[level];
    line.method = method_name(solution_.figures);
  }

  const std::vector<Objective>& criteria_;
  SolverLimits limits_;
  Progress& progress_;
  FirstOrderProblem<Criteria> problem_;
  Solution<Criteria> solution_;
};

}  // namespace

OptimizeResult optimize_first_order(const Tin& tin, std::span<const Quadrilateral> quadrilaterals,
                                    const OptimizeOptions& options, Progress& progress) {
  if (!options.criteria.empty()) {
    return with_levels(options.criteria, [&](auto levels) {
      return Run<levels()>(tin, quadrilaterals, options, progress).run();
    });
  }
  OptimizeResult result;
  result.quadrilaterals = quadrilaterals.size();
  result.flipped.assign(quadrilaterals.size(), 0);
  return result;
}

}  // namespace thalweg
