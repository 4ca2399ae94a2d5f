#pragma once

/// GDAL's drivers by name or extension, for writing.

#include <gdal_priv.h>

#include <string>

namespace thalweg {

enum class DriverUse { Raster, Vector };

/// The driver of the short name `format`, any case, or, if that is empty, the first one for the path's
/// extension, of those that write files; none if there is none. Pre: a GdalSession lives.
GDALDriver* find_output_driver(const std::string& path, const std::string& format, DriverUse use);

}  // namespace thalweg
