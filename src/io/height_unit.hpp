#pragma once

/// Units of lengths as mesh files and rasters tell them.

#include <thalweg/io/read_tin.hpp>

#include <optional>
#include <string>
#include <string_view>

namespace thalweg {

/// Metres of a unit by name ("ft", "US survey foot"), or of so many metres ("0.3048 m"); none if it is not
/// told or not known.
std::optional<double> metres_of_unit(std::string_view name);

/// The definition of a CRS of which the unit alone is known; empty for metres.
std::string local_crs(const std::string& unit, double metres_per_unit);

/// The unit of heights that a file tells, but its CRS does not, becomes a part of that. Where the CRS is
/// unknown or local, heights are brought to its unit, and a note says so; where it tells another unit itself,
/// that counts, and a note says so. `path` is for notes. Throws: Error{BadCrs}.
void take_height_unit(TinFile& tin, double metres_per_unit, const std::string& path);

}  // namespace thalweg
