#pragma once

/// Objectives that are sums over triangles and interior edges, as costs of labels.

#include "optimize/labelling.hpp"
#include "optimize/term_scan.hpp"
#include "optimize/vertex_terms.hpp"

#include <thalweg/base/progress.hpp>
#include <thalweg/optimize/criterion.hpp>

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace thalweg {

/// Sums of many terms in steps: beyond 64 bits.
__extension__ using WideSteps = __int128;

/// Adds the objective to one level of unary costs, weights and tables, maximised ones with their sign turned.
/// Returns the level's value on the given TIN. Terms of vertices that are too wide for a table are left out.
/// Pre: the labelling has its rows.
/// Throws: Error{SizeLimit} if sums of the level could overflow. Complexity: linear, on all threads.
template <std::size_t Criteria>
WideSteps add_objective(const TermScan& scan, const Objective& objective, std::size_t level,
                        Labelling<Criteria>& labelling, const Progress& progress);

/// What is left out of an objective's costs, in steps, beyond its value on the given TIN.
struct LeftOut {
  WideSteps value = 0;  ///< under the labels
  WideSteps least = 0;  ///< no labels give less
};
LeftOut find_left_out(const TermScan& scan, const Objective& objective, std::span<const Label> label,
                      const Progress& progress);

/// An objective that is the worst of its terms, in steps, signs turned where it is maximised: less is better.
struct Extreme {
  std::int64_t delaunay = 0;  ///< of the given TIN
  /// What the value may be, ascending; the first is a bound that each term alone gives.
  std::vector<std::int64_t> values;
  std::optional<VertexTerms> vertex;  ///< its terms, if they are of vertices
};
Extreme find_extreme(const TermScan& scan, const Objective& objective, std::span<const std::uint32_t> first,
                     const Progress& progress);

/// Its value under labels. Pre: none is Open. `known`: its terms of vertices, if they are at hand.
std::int64_t extreme_of(const TermScan& scan, const Objective& objective,
                        std::span<const std::uint32_t> first, std::span<const Label> label,
                        const Progress& progress, const VertexTerms* known = nullptr);

/// Stars too wide for a table, in a count of excess. Relaxed: a label costs if it keeps the star from every
/// one within the limit. Least: a label costs if it keeps the star from the least of its values.
enum class WideStars : std::uint8_t { Relaxed, Least };

/// What of an extreme's terms is counted.
struct ExcessOptions {
  std::int64_t most = 0;                  ///< in steps: terms that are worse count
  const VertexTerms* vertex = nullptr;    ///< Extreme::vertex, if the terms are of vertices
  std::span<const std::uint8_t> counted;  ///< of the tables of vertices, those with 1; empty: all
  WideStars wide = WideStars::Relaxed;
};

/// Puts into one level of costs, which is emptied first, the number of terms that are worse than `most`.
/// Returns how many no label changes and how many label 0 everywhere has: the constant of the level.
template <std::size_t Criteria>
std::int64_t count_excess(const TermScan& scan, const Objective& objective, const ExcessOptions& options,
                          std::size_t level, Labelling<Criteria>& labelling, const Progress& progress);

/// Marks, among the tables of vertices, those whose value under the labels is worse than `most`. Returns
/// whether any is new.
bool mark_excess(const VertexTerms& terms, const Objective& objective, std::int64_t most,
                 std::span<const Label> label, std::vector<std::uint8_t>& marked);

}  // namespace thalweg
