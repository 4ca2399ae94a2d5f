#pragma once

/// The last levels of every problem: fewest flips, then the tie rule.

#include <thalweg/base/progress.hpp>
#include <thalweg/mesh/tin.hpp>
#include <thalweg/order/quadrilaterals.hpp>

#include <cstdint>
#include <span>

namespace thalweg {

/// What the tie rule charges for the thing of a rank, of which there are `count`; no sum of different ones
/// overflows.
std::int64_t tie_of(std::uint64_t rank, std::size_t count);

/// The tie rule: what each flip costs last of all. It is made of where the ends of the Delaunay diagonal lie
/// in the box of all vertices, so no translation, renumbering or reordering changes it, nor does a power of
/// two as scale; cut to so many bits that no sum overflows, and never 0. Two different labellings that agree
/// in everything before agree in that sum by chance only (one in 2^40 at a million quadrilaterals). Writes
/// one a quadrilateral. Complexity: linear, on all threads.
void find_ties(const Tin& tin, std::span<const Quadrilateral> quadrilaterals, std::span<std::int64_t> ties,
               const Progress& progress);

}  // namespace thalweg
