#pragma once

/// Labels that every optimum, or one, must have, found in near-linear time.

#include "base/union_find.hpp"
#include "optimize/labelling.hpp"

#include <thalweg/base/progress.hpp>

#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace thalweg {

/// Variables whose links are undecided, and for each the set of links that must stay connected together.
class LinkBlocks {
 public:
  LinkBlocks() = default;
  /// Pre: `variables` ascend, below `count`; one block each.
  LinkBlocks(std::size_t count, std::vector<std::uint32_t> variables, std::vector<std::uint32_t> blocks)
      : variables_(std::move(variables)),
        blocks_(std::move(blocks)),
        listed_(variables_.empty() ? 0 : count) {
    for (const std::uint32_t q : variables_) listed_[q] = true;
  }
  /// The block of a variable, or kNone. Complexity: constant for most variables, log n for those in blocks.
  [[nodiscard]] std::uint32_t of(std::uint32_t variable) const {
    if (listed_.empty() || !listed_[variable]) return kNone;
    return blocks_[static_cast<std::size_t>(std::ranges::lower_bound(variables_, variable) -
                                            variables_.begin())];
  }
  [[nodiscard]] std::span<const std::uint32_t> variables() const { return variables_; }
  [[nodiscard]] std::span<const std::uint32_t> blocks() const { return blocks_; }

 private:
  std::vector<std::uint32_t> variables_, blocks_;
  std::vector<bool> listed_;  ///< by variable
};

struct Reduction {
  std::vector<Label> label;  ///< by variable
  LinkBlocks links;
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

/// Connected components of the open variables, through non-zero weights and through common blocks. Their
/// order does not depend on the number of threads. Complexity: linear.
template <std::size_t Criteria>
Partition split(const Labelling<Criteria>& problem, const Reduction& reduction, const Progress& progress);

}  // namespace thalweg
