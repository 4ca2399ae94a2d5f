#pragma once

/// A CRS that is described by GeoTIFF keys, outside of a TIFF.

#include <ogr_spatialref.h>

#include <string>
#include <vector>

namespace thalweg {

/// The records that hold the keys, as bytes in little-endian order: the directory (TIFF tag 34735), its
/// doubles (34736) and its texts (34737); the last two may be empty.
struct GeotiffKeys {
  std::vector<unsigned char> directory;
  std::vector<unsigned char> doubles;
  std::vector<unsigned char> texts;
};

/// What the keys describe, be it by EPSG codes or by parameters; empty if GDAL makes no CRS of them.
OGRSpatialReference reference_of_keys(const GeotiffKeys& keys);

}  // namespace thalweg
