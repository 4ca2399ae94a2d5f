#pragma once

/// Labels that every optimum, or one, must have, found in near-linear time.

#include "base/union_find.hpp"
#include "optimize/labelling.hpp"

#include <thalweg/base/progress.hpp>

#include <vector>

namespace thalweg {

struct Reduction {
  std::vector<Label> label;  ///< by variable
  std::vector<std::uint32_t>
      block;  ///< by variable: the set of links that must stay connected together, or kNone
  std::uint32_t block_count = 0;
  UnionFind nodes{0};  ///< nodes that chosen links connect
};

/// Fixes labels such that an optimum of the problem has them; what stays Open is undecided.
/// The result does not depend on the order of variables, unless costs tie at all levels.
/// Complexity: linear for each round, of which there are few; the first one runs on all threads.
template <std::size_t Criteria>
Reduction reduce(const Labelling<Criteria>& problem, const Progress& progress);

/// Open variables that depend on each other: part i is variable[first[i]] to variable[first[i + 1]].
struct Partition {
  std::vector<std::uint32_t> first = {0};
  std::vector<std::uint32_t> variable;
  [[nodiscard]] std::size_t size() const { return first.size() - 1; }
};

/// Connected components of the open variables, through non-zero weights and through common blocks. Their order
/// does not depend on the number of threads. Complexity: linear.
template <std::size_t Criteria>
Partition split(const Labelling<Criteria>& problem, const Reduction& reduction, const Progress& progress);

}  // namespace thalweg
