#pragma once

/// GDAL's drivers by name or extension, for writing.

#include <cpl_string.h>
#include <gdal_priv.h>

#include <string>
#include <vector>

namespace thalweg {

enum class DriverUse { Raster, Vector };

/// The driver of the short name `format`, any case, or, if that is empty, the first one for the path's
/// extension, of those that write files; none if there is none. Pre: a GdalSession lives.
GDALDriver* find_output_driver(const std::string& path, const std::string& format, DriverUse use);

/// Creation options that a driver knows, by what takes them.
struct DriverOptions {
  CPLStringList dataset, layer;
};

/// Sorts options K=V of a user. Throws: Error{Usage} where the driver does not know one, or its value.
DriverOptions sort_options(GDALDriver& driver, const std::vector<std::string>& options, DriverUse use);

/// Whether the driver holds values of that type; true if it does not say.
bool holds_type(GDALDriver& driver, GDALDataType type);

}  // namespace thalweg
