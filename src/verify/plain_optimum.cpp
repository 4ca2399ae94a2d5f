// Bounds, one criterion after the other.
//
// 1. Every term of every criterion becomes a factor over few quadrilaterals. Costs are vectors, so that
//    criteria are compared in the order of their priority. The first component counts broken conditions: a
//    clause of the pits, a value above that of a largest-value criterion before.
// 2. Pits come first or are not checked: their fewest number is that of connected plateaus, their least depth
//    that with all diagonals at once, and the condition on what follows are clauses, more of them until the
//    labels found keep all.
// 3. Sums: the least cost of all sums so far. Largest values: no labelling keeps every value below the bound.
#include "verify/plain_optimum.hpp"

#include "verify/plain_pits.hpp"
#include "verify/plain_proof.hpp"
#include "verify/plain_solver.hpp"
#include "verify/plain_water.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace thalweg::verify {

namespace {

constexpr std::size_t kWidthLimit = 20;
constexpr long double kSteps = 0x1p32L;

/// Why a claim cannot hold, whatever the terrain; nothing if it could.
std::optional<std::string> find_contradiction(const CriterionClaim& claim,
                                              const std::optional<PlainCriterion>& criterion) {
  const double sign = criterion && criterion->maximised ? -1 : 1;
  const bool beyond = criterion && sign * claim.bound > sign * claim.result;
  if (!beyond && !(claim.optimal && claim.bound != claim.result)) return std::nullopt;
  return fmt::format("{}, but the bound is {:.17g}, the result {:.17g}",
                     claim.optimal ? "called optimal" : "a bound bounds the result", claim.bound,
                     claim.result);
}

class BoundChecker {
 public:
  BoundChecker(const PlainProblem& problem, std::span<const CriterionClaim> claims, const Proof* proof,
               Progress& progress)
      : problem_(problem),
        claims_(claims),
        proof_(proof),
        progress_(progress),
        plateaus_(problem.delaunay, problem.quadrilaterals),
        condition_(&plateaus_) {}

  Finding check(const CriterionClaim& claim) {
    Finding finding{claim.name + (claim.optimal ? ", optimal" : ", bound"), Verdict::NotChecked, {}};
    const auto criterion = plain_criterion(claim.name, problem_.reference);
    if (const auto contradiction = find_contradiction(claim, criterion)) {
      return {finding.claim, Verdict::Broken, *contradiction};
    }
    if (!reason_.empty()) {
      finding.detail = reason_;
      return finding;
    }
    if (!criterion) {
      reason_ = "a criterion before has no plain formula";
      finding.detail = "the verifier has no formula for it, or no reference";
    } else if (has_vertex_part(*criterion) && most_at_vertex(problem_) > kWidthLimit) {
      finding.detail = reason_ = "more quadrilaterals meet at a vertex than a table takes";
    } else if (criterion->depends == Depends::OnPlateau) {
      check_pits(claim, finding);
    } else if (criterion->combines == Combines::Sum) {
      check_sum(claim, *criterion, finding);
    } else {
      check_extreme(claim, *criterion, finding);
    }
    ++level_;
    if (reason_.empty() && !claim.optimal) reason_ = "a criterion before is not optimal, only held";
    if (finding.verdict == Verdict::Broken) reason_ = "a criterion before does not hold";
    return finding;
  }

 private:
  void check_pits(const CriterionClaim& claim, Finding& finding) {
    if (level_ > leading_) {
      finding.detail = reason_ = "pits are proved again only where they come first";
      return;
    }
    ++leading_;
    with_pits_ = true;
    if (claim.name == "pit-depth") {
      spills_ = find_spill_links(problem_.delaunay, problem_.quadrilaterals);
      condition_ = &*spills_;
      const PlainValue least = pit_depth(problem_.delaunay, problem_.scale, problem_.quadrilaterals);
      const long double most = least.value + least.tolerance;
      judge(claim.bound <= most && (!claim.optimal || claim.result <= most), "heights and diagonals allow",
            least.value, finding);
    } else {
      // Least depths leave the fewest pits too, so the number is the same after them.
      const auto fewest = static_cast<double>(plateaus_.fewest());
      judge(claim.bound <= fewest && (!claim.optimal || claim.result <= fewest),
            "plateaus and diagonals allow", fewest, finding);
    }
    clauses_ = condition_->plateau_clauses();
  }

