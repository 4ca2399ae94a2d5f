#pragma once

/// Points from elevation rasters.

#include "io/source_reader.hpp"

#include <gdal_priv.h>

#include <memory>
#include <optional>
#include <string>

namespace thalweg {

/// Throws: Error{Unsupported} for rasters without georeference, with rotated control points, or of complex
/// numbers.
std::unique_ptr<SourceReader> open_raster(const SourceSpec& spec, GDALDatasetUniquePtr dataset);

/// Metres of a band's unit; none if it is not told or not known.
std::optional<double> metres_of_unit(std::string unit);

}  // namespace thalweg
