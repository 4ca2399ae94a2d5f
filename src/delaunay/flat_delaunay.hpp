#pragma once

/// The Delaunay triangulation of points, on flat arrays and all threads.

#include "cells.hpp"

#include <thalweg/base/progress.hpp>
#include <thalweg/base/raw_vector.hpp>

#include <vector>

namespace thalweg::detail {

/// The cells of the Delaunay triangulation of all vertices, ghosts included; empty if all are collinear.
/// Pre: distinct positions; vertices near in the plane have near ids (as along a Hilbert curve), or it is
/// slow. The triangulation does not depend on the number of threads; how cells are numbered does.
/// Throws: Error{Cancelled}. Complexity: n log n in practice.
RawVector<Cell> delaunay_cells(const Positions& at, const Progress& progress);

}  // namespace thalweg::detail
