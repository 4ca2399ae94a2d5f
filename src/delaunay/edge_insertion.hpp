#pragma once

/// Constraint edges for a Delaunay triangulation made of cells.

#include "cells.hpp"
#include "engine.hpp"

#include <thalweg/base/progress.hpp>

#include <optional>
#include <span>

namespace thalweg::detail {

/// Makes each of the edges a side of two cells, marks it, and keeps all else constrained Delaunay, on so many
/// threads. Returns an edge that cannot be, as it crosses another one or a vertex, and leaves the cells
/// undefined then; on one thread it is the first such edge. Pre: cells as of `delaunay_cells`; edges are
/// sorted. Throws: Error{Cancelled}. Complexity: the cells that an edge crosses, and the flips that make its
/// surroundings Delaunay again: few times as many in practice.
std::optional<VertexPair> insert_edges(const Positions& at, std::span<Cell> cells,
                                       std::span<const DrawnEdge> edges, std::size_t threads,
                                       const Progress& progress);

}  // namespace thalweg::detail
