#pragma once

/// Divides a problem until its pieces are narrow, and solves those.

#include "optimize/labelling.hpp"

#include <thalweg/base/progress.hpp>

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace thalweg {

/// What was done, for the report.
struct SolverFigures {
  std::size_t fixed_by_elimination = 0;
  std::size_t pieces = 0;  ///< left by elimination
  std::size_t largest_piece = 0;
  std::size_t width = 0;
  std::uint64_t table_entries = 0;
  bool used_tables = false;
  bool used_forests = false;
  bool used_roof_duality = false;
  bool used_relaxation = false;
};

/// A labelling that connects what can be connected, and how good it is.
template <std::size_t Criteria>
struct Solution {
  std::vector<Label> label;
  Cost<Criteria> value;  ///< of the labels
  Cost<Criteria> bound;  ///< no labelling that connects what can be connected costs less
  SolverFigures figures;
};

/// Called for a piece that is wider than the limit, with its variables; several pieces at the same time.
template <std::size_t Criteria>
using WideSolver = std::function<Solution<Criteria>(const Labelling<Criteria>& piece,
                                                    std::span<const std::uint32_t> variables)>;

/// The result does not depend on the number of threads. Complexity: linear but for wide pieces; runs on all
/// threads.
template <std::size_t Criteria>
Solution<Criteria> decompose(const Labelling<Criteria>& problem, std::uint32_t width_limit,
                             const WideSolver<Criteria>& solve_wide, const Progress& progress);

/// The problem that is left when variables are fixed; `open` lists those that are Open in `label`.
template <std::size_t Criteria>
Labelling<Criteria> fix_labels(const Labelling<Criteria>& problem, std::span<const Label> label,
                               std::span<const std::uint32_t> open);

}  // namespace thalweg
