// From a TIN and its quadrilaterals to a labelling problem, and back.
//
// 1. The problem is put together (first_order_problem.cpp).
// 2. Local minima or depth of pits first, or alone: the labellings whose links connect all they can are those
//    with the fewest, or least deep, pits; of them the one of least cost (solver.cpp).
// 3. An objective that is the worst of its terms: what matters is that no term is beyond the least limit that
//    leaves the criteria before it at their best. Its level counts the terms beyond a limit; the least limit
//    with none is found by bisection among the values of terms, each step a solution of levels up to this
//    one. Below it the next criterion decides; if none is named, the sum of normal angles. Of vertices only
//    those are counted at which labels were found to be beyond the limit, more and more of them: the others
//    keep it by themselves, and would only tie everything to everything.
// 4. Either after other criteria: a level that counts pits, at first too few (pit_terms.cpp); it is refined
//    until it counts those of the solution right, and all that depends on it is done again.
// 5. What is reported of a criterion after one that is not proved optimal is no more than what no labels
// beat.
#include "base/release.hpp"
#include "optimize/conflict.hpp"
#include "optimize/declaration.hpp"
#include "optimize/first_order_problem.hpp"
#include "optimize/piece.hpp"
#include "optimize/pit_terms.hpp"
#include "optimize/proof_steps.hpp"
#include "optimize/solver.hpp"
#include "optimize/spills.hpp"
#include "optimize/wide.hpp"

