#pragma once

/// Delaunay triangulation of some of the vertices by inserting one after the other.

#include "cells.hpp"

#include <thalweg/base/progress.hpp>

#include <cstdint>
#include <span>

namespace thalweg::detail {

/// Number of cells, ghosts included, of a triangulation of that many vertices.
constexpr std::size_t cell_count(std::size_t vertices) {
  return 2 * vertices - 2;
}

/// Triangulates `vertices`, in this order, but for the first triangle; fast if those that follow each other
/// are close. Writes `cell_count(vertices.size())` cells to cells[first_cell ...], ghosts included; sides
/// name cells by their index in `cells`.
/// Returns false, and leaves the cells undefined, if all vertices are collinear or fewer than three.
/// Pre: distinct positions. Throws: Error{Cancelled}. Complexity: n log n in practice, see insertion order.
bool insert_all(const Positions& at, std::span<const std::uint32_t> vertices, std::span<Cell> cells,
                std::uint32_t first_cell, const Progress& progress);

}  // namespace thalweg::detail
