#pragma once

/// In which order a dynamic program eliminates its variables.

#include "optimize/blocks.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace thalweg {

/// An order, with the later variables that each one meets when it is eliminated: its scope, in order of
/// elimination.
struct EliminationOrder {
  std::vector<std::uint32_t> order;     ///< variables, first eliminated first
  std::vector<std::uint32_t> position;  ///< inverse of order
  std::vector<std::uint32_t> first;     ///< the scope of order[i] is scope[first[i]] to scope[first[i + 1]]
  std::vector<std::uint32_t> scope;
  std::uint32_t width = 0;  ///< size of the largest scope
  bool complete = false;    ///< false: a scope was larger than the limit, and the order ends before it

  [[nodiscard]] std::span<const std::uint32_t> scope_at(std::size_t i) const {
    return std::span(scope).subspan(first[i], first[i + 1] - first[i]);
  }
};

/// Greedy: next is the variable whose elimination joins the fewest pairs that were apart; then the one with
/// the smallest scope; then the lowest. Pre: edges join different variables below `count`. Complexity: n w^3
/// log n for width w.
EliminationOrder find_elimination_order(std::size_t count, std::span<const NodePair> edges,
                                        std::uint32_t width_limit);

/// Table entries that a dynamic program along the order fills.
std::uint64_t table_entries(const EliminationOrder& order);

/// Variables without which the same greedy order stays within the width limit; where it would not, the
/// variable is taken out, of those in the scope, that was least often in `times` before, then the one with
/// most neighbours.
std::vector<std::uint32_t> find_cutset(std::size_t count, std::span<const NodePair> edges,
                                       std::uint32_t width_limit, std::span<const std::uint32_t> times);

/// Numbers of the variables such that those that are eliminated close to each other have close numbers: a
/// walk through the elimination tree, children first. Pre: order.complete.
std::vector<std::uint32_t> tree_numbers(const EliminationOrder& order);

}  // namespace thalweg
