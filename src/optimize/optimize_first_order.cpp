// Chooses the diagonals of the first-order structure.
#include <thalweg/base/error.hpp>
#include <thalweg/optimize/optimize.hpp>

namespace thalweg {

OptimizeResult optimize_first_order(const Tin& /*tin*/, std::span<const Quadrilateral> quadrilaterals,
                                    const OptimizeOptions& options, Progress& progress) {
  progress.check();
  if (!options.criteria.empty()) {
    throw Error(ErrorCode::Unsupported, "no criterion can be optimised by this build; choose none");
  }
  OptimizeResult result;
  result.flipped.assign(quadrilaterals.size(), 0);
  result.quadrilaterals = quadrilaterals.size();
  return result;
}

}  // namespace thalweg
