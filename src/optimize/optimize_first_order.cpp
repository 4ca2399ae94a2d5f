// From a TIN and its quadrilaterals to a labelling problem, and back.
//
// 1. Sums over edges become unary costs and weights (edge_terms.cpp), pits become links (plateaus.cpp).
// 2. Local minima first, or alone: the labellings whose links connect all they can are those with the fewest
// pits; of
//    them the one of least cost (solver.cpp).
// 3. Local minima after other criteria: solve as if they came first. If the sums that precede them are proved
//    to be no larger without links, the result is best in them, and has fewest pits of all triangulations. If
//    not, solve without links, and report the pits of that with the fewest of all as bound.
#include "optimize/edge_terms.hpp"
#include "optimize/plateaus.hpp"
#include "optimize/solver.hpp"

#include <thalweg/base/error.hpp>
#include <thalweg/optimize/optimize.hpp>

#include <algorithm>
#include <cmath>
#include <string>

namespace thalweg {

namespace {

/// As many as there are criteria that are sums over edges, and at least one.
constexpr std::size_t kSums = 1;

void check(const Tin& tin, const OptimizeOptions& options) {
  for (std::size_t i = 0; i < options.criteria.size(); ++i) {
    const auto here = options.criteria.begin() + static_cast<std::ptrdiff_t>(i);
    if (std::find(options.criteria.begin(), here, *here) != here) {
      throw Error(ErrorCode::Usage,
                  "criterion " + std::string(traits_of(*here).name) + " is given twice; name each once");
    }
  }
  for (const double metres : {options.horizontal_metres_per_unit, options.vertical_metres_per_unit}) {
    if (!(metres > 0) || !std::isfinite(metres)) {
      throw Error(ErrorCode::Usage, "metres per unit must be positive, but are " + std::to_string(metres));
    }
  }
  if (options.width_limit < 1 || options.width_limit > 24) {
    throw Error(ErrorCode::Usage,
                "the width limit must be 1 to 24, but is " + std::to_string(options.width_limit));
  }
  constexpr std::size_t kMaxEdges = std::size_t{1} << 28U;  // so that sums of angles stay below 2^62 steps
  if (tin.edge_count() >= kMaxEdges) {
    throw Error(ErrorCode::SizeLimit, "the TIN has " + std::to_string(tin.edge_count()) +
                                          " edges; at most 268435455 can be optimised: split the area");
  }
}

std::string method_name(const SolverFigures& figures) {
  std::string name = "elimination";
  if (figures.used_tables) name += " + dynamic programming";
  if (figures.used_forests) name += " + minimum spanning forest";
  if (figures.used_roof_duality) name += " + roof duality";
  if (figures.used_relaxation) name += " + variable splitting and local search";
  return name;
}

class Run {
 public:
  Run(const Tin& tin, std::span<const Quadrilateral> quadrilaterals, const OptimizeOptions& options,
      Progress& progress)
      : tin_(tin), quadrilaterals_(quadrilaterals), options_(options), progress_(progress) {
    for (const Criterion criterion : options.criteria) {
      if (criterion == Criterion::LocalMinima) {
        sums_before_pits_ = sums_.size();
        counts_pits_ = true;
      } else {
        sums_.push_back(criterion);
      }
    }
  }

  OptimizeResult run() {
    build();
    progress_.start_phase("choose diagonals");
    solve_all();
    progress_.advance(1);
    return report();
  }

 private:
  void build() {
    progress_.start_phase("weigh diagonals");
    const std::vector<std::uint32_t> owner = quadrilaterals_of_triangles(tin_, quadrilaterals_);
    const Scale scale{options_.horizontal_metres_per_unit, options_.vertical_metres_per_unit};
    terms_ = build_edge_terms<kSums>(tin_, quadrilaterals_, owner, sums_, scale, progress_);
    progress_.advance(0.7);
    rank_ = add_flips_and_ties<kSums>(tin_, quadrilaterals_, terms_.labelling.unary, progress_);
    progress_.advance(0.9);
    if (counts_pits_) plateaus_ = find_plateaus(tin_, quadrilaterals_, owner, progress_);
    progress_.advance(1);
  }

