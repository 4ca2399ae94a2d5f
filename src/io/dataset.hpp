#pragma once

/// Datasets as GDAL opens them, and the choice of a layer.

#include <thalweg/io/source.hpp>

#include <gdal_priv.h>

#include <string>
#include <vector>

namespace thalweg {

/// What a layer shall hold.
enum class LayerUse {
  Points,
  Lines  ///< or polygons
};

/// A dataset, and what opening it told about its CRS.
struct OpenedDataset {
  GDALDatasetUniquePtr dataset;
  /// " (GDAL's words)" about one that could not be resolved; empty if there are none.
  std::string crs_errors;
  bool has_default_crs = false;  ///< the driver takes a CRS where a file's own cannot be resolved
  bool is_vrt = false;
};

/// Opens a file, virtual path or connection for reading, as layers, or, for points, as a raster too.
/// Throws: Error{NotFound}, Error{Unreadable} in GDAL's words, Error{BadFormat} for a NetCDF file that is cut
/// off.
OpenedDataset open_dataset(const std::string& path, LayerUse use);

/// Whether the file declares a CRS that GDAL could not resolve, and gave this in its place, as far as GDAL
/// tells: where it gives no sign, the file passes for one without a CRS.
bool lacks_declared_crs(const OpenedDataset& opened, const OGRSpatialReference* given);

/// The layer that the source names, or the only one that can hold what is wanted.
/// Throws: Error{NotFound} if it is not there, Error{WrongGeometry} if it or none can hold what is wanted,
/// Error{Usage} if several can; all of them list the layers that there are.
OGRLayer& choose_layer(GDALDataset& dataset, const SourceSpec& source, LayerUse use);

/// True if a layer of this type can hold what is wanted; layers of any geometry can.
bool can_hold(OGRwkbGeometryType type, LayerUse use);

/// "Line String" for people: "lines", "polygons", ...
std::string name_of_geometry(OGRwkbGeometryType type);

/// The files that a source is read from, as far as its name and, for a virtual one (.vrt), its content tell:
/// itself, what belongs to it (.prj, .dbf), and the archive that it is in.
std::vector<std::string> files_of_source(const std::string& path);

}  // namespace thalweg