  static void judge(bool holds, const char* what, long double value, Finding& finding) {
    finding.verdict = holds ? Verdict::Holds : Verdict::Broken;
    finding.detail = holds ? "proved again" : fmt::format("{} {:.17g}", what, static_cast<double>(value));
  }

  /// A bound is lexicographic: its component at a place bounds what is there only if the mesh has, in the
  /// verifier's own steps, just what the bound has at all places before.
  struct Bounded {
    Cost bound{};
    Cost reached{};  ///< what the mesh has

    [[nodiscard]] bool reaches_all_before(std::size_t place) const {
      return std::equal(bound.begin(), bound.begin() + static_cast<std::ptrdiff_t>(place), reached.begin());
    }
  };
  static constexpr const char* kNotReached =
      "a criterion before is reached but for rounding, so this bound tells nothing";

  // The least cost under all conditions; none if too wide.
  std::optional<Bounded> least(const std::vector<Component>& components) {
    constexpr int kMostRounds = 30;
    const std::vector<Factor> terms = terms_of(problem_, components);
    const Cost reached = cost_of(terms, problem_.flipped);
    for (int round = 0; round < kMostRounds; ++round) {
      std::vector<Factor> factors = terms;
      factors.insert(factors.end(), clauses_.begin(), clauses_.end());
      const auto optimum =
          minimise(problem_.quadrilaterals.size(), std::move(factors), kWidthLimit, progress_);
      if (!optimum) return std::nullopt;
      if (!with_pits_) return Bounded{optimum->cost, reached};
      std::vector<Factor> more = condition_->broken_clauses(optimum->labels);
      if (more.empty()) return Bounded{optimum->cost, reached};
      clauses_.insert(clauses_.end(), more.begin(), more.end());
    }
    return std::nullopt;
  }

  [[nodiscard]] std::vector<Component> components_before() const {
    std::vector<Component> components = conditions_;
    components.insert(components.end(), sums_.begin(), sums_.end());
    return components;
  }

  void check_sum(const CriterionClaim& claim, const PlainCriterion& criterion, Finding& finding) {
    if (sums_.size() + 2 > Cost{}.size()) {
      finding.detail = reason_ = "more criteria than the verifier's costs have components";
      return;
    }
    sums_.push_back({.criterion = criterion, .place = sums_.size() + 1});
    const Stage* stage = stage_of(false);
    if (stage != nullptr && !stage->fault.empty()) {
      finding.verdict = Verdict::Broken;
      finding.detail = stage->fault;
      return;
    }
    const auto cost = stage != nullptr ? std::optional(stage->shown) : least(components_before());
    if (!cost) {
      finding.detail = reason_ = "too wide for the plain solver";
      return;
    }
    const std::size_t place = sums_.back().place;
    if (!cost->reaches_all_before(place)) {
      finding.detail = reason_ = kNotReached;
      return;
    }
    const long double sign = criterion.maximised ? -1 : 1;
    const long double proved = static_cast<long double>(cost->bound[place]) / kSteps;
    const long double tolerance = value_of(problem_.delaunay, problem_.scale, criterion).tolerance;
    const bool bounded = sign * claim.bound <= proved + tolerance;
    const bool reached = !claim.optimal || sign * claim.result <= proved + tolerance;
    judge(bounded && reached, stage != nullptr ? "the proof shows only" : "the optimum is", sign * proved,
          finding);
    if (stage != nullptr && finding.verdict == Verdict::Holds) finding.detail = "by the proof";
  }

  /// A stage of the proof, taken.
  struct Stage {
    std::size_t place = 0;  ///< of its last criterion
    Bounded shown;
    std::string fault;  ///< why it shows nothing
  };

