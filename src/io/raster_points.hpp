#pragma once

/// Points from elevation rasters.

#include "io/dataset.hpp"
#include "io/source_reader.hpp"

#include <memory>

namespace thalweg {

/// Throws: Error{Unsupported} for rasters without georeference, with rotated control points, or of complex
/// numbers.
std::unique_ptr<SourceReader> open_raster(const SourceSpec& spec, OpenedDataset opened);

}  // namespace thalweg