#include <thalweg/optimize/optimize.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

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
  /// `reported` are those of the options' criteria that were asked for.
  Run(const Tin& tin, std::span<const Quadrilateral> quadrilaterals, const OptimizeOptions& options,
      std::size_t reported, Progress& progress)
      : criteria_(std::span(options.criteria).first(reported)),
        completed_(reported < options.criteria.size()),
        limits_{options.width_limit, options.effort},
        proof_(options.proof),
        vertical_metres_(options.vertical_metres_per_unit),
        progress_(progress),
        problem_(begin(tin, quadrilaterals, options, progress)),
        scan_(tin, quadrilaterals, problem_.owner,
              {options.horizontal_metres_per_unit, options.vertical_metres_per_unit}, options.reference,
              most_at_vertex(options.width_limit)) {}

  OptimizeResult run() {
    progress_.start_phase("choose diagonals");
    choose();
    progress_.advance(1);
    return report();
  }

 private:
  static FirstOrderProblem<Criteria> begin(const Tin& tin, std::span<const Quadrilateral> quadrilaterals,
                                           const OptimizeOptions& options, Progress& progress) {
    progress.start_phase("weigh diagonals");
    auto problem = build_problem<Criteria>(tin, quadrilaterals, options, progress);
    // Where sums are all that counts, their terms are in place: nobody asks for owners again.
    if (std::ranges::all_of(problem.sums, is_plain_sum)) release(problem.owner);
    return problem;
  }

  static bool is_plain_sum(const Objective& objective) {
    const auto of_vertices = [](const Objective::Part& part) {
      return declaration_of(part.criterion).vertex != nullptr;
    };
    return !objective.is_extreme() && !objective.is_of_pits() &&
           std::ranges::none_of(objective.parts, of_vertices);
  }

  /// Levels up to and with an extreme, some limit set, as a problem of their own: later levels are empty.
  [[nodiscard]] Labelling<Criteria> up_to(std::size_t level) const {
    Labelling<Criteria> part = problem_.labelling;
    for (Weight<Criteria>& levels : part.unary.levels()) std::fill(levels.begin() + level, levels.end(), 0);
    for (Weight<Criteria>& weight : part.weight) std::fill(weight.begin() + level, weight.end(), 0);
    for (std::size_t later = level; later < Criteria; ++later) part.tables.clear_level(later);
    part.tables.index(part.size());
    if (problem_.pits_first) {
      part.link = problem_.connectivity().link;
      part.link.resize(part.size());  // auxiliary variables have none
      part.node_count = problem_.connectivity().node_count;
    }
    return part;
  }

  /// An extreme of vertices: its excess is counted only at vertices where labels were found to be beyond the
  /// limit. As long as some are not counted what is solved is a relaxation; when its labels keep the limit
  /// everywhere, they are as good with all counted.
  struct HeldVertices {
    std::size_t level = 0;
    VertexTerms terms;
    std::int64_t most = 0;
    std::vector<std::uint8_t> counted;  ///< by table
    WideStars wide = WideStars::Relaxed;
  };

  /// Puts the excess of the counted vertices in place. Returns its constant.
  std::int64_t count_held(Labelling<Criteria>& part) const {
    const ExcessOptions excess{held_->most, &held_->terms, held_->counted, held_->wide};
    return count_excess(scan_, problem_.sums[held_->level], excess, held_->level, part, progress_);
  }

  void hold(std::int64_t most, std::uint8_t counted) {
    held_->most = most;
    held_->counted.assign(held_->terms.tables.size(), counted);
  }

  /// Solves, and counts more vertices until those that are not counted keep their limit, or the limit is
  /// found to be too low. The level of the excess is then the number itself.
  Solution<Criteria> solve_held(Labelling<Criteria>& part) {
    for (int round = 0;; ++round) {
      const std::int64_t constant = held_ ? count_held(part) : 0;
      Solution<Criteria> solution = solve<Criteria>(part, limits_, progress_, known_);
      if (!held_) return solution;
      solution.value.level[held_->level] += constant;
      solution.bound.level[held_->level] += constant;
      if (solution.bound.level[held_->level] > 0) return solution;
      if (!mark_excess(held_->terms, problem_.sums[held_->level], held_->most, solution.label,
                       held_->counted)) {
        return solution;
      }
      if (round == kRounds) hold(held_->most, 1);
    }
  }

  [[nodiscard]] std::int64_t worst(std::size_t level, const Extreme& extreme,
                                   const Solution<Criteria>& solution) const {
    return extreme_of(scan_, problem_.sums[level], problem_.labelling.first, solution.label, progress_,
                      extreme.vertex ? &*extreme.vertex : nullptr);
  }

  /// Puts a limit on an extreme. Returns the constant of its level.
  std::int64_t limit(std::size_t level, std::int64_t most, Labelling<Criteria>& part) {
    if (held_ && held_->level == level) {
      hold(most, 0);
      return 0;
    }
    return count_excess(scan_, problem_.sums[level], {.most = most}, level, part, progress_);
  }

  /// Labels that need not be the best: the bound says nothing.
  Solution<Criteria> solve_with_wide_at_least(Labelling<Criteria>& part) {
    held_->wide = WideStars::Least;
    Solution<Criteria> solution = solve_held(part);
    held_->wide = WideStars::Relaxed;
    return solution;
  }

  void settle(std::size_t level) {
    const Objective& objective = problem_.sums[level];
    Labelling<Criteria> part = up_to(level);
    const Extreme extreme = find_extreme(scan_, objective, part.first, progress_);
    const Solution<Criteria> before = solve_held(part);
    known_ = before.label;
    Settled& settled = settled_[level];
    settled = {extreme.delaunay, worst(level, extreme, before), extreme.values.front(),
               extreme.values.front()};
    if (extreme.vertex) held_ = HeldVertices{level, *extreme.vertex, 0, {}};
    auto low = extreme.values.begin();
    auto high = std::lower_bound(low, extreme.values.end(), settled.limit);
    const auto within = [&](const Solution<Criteria>& trial, std::int64_t most) {
      return same_before(trial.value, before.value, level) && worst(level, extreme, trial) <= most;
    };
    while (low < high) {
      const auto middle = low + (high - low) / 2;
      const std::int64_t constant = limit(level, *middle, part);
      Solution<Criteria> trial = solve_held(part);
      const bool excluded =
          same_before(trial.bound, before.value, level) && trial.bound.level[level] + constant > 0;
      if (!excluded && extreme.vertex && !extreme.vertex->wide.empty() && !within(trial, *middle)) {
        trial = solve_with_wide_at_least(part);
      }
      if (within(trial, *middle)) {
        settled.limit = worst(level, extreme, trial);
        known_ = trial.label;
        high = std::lower_bound(extreme.values.begin(), middle, settled.limit);
        continue;
      }
      low = middle + 1;
      if (excluded && low != extreme.values.end()) settled.bound = *low;
    }
    problem_.delaunay[level] = limit(level, settled.limit, problem_.labelling);
  }

  static bool same_before(const Cost<Criteria>& a, const Cost<Criteria>& b, std::size_t level) {
    return std::equal(a.level.begin(), a.level.begin() + level, b.level.begin());
  }

  void choose() {
    Labelling<Criteria>& labelling = problem_.labelling;
    std::vector<CountedPits> counted = count_pits_below();
    const std::size_t first = counted.empty() ? problem_.sums.size() : counted.front().level;
    settle_from(0, first);
    if (proof_ != nullptr) {
      // The verifier counts all vertices.
      if (held_) hold(held_->most, 1), count_held(labelling);
      write_proof();
      if (held_) hold(held_->most, 0);
    }
    // What decides where nothing was named needs no bound.
    if (completed_) limits_.effort /= kLessForCompletion;
    if (problem_.pits_first) {
      labelling.link =
          counted.empty() ? std::move(problem_.connectivity().link) : problem_.connectivity().link;
      labelling.node_count = problem_.connectivity().node_count;
    }
    if (counted.empty()) {
      solution_ = solve_held(labelling);
      keep_limits();
      if (problem_.pits_first) problem_.connectivity().link = std::move(labelling.link);
      return;
    }
    const std::size_t quadrilaterals = problem_.quadrilaterals;
    for (bool refined = true; refined;) {
      lay_pits(counted, quadrilaterals);
      settle_from(first + 1, problem_.sums.size());
      solution_ = solve_held(labelling);
      keep_limits();
      refined = false;
      for (CountedPits& pits : counted) {
        if (pits.terms.refine(solution_.label) == PitTerms::Outcome::Refined) refined = true;
      }
    }
    solution_.label.resize(quadrilaterals);
    for (const CountedPits& pits : counted) {
      problem_.delaunay[pits.level] = pits.constant + pits.terms.constant();
    }
  }

  /// An objective of pits after others, as terms of its level.
  struct CountedPits {
    std::size_t level = 0;
    PitTerms terms;
    WideSteps constant = 0;  ///< steps beside those of the terms
  };

  [[nodiscard]] std::vector<CountedPits> count_pits_below() const {
    std::vector<CountedPits> counted;
    for (std::size_t level = 0; level < problem_.sums.size(); ++level) {
      if (problem_.sums[level].is(Criterion::LocalMinima)) {
        counted.push_back({level, pit_terms(), 0});
      } else if (problem_.sums[level].is(Criterion::PitDepth)) {
        DepthTerms depth = find_depth_terms(scan_.tin(), scan_.quadrilaterals(), problem_.owner,
                                            vertical_metres_, problem_.labelling.unary.ties(), progress_);
        counted.push_back({level, std::move(depth.terms), depth.constant});
      }
    }
    return counted;
  }

  /// Where stars too wide for tables are beyond the limit, other labels are taken that are not; the bound
  /// stays.
  void keep_limits() {
    if (!held_ || known_.empty()) return;
    const auto within = [&](const std::vector<Label>& label) {
      return extreme_of(scan_, problem_.sums[held_->level], problem_.labelling.first, label, progress_,
                        &held_->terms) <= settled_[held_->level].limit;
    };
    if (within(solution_.label)) return;
    solution_.label = solve_with_wide_at_least(problem_.labelling).label;
    if (!within(solution_.label)) solution_.label = known_;
    solution_.value = cost_of<Criteria>(problem_.labelling, solution_.label);
  }

  void settle_from(std::size_t first, std::size_t end) {
    for (std::size_t level = first; level < end; ++level) {
      if (problem_.sums[level].is_extreme()) settle(level);
    }
  }

  [[nodiscard]] PitTerms pit_terms() const {
    std::vector<PitLink> links;
    for (std::uint32_t q = 0; q < problem_.plateaus.link.size(); ++q) {
      const Link& link = problem_.plateaus.link[q];
      if (link.exists()) links.push_back({link.a, link.b, {q, link.helpful()}});
    }
    return {std::move(links), std::vector<std::int64_t>(problem_.plateaus.node_count, to_steps(1)),
            problem_.labelling.unary.ties()};
  }

  /// Fills the levels of pits anew, with auxiliary variables after the quadrilaterals.
  void lay_pits(std::span<const CountedPits> counted, std::size_t quadrilaterals) {
    Labelling<Criteria>& labelling = problem_.labelling;
    labelling.unary.resize(quadrilaterals);
    labelling.first.resize(quadrilaterals + 1);
    if (!labelling.link.empty()) labelling.link.resize(quadrilaterals);
    for (const CountedPits& pits : counted) {
      labelling.tables.clear_level(pits.level);
      pits.terms.add_to(labelling, pits.level);
    }
    if (!known_.empty()) known_.resize(quadrilaterals);
    known_.resize(known_.empty() ? 0 : labelling.size(), Label::Zero);
  }

  /// A stage for each extreme, and one for the sums between two of them. Pits after other criteria, and what
  /// follows them, have none.
  void write_proof() {
    const std::size_t begin = count_leading_pits(criteria_);
    std::size_t end = begin;
    while (end < criteria_.size() && !criteria_[end].is_of_pits()) ++end;
    std::size_t level = 0;
    for (std::size_t i = begin; i < end; ++i) {
      if (criteria_[i].is_extreme()) {
        write_extreme_stage(i + 1, level);
      } else if (i + 1 == end || criteria_[i + 1].is_extreme()) {
        write_stage(i + 1, up_to(level + 1));
      }
      ++level;
    }
  }

  /// That nothing is one value better than the bound: by itself, or given the criteria before.
  void write_extreme_stage(std::size_t criteria, std::size_t level) {
    const Objective& objective = problem_.sums[level];
    Labelling<Criteria> part = up_to(level);
    const Extreme extreme = find_extreme(scan_, objective, part.first, progress_);
    const auto bound = std::lower_bound(extreme.values.begin(), extreme.values.end(), settled_[level].bound);
    if (bound == extreme.values.begin()) {
      *proof_ << "stage " << criteria << " alone\n";
      return;
    }
    const std::int64_t better = *(bound - 1);
    if (const auto conflict = find_conflict(scan_, objective, part.first, better, part.size(), progress_)) {
      *proof_ << "stage " << criteria << " alone\nconflict";
      for (const std::uint32_t variable : *conflict) *proof_ << ' ' << variable;
      *proof_ << '\n';
      return;
    }
    count_excess(scan_, objective, {better, extreme.vertex ? &*extreme.vertex : nullptr, {}}, level, part,
                 progress_);
    write_stage(criteria, part);
  }

  void write_stage(std::size_t criteria, const Labelling<Criteria>& problem) {
    std::ostringstream steps;
    if (!write_steps<Criteria>(steps, problem, limits_.width, progress_)) return;
    *proof_ << "stage " << criteria << '\n' << steps.str();
  }

  [[nodiscard]] OptimizeResult report() const {
    OptimizeResult result;
    result.quadrilaterals = problem_.quadrilaterals;
    result.flipped.reserve(problem_.quadrilaterals);
    for (const Label label : solution_.label) result.flipped.push_back(label == Label::One ? 1 : 0);
    result.fixed_by_elimination = solution_.figures.fixed_by_elimination;
    result.pieces = solution_.figures.pieces;
    result.largest_piece = solution_.figures.largest_piece;
    result.width = solution_.figures.width;
    const std::size_t leading = count_leading_pits(criteria_);
    std::size_t level = 0;
    bool proved = true;
    for (const Objective& objective : criteria_) {
      const bool leads = result.criteria.size() < leading;
      CriterionResult line;
      line.name = objective.name();
      line.unit = objective.unit();
      line.direction = objective.direction() == Direction::Minimise ? "min" : "max";
      if (objective.is_of_pits()) {
        fill_pits(line, objective, leads ? std::nullopt : std::optional(level++), proved);
      } else if (objective.is_extreme()) {
        fill_extreme(line, level++, proved);
      } else {
        fill_sum(line, level++, proved);
      }
      proved = proved && line.optimal;
      result.criteria.push_back(std::move(line));
    }
    return result;
  }

  void fill_pits(CriterionResult& line, const Objective& objective, std::optional<std::size_t> level,
                 bool proved_before) const {
    const bool depth = objective.is(Criterion::PitDepth);
    const auto value = [&](const std::vector<Label>& label) {
      if (!depth) return static_cast<double>(count_pits(problem_.plateaus, label));
      return static_cast<double>(
                 pit_depth_of(scan_.tin(), scan_.quadrilaterals(), label, vertical_metres_, progress_)) /
             kStepsPerUnit;
    };
    line.delaunay = value(std::vector<Label>(problem_.quadrilaterals, Label::Zero));
    line.result = value(solution_.label);
    line.bound = value(std::vector<Label>(problem_.quadrilaterals, Label::Open));
    line.method = "connectivity";
    if (level) {
      const WideSteps steps = problem_.delaunay[*level] + solution_.bound.level[*level];
      const double bound = static_cast<double>(steps) / kStepsPerUnit;
      if (proved_before) line.bound = std::max(line.bound, depth ? bound : std::ceil(bound));
      line.method = "connectivity by " + method_name(solution_.figures);
    }
    line.optimal = proved_before && line.result == line.bound;
  }

  void fill_extreme(CriterionResult& line, std::size_t level, bool proved_before) const {
    const Settled& settled = settled_[level];
    const double per_unit = steps_per_unit(problem_.sums[level]);
    const std::int64_t result =
        extreme_of(scan_, problem_.sums[level], problem_.labelling.first, solution_.label, progress_);
    line.delaunay = static_cast<double>(settled.delaunay) / per_unit;
    line.result = static_cast<double>(result) / per_unit;
    line.bound = static_cast<double>(proved_before ? settled.bound : settled.least) / per_unit;
    line.optimal = proved_before && result == settled.bound;
    line.method = "bisection over limits by " + method_name(solution_.figures);
  }

  /// Bounds compare lexicographically: that of a level holds if all levels before have reached theirs.
  void fill_sum(CriterionResult& line, std::size_t level, bool proved_before) const {
    const WideSteps delaunay = problem_.delaunay[level];
    const double per_unit = steps_per_unit(problem_.sums[level]);
    const LeftOut left_out = find_left_out(scan_, problem_.sums[level], solution_.label, progress_);
    const WideSteps result = delaunay + solution_.value.level[level] + left_out.value;
    const WideSteps bound =
        delaunay + left_out.least +
        (proved_before ? solution_.bound.level[level] : least_of_level(problem_.labelling, level));
    const auto in_units = [&](WideSteps steps) {
      return steps == 0 ? 0 : static_cast<double>(steps) / per_unit;
    };
    line.delaunay = in_units(delaunay);
    line.result = in_units(result);
    line.bound = in_units(bound);
    line.optimal = proved_before && result == bound;
    line.method = method_name(solution_.figures);
  }

  /// An extreme, in steps as in sums.hpp: the least limit that was reached, and one that cannot be beaten.
  struct Settled {
    std::int64_t delaunay = 0, limit = 0, bound = 0;
    std::int64_t least = 0;  ///< that each term alone gives
  };

  static constexpr int kRounds = 40;  ///< then all vertices are counted
  static constexpr std::uint64_t kLessForCompletion = 100;

  std::span<const Objective> criteria_;
  bool completed_;  ///< by a criterion that was not asked for
  SolverLimits limits_;
  std::ostream* proof_;
  double vertical_metres_;
  Progress& progress_;
  FirstOrderProblem<Criteria> problem_;
  TermScan scan_;
  std::array<Settled, Criteria> settled_{};
  std::optional<HeldVertices> held_;
  std::vector<Label> known_;  ///< labels within all limits settled so far; empty if there are none
  Solution<Criteria> solution_;
};

}  // namespace

OptimizeResult optimize_first_order(const Tin& tin, std::span<const Quadrilateral> quadrilaterals,
                                    const OptimizeOptions& options, Progress& progress) {
  if (!options.criteria.empty()) {
    OptimizeOptions completed = options;
    const bool open = options.criteria.back().is_extreme() &&
                      std::none_of(options.criteria.begin(), options.criteria.end(),
                                   [](const Objective& o) { return o.is(Criterion::NormalAngleSum); });
    if (open) completed.criteria.emplace_back(Criterion::NormalAngleSum);
    return with_levels(completed.criteria, [&](auto levels) {
      return Run<levels()>(tin, quadrilaterals, completed, options.criteria.size(), progress).run();
    });
  }
  OptimizeResult result;
  result.quadrilaterals = quadrilaterals.size();
  result.flipped.assign(quadrilaterals.size(), 0);
  return result;
}

}  // namespace thalweg
