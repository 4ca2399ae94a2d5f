#pragma once

/// Why the worst term cannot be better: implications from a label to the other one and back.

#include "optimize/term_scan.hpp"

#include <thalweg/base/progress.hpp>

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace thalweg {

/// Variables of terms none of whose labellings keeps all of these terms at `most` or below, in an order in
/// which few depend on each other; none if some labelling does so, or if terms
/// depend on more than two variables. Empty: a term that alone is beyond.
/// Steps and signs as in `find_extreme`. Complexity: linear.
std::optional<std::vector<std::uint32_t>> find_conflict(const TermScan& scan, const Objective& objective,
                                                        std::span<const std::uint32_t> first,
                                                        std::int64_t most, std::size_t variable_count,
                                                        const Progress& progress);

}  // namespace thalweg
