#pragma once

/// What a report says of water: heights that changed for it, and whether drawn valleys and ridges hold.

#include <thalweg/pipeline/condition.hpp>
#include <thalweg/terrain/consistency.hpp>

#include <cstddef>
#include <string>
#include <vector>

namespace thalweg {

/// A height that conditioning changed, under the ids and at the place of the outputs, in the TIN's unit.
struct ReportChange {
  std::size_t vertex = 0;
  double x = 0, y = 0;
  double before = 0, after = 0;
  std::string step;
};

struct ReportConditioned {
  std::vector<std::string> steps;  ///< as asked for
  ConditionReport figures;
  std::vector<ReportChange> changes;
};

/// Of drawn valleys and ridges, if there are any.
struct ReportConsistency {
  Consistency delaunay, result;  ///< places under the ids of the outputs
};

}  // namespace thalweg
