#pragma once

/// CRS definitions as GDAL's objects.

#include <thalweg/io/crs.hpp>

#include <ogr_spatialref.h>

#include <optional>
#include <string>

namespace thalweg {

/// Reads a definition as `describe_crs` does; x is east or longitude whatever the definition says.
/// Throws: Error{BadCrs}. Pre: the definition is not empty.
OGRSpatialReference parse_reference(const std::string& definition);

/// Whether two references mean the same CRS, whatever the order of their axes.
bool means_same_crs(const OGRSpatialReference& a, const OGRSpatialReference& b);

/// The compound CRS of a reference without a vertical part and heights in this unit above no known datum;
/// none for a local CRS, which cannot be a part of one.
std::optional<OGRSpatialReference> with_heights_in(const OGRSpatialReference& plane, double metres_per_unit);

/// A reference without its vertical part.
OGRSpatialReference horizontal_part(const OGRSpatialReference& reference);

/// Whether a layer without a CRS says so by this reference: GeoPackage has two names for "none".
bool means_none(const OGRSpatialReference& reference);

/// What a reference says; an empty one is the unknown CRS.
/// Throws: Error{BadCrs} naming `origin`, if the CRS has no plane.
CrsInfo describe_reference(const OGRSpatialReference& reference, const std::string& origin);

}  // namespace thalweg
