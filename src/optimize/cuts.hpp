#pragma once

/// Connectivity as clauses: from every set of nodes that links can leave, a chosen link leaves.

#include "optimize/bucket_elimination.hpp"
#include "optimize/labelling.hpp"

#include <span>
#include <vector>

namespace thalweg {

/// At least one of these literals has to be true; any number of them, of different variables.
using Cut = std::vector<Literal>;

/// Cuts that the labels fail: in each component, around each part that chosen links connect, but for one part
/// with most links. Empty if and only if the chosen links connect all that the links connect. With no link
/// chosen these are the cuts around single nodes, which suffice where components have two nodes.
std::vector<Cut> failed_cuts(std::span<const Link> links, std::size_t node_count,
                             std::span<const Label> labels);

/// Writes cuts as clauses of three with auxiliary variables, from `next_variable` on:
/// a or b or c or d or e = (a or b or y) and (not y or c or z) and (not z or d or e). Neighbours in the chain
/// are those with close numbers. Returns the clauses; variables are added one after the other, so the first
/// free one is next_variable + the sum over cuts of max(0, size - 3).
std::vector<Clause> split_cuts(std::span<const Cut> cuts, std::span<const std::uint32_t> numbers,
                               std::uint32_t next_variable);

/// The best labelling of a problem without weights: a minimum spanning forest.
/// Links are taken in order of what their helpful label costs more than the other, as long as they connect
/// (Kruskal); such an order needs no more than an ordered group. All other variables have their cheaper
/// label.
template <std::size_t Criteria>
std::vector<Label> span_at_least_cost(const Labelling<Criteria>& problem);

}  // namespace thalweg
