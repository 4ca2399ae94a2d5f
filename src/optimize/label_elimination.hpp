#pragma once

/// Dynamic programming over a network of variables with many labels: exact while tables are small, else a
/// bound.

#include "optimize/label_network.hpp"

#include <thalweg/base/progress.hpp>

#include <cstdint>
#include <vector>

namespace thalweg {

template <std::size_t Criteria>
struct Eliminated {
  std::vector<std::uint32_t> chosen;  ///< labels, counted from each variable's first one
  Cost<Criteria> bound;               ///< no choice costs less
  bool exact = true;                  ///< the choice costs no more than the bound
  std::uint64_t largest_table = 0;    ///< entries
  std::uint64_t table_entries = 0;    ///< of all tables
};

/// Eliminates the variables one by one. A table that would have more than `most_entries` entries is divided
/// into several, each minimised by itself. Complexity: the entries of all tables, time and space.
template <std::size_t Criteria>
Eliminated<Criteria> eliminate(const LabelNetwork<Criteria>& network, std::uint64_t most_entries,
                               const Progress& progress);

}  // namespace thalweg
