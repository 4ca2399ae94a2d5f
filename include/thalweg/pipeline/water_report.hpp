#pragma once

/// What a run tells of water: pits, drawn lines before and after, and heights that conditioning changed.

#include <thalweg/pipeline/condition.hpp>
#include <thalweg/terrain/consistency.hpp>

#include <cstddef>
#include <string>
#include <vector>

namespace thalweg {

struct ReportPits {
  std::size_t interior = 0;
  std::size_t boundary = 0;
  std::size_t lake = 0;
};

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