  static std::int64_t steps_of(double value, const PlainCriterion& criterion) {
    return static_cast<std::int64_t>(std::floor(value / criterion.term_unit * kSteps + 0.5L));
  }
  /// Steps by which another correct rounding may differ: more beside slivers, as far as they let a bound say
  /// something.
  std::int64_t slack_of(double value, const PlainCriterion& criterion) {
    constexpr std::int64_t kSlack = 2;
    constexpr long double kMost = 1e-6L;
    const auto [known, fresh] = tolerance_.try_emplace(criterion.parts.front().name);
    if (fresh) known->second = value_of(problem_.delaunay, problem_.scale, criterion).tolerance;
    const long double size = std::abs(static_cast<long double>(value));
    const long double slack = std::max(size * 1e-12L, std::min(known->second, kMost * std::max(size, 1.0L)));
    return kSlack + static_cast<std::int64_t>(slack / criterion.term_unit * kSteps);
  }
  /// Counts terms that are no better than the bound.
  Component no_better_than(const CriterionClaim& claim, const PlainCriterion& criterion, std::size_t place) {
    const std::int64_t slack = slack_of(claim.bound, criterion);
    return {criterion, true,
            steps_of(claim.bound, criterion) + (criterion.combines == Combines::Largest ? -slack : slack),
            place};
  }
  /// Counts terms that are worse than the result, among the broken conditions.
  Component worse_than(const CriterionClaim& claim, const PlainCriterion& criterion) {
    const std::int64_t slack = slack_of(claim.bound, criterion) + 1;
    return {criterion, true,
            steps_of(claim.result, criterion) + (criterion.combines == Combines::Largest ? slack : -slack),
            0};
  }

  /// The stage of the proof that bounds the present criterion; null if there is none.
  const Stage* stage_of(bool extreme) {
    if (proof_ == nullptr) return nullptr;
    for (std::size_t i = 0; i < proof_->stages.size(); ++i) {
      const ProofStage& stage = proof_->stages[i];
      const bool fits = extreme ? stage.criteria == level_ + 1 : stage.criteria > level_ && !stage.alone;
      if (!fits || stage.criteria > claims_.size()) continue;
      const auto [at, fresh] = stages_.try_emplace(i);
      if (fresh) take(stage, at->second);
      return &at->second;
    }
    return nullptr;
  }

  void take(const ProofStage& stage, Stage& taken) {
    std::vector<Component> components;
    for (std::size_t i = 0; i < stage.criteria; ++i) {
      const auto criterion = plain_criterion(claims_[i].name, problem_.reference);
      const bool last = i + 1 == stage.criteria;
      if (!criterion || (i >= leading_ && criterion->depends == Depends::OnPlateau) ||
          taken.place + 2 > Cost{}.size()) {
        taken.fault = "the proof has a stage for " + claims_[i].name + ", which no stage can bound";
        return;
      }
      if (criterion->depends == Depends::OnPlateau) continue;
      if (stage.alone && !last) continue;
      if (criterion->combines == Combines::Sum) {
        components.push_back({.criterion = *criterion, .place = ++taken.place});
      } else if (last) {
        components.push_back(no_better_than(claims_[i], *criterion, ++taken.place));
      } else {
        components.push_back(worse_than(claims_[i], *criterion));
      }
    }
    std::vector<Factor> factors = terms_of(problem_, components);
    taken.shown.reached = cost_of(factors, problem_.flipped);
    StageBound bound = take_steps(stage, problem_.quadrilaterals.size(), std::move(factors),
                                  with_pits_ && !stage.alone ? condition_ : nullptr, progress_);
    taken.shown.bound = bound.bound;
    taken.fault = std::move(bound.fault);
    if (taken.fault.empty() && bound.bound[0] != 0) {
      taken.fault = "the proof takes labels that break a condition";
    }
  }

  /// The count must be positive while all sums before are at what the mesh has.
  void judge_extreme(const Stage& stage, const CriterionClaim& claim, Finding& finding) {
    const bool sound = stage.fault.empty();
    if (sound && !stage.shown.reaches_all_before(stage.place)) {
      finding.detail = reason_ = kNotReached;
      return;
    }
    const bool holds = sound && stage.shown.bound[stage.place] > 0;
    finding.verdict = holds ? Verdict::Holds : Verdict::Broken;
    finding.detail =
        holds ? "by the proof"
        : !stage.fault.empty()
            ? stage.fault
            : fmt::format("the proof does not show that nothing is better than {:.17g}", claim.bound);
  }

