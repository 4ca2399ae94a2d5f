#pragma once

/// Criteria that are sums over interior edges, as costs of labels.

#include "optimize/labelling.hpp"
#include "optimize/normal_angle.hpp"

#include <thalweg/base/progress.hpp>
#include <thalweg/mesh/tin.hpp>
#include <thalweg/optimize/criterion.hpp>
#include <thalweg/order/quadrilaterals.hpp>

#include <array>
#include <span>
#include <vector>

namespace thalweg {

/// The quadrilateral of each triangle, or kNone. Throws: Error{Unsupported} if two of them share a triangle.
/// Complexity: linear.
std::vector<std::uint32_t> quadrilaterals_of_triangles(const Tin& tin,
                                                       std::span<const Quadrilateral> quadrilaterals);

/// Unary costs and weights in steps, and the value of the given TIN.
template <std::size_t Criteria>
struct EdgeTerms {
  Labelling<Criteria> labelling;  ///< without links; flips and ties are still 0
  std::array<std::int64_t, Criteria> delaunay{};
};

/// Level i holds criteria[i]; levels without a criterion are 0. A label 1 flips.
/// Pre: at most `Criteria` criteria, all coupled by Edge. Complexity: linear, on all threads.
template <std::size_t Criteria>
EdgeTerms<Criteria> build_edge_terms(const Tin& tin, std::span<const Quadrilateral> quadrilaterals,
                                     std::span<const std::uint32_t> owner,
                                     std::span<const Criterion> criteria, Scale scale,
                                     const Progress& progress);

/// Adds to each unary cost one flip, and a number that makes the optimum unique.
///
/// The tie rule: quadrilaterals are ranked by their sorted corners (x, then y), which no translation,
/// renumbering or reordering changes; a flip costs splitmix64(rank), cut to so many bits that no sum
/// overflows. Two different labellings that agree in everything before agree in that sum by chance only (40
/// bits at a million quadrilaterals). Returns the ranks. Complexity: n log n, on all threads.
template <std::size_t Criteria>
std::vector<std::uint32_t> add_flips_and_ties(const Tin& tin, std::span<const Quadrilateral> quadrilaterals,
                                              std::vector<Cost<Criteria>>& unary, const Progress& progress);

}  // namespace thalweg
