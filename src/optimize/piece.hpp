#pragma once

/// Part of a problem as a problem of its own.

#include "optimize/cuts.hpp"
#include "optimize/labelling.hpp"
#include "optimize/reduction.hpp"

#include <thalweg/base/progress.hpp>

#include <optional>
#include <span>

namespace thalweg {

/// Variables of a problem, and for each of them its index among them.
struct Selection {
  std::span<const std::uint32_t> variables;
  std::span<const std::uint32_t> index;  ///< by variable of the whole problem; read for selected ones only
};

/// The problem of the selected variables, given the labels of all others: costs of fixed neighbours are
/// folded in, nodes that `fixed.nodes` connects are one, links of different blocks have no node in common.
/// Rows of neighbours are sorted, nodes are numbered in order of first appearance: the numbering of the whole
/// problem leaves no trace but the order of the selection and the direction of links. Pre: of the variables
/// that share a weight with a selected one, all that are Open are selected.
template <std::size_t Criteria>
Labelling<Criteria> restrict_to(const Labelling<Criteria>& problem, const Reduction& fixed,
                                std::span<const std::uint32_t> node, const Selection& selection);

/// Cost of a labelling. Complexity: linear.
template <std::size_t Criteria>
Cost<Criteria> cost_of(const Labelling<Criteria>& problem, std::span<const Label> label);

template <std::size_t Criteria>
std::vector<PairCost<Criteria>> pairs_of(const Labelling<Criteria>& problem);

/// Cuts as short clauses, whose auxiliary variables follow those of the problem. Where the terms alone are
/// wider than the limit, no order along long cuts is looked for.
struct Clauses {
  std::vector<Clause> clauses;
  std::size_t variable_count = 0;  ///< auxiliary ones included
};

template <std::size_t Criteria>
Clauses shorten(const Labelling<Criteria>& problem, std::span<const PairCost<Criteria>> pairs,
                std::span<const Cut> cuts, std::uint32_t width_limit);

struct ExactLabels {
  std::vector<Label> label;
  std::uint32_t width = 0;
  std::uint64_t table_entries = 0;  ///< 0: no table was needed
  std::vector<Clause> clauses;      ///< of the last table: those of the cuts, in their order
  EliminationOrder order;
};

/// An optimal labelling, or nothing if that needs a table wider than the limit.
template <std::size_t Criteria>
std::optional<ExactLabels> solve_exactly(const Labelling<Criteria>& problem, std::uint32_t width_limit,
                                         const Progress& progress);

}  // namespace thalweg
