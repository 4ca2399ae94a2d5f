#pragma once

/// What to say where the standard order leaves no triangulation.

#include "pipeline/surface.hpp"

#include <thalweg/base/error.hpp>

namespace thalweg {

/// The error for a run whose lines allow no triangulation of order at most `labelling.order` under its
/// definition; under Std it names the interval of the smallest order, and the edge and triangles that give
/// it. Throws: Error{Cancelled}.
Error no_triangulation(const Terrain& terrain, const LabellingConfig& labelling, Progress& progress);

}  // namespace thalweg
