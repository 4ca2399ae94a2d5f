#pragma once

/// Reference heights for vertical-error, read into the plane of a run.

#include "pipeline/plane.hpp"

#include <thalweg/io/source.hpp>

#include <vector>

namespace thalweg {

struct ReferencePoints {
  std::vector<Point2> points;   ///< in the plane
  std::vector<double> heights;  ///< in the run's unit of heights
};

/// Reads a DEM (its valid cell centres) or points. A reference in another CRS is transformed; one without CRS
/// is taken to be in the run's. Throws: what reading throws.
ReferencePoints read_reference(const SourceSpec& source, const CrsInfo& crs, const Plane& plane,
                               Progress& progress);

}  // namespace thalweg
