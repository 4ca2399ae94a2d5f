// Checks the options and puts the problem together: sums become unary costs and weights, pits become
// links.
#include "optimize/first_order_problem.hpp"

#include "optimize/spills.hpp"
#include "optimize/ties.hpp"
#include "optimize/vertex_terms.hpp"

#include <thalweg/base/assert.hpp>
#include <thalweg/base/error.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <string>

namespace thalweg {

void check_options(const Tin& tin, const OptimizeOptions& options) {
  for (auto here = options.criteria.begin(); here != options.criteria.end(); ++here) {
    if (std::find(options.criteria.begin(), here, *here) == here) continue;
    throw Error(ErrorCode::Usage, "criterion " + here->name() + " is given twice; name each once");
  }
  for (const Objective& objective : options.criteria) {
    if (!objective.needs_reference() || options.reference != nullptr) continue;
    throw Error(ErrorCode::Usage,
                "criterion " + objective.name() + " is measured against a reference; give --reference");
  }
  for (const double metres : {options.horizontal_metres_per_unit, options.vertical_metres_per_unit}) {
    if (metres > 0 && std::isfinite(metres)) continue;
    throw Error(ErrorCode::Usage, "metres per unit must be positive, but are " + std::to_string(metres));
  }
  if (options.width_limit < 1 || options.width_limit > kMaxWidthLimit) {
    throw Error(ErrorCode::Usage, "the width limit must be 1 to " + std::to_string(kMaxWidthLimit) +
                                      ", but is " + std::to_string(options.width_limit));
  }
  constexpr std::size_t kMaxEdges = std::size_t{1} << 28U;  // so that rows fit 32 bits
  if (tin.edge_count() < kMaxEdges) return;
  throw Error(ErrorCode::SizeLimit, "the TIN has " + std::to_string(tin.edge_count()) +
                                        " edges; fewer than 268435456 can be optimised: split the area");
}

std::size_t count_leading_pits(std::span<const Objective> criteria) {
  const auto end = std::find_if(criteria.begin(), criteria.end(),
                                [](const Objective& objective) { return !objective.is_of_pits(); });
  return static_cast<std::size_t>(end - criteria.begin());
}

std::size_t count_levels(std::span<const Objective> criteria) {
  constexpr std::size_t kMost = 4;
  const std::size_t sums = criteria.size() - count_leading_pits(criteria);
  if (sums > kMost) {
    throw Error(ErrorCode::Usage, "there are " + std::to_string(sums) +
                                      " criteria; at most 4, and local-minima and pit-depth before them, can "
                                      "be put in order of priority");
  }
  return std::bit_ceil(std::max<std::size_t>(sums, 1));
}

template <std::size_t Criteria>
FirstOrderProblem<Criteria> build_problem(const Tin& tin, std::span<const Quadrilateral> quadrilaterals,
                                          const OptimizeOptions& options, Progress& progress) {
  check_options(tin, options);
  THALWEG_ASSERT(std::ranges::is_sorted(quadrilaterals, {}, &Quadrilateral::diagonal));
  FirstOrderProblem<Criteria> problem;
  const std::size_t leading = count_leading_pits(options.criteria);
  problem.pits_first = leading > 0;
  const auto sums = options.criteria.begin() + static_cast<std::ptrdiff_t>(leading);
  problem.depth_first = std::find(options.criteria.begin(), sums, Criterion::PitDepth) != sums;
  problem.sums.assign(sums, options.criteria.end());
  problem.owner = quadrilaterals_of_triangles(tin, quadrilaterals);
  const std::vector<std::uint32_t>& owner = problem.owner;
  const Scale scale{options.horizontal_metres_per_unit, options.vertical_metres_per_unit};
  const TermScan scan(tin, quadrilaterals, owner, scale, options.reference,
                      most_at_vertex(options.width_limit));
  Labelling<Criteria>& labelling = problem.labelling;
  labelling.unary.resize(quadrilaterals.size());
  problem.quadrilaterals = quadrilaterals.size();
  find_ties(tin, quadrilaterals, labelling.unary.ties(), progress);
  // Before the sums, which stay: what is needed on the way is given back.
  const auto counts_pits = [](const Objective& objective) { return objective.is(Criterion::LocalMinima); };
  if (std::any_of(options.criteria.begin(), options.criteria.end(), counts_pits)) {
    problem.plateaus = find_plateaus(tin, quadrilaterals, owner, progress);
  }
  if (problem.depth_first) problem.spills = find_spills(tin, quadrilaterals, owner, progress);
  progress.advance(0.2);
  if (!problem.sums.empty()) {
    TermScan::Rows rows = scan.lay_out_rows(progress);
    labelling.first = std::move(rows.first);
    labelling.neighbour = std::move(rows.neighbour);
    labelling.weight.resize(labelling.neighbour.size());
  } else {
    labelling.first.assign(quadrilaterals.size() + 1, 0);
  }
  progress.advance(0.3);
  for (std::size_t level = 0; level < problem.sums.size(); ++level) {
    if (!problem.sums[level].is_extreme() && !problem.sums[level].is_of_pits()) {
      problem.delaunay[level] = add_objective(scan, problem.sums[level], level, labelling, progress);
    }
    progress.advance(0.3 + 0.6 * static_cast<double>(level + 1) / static_cast<double>(problem.sums.size()));
  }
  progress.advance(1);
  return problem;
}

template FirstOrderProblem<1> build_problem(const Tin&, std::span<const Quadrilateral>,
                                            const OptimizeOptions&, Progress&);
template FirstOrderProblem<2> build_problem(const Tin&, std::span<const Quadrilateral>,
                                            const OptimizeOptions&, Progress&);
template FirstOrderProblem<4> build_problem(const Tin&, std::span<const Quadrilateral>,
                                            const OptimizeOptions&, Progress&);

}  // namespace thalweg
