// The sums of the first-order optimiser, where nothing is to be chosen.
#include "optimize/objective_value.hpp"

#include "optimize/declaration.hpp"
#include "optimize/face_pits.hpp"

#include <cstdint>
#include <vector>

namespace thalweg {

WideSteps value_on(const Tin& tin, const Objective& objective, Scale scale, const Reference* reference,
                   const Progress& progress) {
  if (objective.is(Criterion::LocalMinima)) return static_cast<WideSteps>(count_pits(tin));
  const std::vector<std::uint32_t> owner(tin.triangle_count(), kNone);
  const TermScan scan(tin, {}, owner, scale, reference);
  Labelling<1> none;
  if (objective.is_extreme()) return extreme_of(scan, objective, none.first, {}, progress);
  return add_objective(scan, objective, 0, none, progress);
}

double in_units(WideSteps steps, const Objective& objective) {
  if (steps == 0) return 0;  // never -0
  const double per_unit = objective.is(Criterion::LocalMinima) ? 1 : steps_per_unit(objective);
  return static_cast<double>(steps) / per_unit;
}

}  // namespace thalweg
