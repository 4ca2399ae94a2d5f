// Checks the options and puts the problem together: sums over edges become unary costs and weights, pits
// become links.
#include "optimize/first_order_problem.hpp"

#include <thalweg/base/error.hpp>

#include <algorithm>
#include <cmath>
#include <string>

namespace thalweg {

namespace {

void check(const Tin& tin, const OptimizeOptions& options) {
  for (auto here = options.criteria.begin(); here != options.criteria.end(); ++here) {
    if (std::find(options.criteria.begin(), here, *here) == here) continue;
    throw Error(ErrorCode::Usage,
                "criterion " + std::string(traits_of(*here).name) + " is given twice; name each once");
  }
  for (const double metres : {options.horizontal_metres_per_unit, options.vertical_metres_per_unit}) {
    if (metres > 0 && std::isfinite(metres)) continue;
    throw Error(ErrorCode::Usage, "metres per unit must be positive, but are " + std::to_string(metres));
  }
  if (options.width_limit < 1 || options.width_limit > kMaxWidthLimit) {
    throw Error(ErrorCode::Usage, "the width limit must be 1 to " + std::to_string(kMaxWidthLimit) +
                                      ", but is " + std::to_string(options.width_limit));
  }
  constexpr std::size_t kMaxEdges = std::size_t{1} << 28U;  // so that sums of angles stay below 2^62 steps
  if (tin.edge_count() < kMaxEdges) return;
  throw Error(ErrorCode::SizeLimit, "the TIN has " + std::to_string(tin.edge_count()) +
                                        " edges; fewer than 268435456 can be optimised: split the area");
}

}  // namespace

FirstOrderProblem build_problem(const Tin& tin, std::span<const Quadrilateral> quadrilaterals,
                                const OptimizeOptions& options, Progress& progress) {
  check(tin, options);
  FirstOrderProblem problem;
  for (const Criterion criterion : options.criteria) {
    if (criterion == Criterion::LocalMinima) {
      problem.sums_before_pits = problem.sums.size();
      problem.counts_pits = true;
    } else {
      problem.sums.push_back(criterion);
    }
  }
  const std::vector<std::uint32_t> owner = quadrilaterals_of_triangles(tin, quadrilaterals);
  const Scale scale{options.horizontal_metres_per_unit, options.vertical_metres_per_unit};
  EdgeTerms<kSums> terms = build_edge_terms<kSums>(tin, quadrilaterals, owner, problem.sums, scale, progress);
  progress.advance(0.7);
  problem.labelling = std::move(terms.labelling);
  problem.delaunay = terms.delaunay;
  problem.rank = add_flips_and_ties<kSums>(tin, quadrilaterals, problem.labelling.unary, progress);
  progress.advance(0.9);
  if (problem.counts_pits) problem.plateaus = find_plateaus(tin, quadrilaterals, owner, progress);
  progress.advance(1);
  return problem;
}

}  // namespace thalweg