  void solve_all() {
    const SolverLimits limits{options_.width_limit, options_.effort};
    Labelling<kSums>& problem = terms_.labelling;
    if (!counts_pits_) {
      solution_ = solve<kSums>(problem, rank_, limits, progress_);
      return;
    }
    problem.link = plateaus_.link;
    problem.node_count = plateaus_.node_count;
    solution_ = solve<kSums>(problem, rank_, limits, progress_);
    if (sums_before_pits_ == 0) return;
    problem.link.clear();
    problem.node_count = 0;
    Solution<kSums> free = solve<kSums>(problem, rank_, limits, progress_);
    for (std::size_t i = 0; i < sums_before_pits_; ++i) {
      if (solution_.value.level[i] == free.bound.level[i]) continue;
      solution_ = std::move(free);
      return;
    }
    solution_.bound = solution_.value;
  }

  [[nodiscard]] OptimizeResult report() const {
    OptimizeResult result;
    result.quadrilaterals = quadrilaterals_.size();
    result.flipped.reserve(quadrilaterals_.size());
    for (const Label label : solution_.label) result.flipped.push_back(label == Label::One ? 1 : 0);
    result.fixed_by_elimination = solution_.figures.fixed_by_elimination;
    result.pieces = solution_.figures.pieces;
    result.largest_piece = solution_.figures.largest_piece;
    result.width = solution_.figures.width;
    std::size_t level = 0;
    for (const Criterion criterion : options_.criteria) {
      const CriterionTraits& traits = traits_of(criterion);
      CriterionResult line;
      line.name = traits.name;
      line.unit = traits.unit;
      line.direction = traits.direction == Direction::Minimise ? "min" : "max";
      criterion == Criterion::LocalMinima ? fill_pits(line) : fill_sum(line, level++);
      result.criteria.push_back(std::move(line));
    }
    return result;
  }

  void fill_pits(CriterionResult& line) const {
    const std::vector<Label> kept(quadrilaterals_.size(), Label::Zero),
        all(quadrilaterals_.size(), Label::Open);
    line.delaunay = static_cast<double>(count_pits(plateaus_, kept));
    line.result = static_cast<double>(count_pits(plateaus_, solution_.label));
    line.bound = static_cast<double>(count_pits(plateaus_, all));
    line.optimal = line.result == line.bound;
    line.method = "connectivity";
  }

  /// Bounds compare lexicographically: that of a level holds if all levels before have reached theirs. If
  /// not, the bound of the first level that has not is still one for that level; nothing is known of those
  /// after it.
  void fill_sum(CriterionResult& line, std::size_t level) const {
    const std::int64_t delaunay = terms_.delaunay[level];
    line.delaunay = static_cast<double>(delaunay) / kStepsPerUnit;
    line.result = static_cast<double>(delaunay + solution_.value.level[level]) / kStepsPerUnit;
    line.bound = static_cast<double>(delaunay + solution_.bound.level[level]) / kStepsPerUnit;
    line.optimal = solution_.value.level[level] == solution_.bound.level[level];
    line.method = method_name(solution_.figures);
  }

  const Tin& tin_;
  std::span<const Quadrilateral> quadrilaterals_;
  const OptimizeOptions& options_;
  Progress& progress_;
  std::vector<Criterion> sums_;
  std::size_t sums_before_pits_ = 0;
  bool counts_pits_ = false;
  EdgeTerms<kSums> terms_;
  std::vector<std::uint32_t> rank_;
  PlateauGraph plateaus_;
  Solution<kSums> solution_;
};

}  // namespace

OptimizeResult optimize_first_order(const Tin& tin, std::span<const Quadrilateral> quadrilaterals,
                                    const OptimizeOptions& options, Progress& progress) {
  check(tin, options);
  if (!options.criteria.empty()) return Run(tin, quadrilaterals, options, progress).run();
  OptimizeResult result;
  result.quadrilaterals = quadrilaterals.size();
  result.flipped.assign(quadrilaterals.size(), 0);
  return result;
}

}  // namespace thalweg
