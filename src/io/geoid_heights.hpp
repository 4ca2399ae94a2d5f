#pragma once

/// Heights of a survey from the ellipsoid to the geoid, or back.

#include "io/source_reader.hpp"

namespace thalweg {

/// Takes the geoid's heights off those of the run's points and hard lines, or adds them, as its options say,
/// and notes how much that was. `survey` is the frame that its sources were read into. Throws: Error{BadCrs}
/// where the CRS is unknown; Error{Usage} where it tells itself what its heights are above; and what `Geoid`
/// throws.
void apply_geoid(const Frame& survey, ReadContext& run);

}  // namespace thalweg
