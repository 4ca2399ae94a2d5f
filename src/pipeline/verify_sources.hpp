#pragma once

/// The sources of a TIN, for the verifier: read as `build` reads them, but neither noded nor densified.

#include "pipeline/plane.hpp"

#include <thalweg/io/source.hpp>
#include <thalweg/verify/sources.hpp>

#include <span>
#include <vector>

namespace thalweg {

/// Brings a survey to the plane. Where a line bends between its source's coordinates and the plane, points on
/// the way are put in. `snapping_pixel`: how far noding may have moved lines, in plane units; 0: what it does
/// for coordinates of this size.
verify::Sources sources_in_plane(const Survey& survey, const Plane& plane, double snapping_pixel,
                                 const Progress& progress);

}  // namespace thalweg