  /// Rounded up.
  [[nodiscard]] double mean_degree() const {
    std::size_t ends = 0;
    std::vector<bool> used(problem_.delaunay.xy.size(), false);
    for (std::size_t t = 0; t < problem_.delaunay.triangles.size(); ++t) {
      for (std::size_t i = 0; i < 3; ++i) {
        used[problem_.delaunay.triangles[t][i]] = true;
        ends += problem_.delaunay.across[t][i] == kNone ? 2 : 1;  // an inner edge is met twice
      }
    }
    return std::ceil(static_cast<double>(ends) /
                     static_cast<double>(std::count(used.begin(), used.end(), true)));
  }

  void check_extreme(const CriterionClaim& claim, const PlainCriterion& criterion, Finding& finding) {
    if (sums_.size() + 2 > Cost{}.size()) {
      finding.detail = reason_ = "more criteria than the verifier's costs have components";
      return;
    }
    const Stage* stage = stage_of(true);
    // No term is below 0, the largest of none; and no diagonal changes the number of edges.
    const bool least_of_all = claim.name == "max-degree"
                                  ? claim.bound <= mean_degree()
                                  : criterion.combines == Combines::Largest && claim.bound <= 0;
    if (least_of_all) {
      judge(true, "", 0, finding);
    } else if (stage != nullptr) {
      judge_extreme(*stage, claim, finding);
    } else {
      std::vector<Component> components = components_before();
      components.push_back(no_better_than(claim, criterion, sums_.size() + 1));
      const auto cost = least(components);
      if (!cost) {
        finding.detail = reason_ = "too wide for the plain solver";
        return;
      }
      const std::size_t place = sums_.size() + 1;
      if (!cost->reaches_all_before(place)) {
        finding.detail = reason_ = kNotReached;
        return;
      }
      judge(cost->bound[place] > 0, "a labelling is better than", claim.bound, finding);
    }
    conditions_.push_back(worse_than(claim, criterion));
  }

  std::map<std::string, long double> tolerance_;  // of the largest value of a criterion, by name
  const PlainProblem& problem_;
  std::span<const CriterionClaim> claims_;
  const Proof* proof_;
  Progress& progress_;
  PlainPlateaus plateaus_;
  std::optional<PlainPlateaus> spills_;
  const PlainPlateaus* condition_;       ///< what pits that come first ask of the links
  std::size_t leading_ = 0;              ///< criteria of pits that come first
  std::map<std::size_t, Stage> stages_;  ///< by their number in the proof
  std::string reason_;                   ///< why nothing more can be checked
  std::size_t level_ = 0;
  bool with_pits_ = false;
  std::vector<Factor> clauses_;
  std::vector<Component> conditions_;  ///< in the first component
  std::vector<Component> sums_;
};

bool overlapping(const PlainProblem& problem) {
  std::vector<bool> taken(problem.delaunay.triangles.size(), false);
  for (const PlainQuadrilateral& q : problem.quadrilaterals) {
    if (taken[q.left] || taken[q.right]) return true;
    taken[q.left] = taken[q.right] = true;
  }
  return false;
}

}  // namespace

std::vector<Finding> check_bounds(const PlainProblem& problem, std::span<const CriterionClaim> claims,
                                  const Proof* proof, Progress& progress) {
  std::vector<Finding> findings;
  if (claims.empty()) return findings;
  if (!problem.structure_known || overlapping(problem)) {
    for (const CriterionClaim& claim : claims) {
      Finding finding{claim.name + (claim.optimal ? ", optimal" : ", bound"), Verdict::NotChecked,
                      "only for order 0 and 1, and quadrilaterals that do not overlap"};
      if (const auto contradiction =
              find_contradiction(claim, plain_criterion(claim.name, problem.reference))) {
        finding.verdict = Verdict::Broken;
        finding.detail = *contradiction;
      }
      findings.push_back(std::move(finding));
    }
    return findings;
  }
  BoundChecker checker(problem, claims, proof, progress);
  for (const CriterionClaim& claim : claims) findings.push_back(checker.check(claim));
  return findings;
}

}  // namespace thalweg::verify
