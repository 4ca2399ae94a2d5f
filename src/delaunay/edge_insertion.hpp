#pragma once

/// Constraint edges for a Delaunay triangulation made of cells.

#include "cells.hpp"
#include "engine.hpp"

#include <thalweg/base/progress.hpp>

#include <optional>
#include <span>

namespace thalweg::detail {

/// Why an edge cannot be inserted.
struct EdgeFault {
  VertexPair edge;
  /// The vertex that lies inside it; none: it crosses another constraint edge.
  std::optional<std::uint32_t> vertex;
};

/// Makes each of the edges a side of two cells, marks it, and keeps all else
/// constrained Delaunay. Stops at the first edge that cannot be, and leaves the cells undefined then.
/// Pre: cells as of `delaunay_cells`. Throws: Error{Cancelled}. Complexity: the cells that an edge crosses,
/// and the flips that make its surroundings Delaunay again: few times as many in practice.
std::optional<EdgeFault> insert_edges(const Positions& at, std::span<Cell> cells,
                                      std::span<const DrawnEdge> edges, const Progress& progress);

}  // namespace thalweg::detail
