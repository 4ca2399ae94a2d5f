#pragma once

/// Sources that belong to a TIN: outlets, lines of a profile, a reference.

#include <thalweg/io/crs.hpp>
#include <thalweg/io/source.hpp>

#include <span>

namespace thalweg {

/// Reads sources into the CRS and unit of heights of a TIN; as they are where that or theirs is not known.
/// They are read twice if their CRS is another one. Throws: what `read_survey` throws.
ReadResult read_in_crs(std::span<const SourceSpec> points, std::span<const LineSource> lines,
                       ReadOptions options, const CrsInfo& crs, Progress& progress);

}  // namespace thalweg
