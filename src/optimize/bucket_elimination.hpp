#pragma once

/// Exact minimisation by dynamic programming along an elimination order.

#include "optimize/cost.hpp"
#include "optimize/elimination_order.hpp"
#include "optimize/labelling.hpp"

#include <thalweg/base/progress.hpp>

#include <array>
#include <span>
#include <vector>

namespace thalweg {

/// True while a variable has this label.
struct Literal {
  std::uint32_t variable = kNone;
  Label label = Label::One;
};

/// At least one of at most three literals of different variables has to be true; unused ones have variable
/// kNone.
using Clause = std::array<Literal, 3>;

/// A cost paid if both variables have label 1.
template <std::size_t Criteria>
struct PairCost {
  std::uint32_t a = 0;
  std::uint32_t b = 0;
  Weight<Criteria> weight{};
};

/// A sum of small terms over variables 0 ... variable_count - 1, those beyond unary.size() at no cost of
/// their own.
template <std::size_t Criteria>
struct TermSum {
  std::size_t variable_count = 0;
  std::span<const Cost<Criteria>> unary;
  std::span<const PairCost<Criteria>> pairs;
  std::span<const Clause> clauses;
  const Tables<Criteria>* tables = nullptr;  ///< null: none
};

/// The pairs of variables that share a term.
template <std::size_t Criteria>
std::vector<NodePair> interactions(const TermSum<Criteria>& sum);

template <std::size_t Criteria>
struct Minimum {
  std::vector<Label> label;
  Cost<Criteria> value;  ///< infeasible if no labelling meets all clauses
};

/// A labelling of least cost. Pre: `order` is complete for the interactions.
/// Complexity: 2^(w + 1) per variable whose scope has size w, time and space; space of a table is freed after
/// its use.
template <std::size_t Criteria>
Minimum<Criteria> minimise(const TermSum<Criteria>& sum, const EliminationOrder& order,
                           const Progress& progress);

}  // namespace thalweg
