// A CRS out of GeoTIFF keys: GDAL reads them in a TIFF alone, so the smallest there is, one cell large, is
// written around them in memory. Based on: TIFF, Revision 6.0, 1992, section 2; OGC 19-008r4, GeoTIFF 1.1.
#include "io/geotiff_keys.hpp"

#include "io/gdal_session.hpp"

#include <cpl_vsi.h>
#include <gdal_priv.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string>

namespace thalweg {

namespace {

using ByteArray = std::vector<unsigned char>;

void put(ByteArray& bytes, std::uint64_t value, std::size_t width) {
  for (std::size_t i = 0; i < width; ++i) bytes.push_back(static_cast<unsigned char>(value >> 8 * i));
}

/// One entry of a TIFF's directory; its values stand in it if they fit, else behind the directory.
struct Entry {
  unsigned tag;
  unsigned type;  ///< 2 text, 3 of two bytes, 12 double
  std::size_t width;
  ByteArray values;
};

ByteArray tiff_of(const GeotiffKeys& keys) {
  constexpr unsigned kText = 2, kShort = 3, kDouble = 12;
  constexpr std::size_t kHeader = 8, kInEntry = 4;
  std::vector<Entry> entries;
  const auto add_number = [&](unsigned tag, std::uint64_t value) {
    entries.push_back({tag, kShort, 2, {}});
    put(entries.back().values, value, 2);
  };
  add_number(256, 1);  // columns, rows, bits a cell, compression none, black is 0
  add_number(257, 1);
  add_number(258, 8);
  add_number(259, 1);
  add_number(262, 1);
  add_number(273, kHeader);  // where the one cell lies: any byte will do
  add_number(277, 1);
  add_number(278, 1);
  add_number(279, 1);
  entries.push_back({34735, kShort, 2, keys.directory});
  if (!keys.doubles.empty()) entries.push_back({34736, kDouble, 8, keys.doubles});
  if (!keys.texts.empty()) entries.push_back({34737, kText, 1, keys.texts});

  ByteArray tiff = {'I', 'I', 42, 0, kHeader, 0, 0, 0};
  ByteArray behind;
  const std::size_t behind_at = kHeader + 2 + entries.size() * 12 + 4;
  put(tiff, entries.size(), 2);
  for (Entry& entry : entries) {
    put(tiff, entry.tag, 2);
    put(tiff, entry.type, 2);
    put(tiff, entry.values.size() / entry.width, 4);
    if (entry.values.size() > kInEntry) {
      put(tiff, behind_at + behind.size(), 4);
      behind.insert(behind.end(), entry.values.begin(), entry.values.end());
      if (behind.size() % 2 != 0) behind.push_back(0);
    } else {
      entry.values.resize(kInEntry);
      tiff.insert(tiff.end(), entry.values.begin(), entry.values.end());
    }
  }
  put(tiff, 0, 4);
  tiff.insert(tiff.end(), behind.begin(), behind.end());
  return tiff;
}

}  // namespace

OGRSpatialReference reference_of_keys(const GeotiffKeys& keys) {
  constexpr std::size_t kMost = 1U << 16U;
  OGRSpatialReference reference;
  if (keys.directory.size() > kMost || keys.doubles.size() > kMost || keys.texts.size() > kMost)
    return reference;
  static std::atomic<unsigned> counter{0};
  const std::string path = "/vsimem/thalweg-keys-" + std::to_string(counter++) + ".tif";
  ByteArray tiff = tiff_of(keys);
  const GdalSession quiet;
  VSIFCloseL(VSIFileFromMemBuffer(path.c_str(), tiff.data(), tiff.size(), FALSE));
  {
    const std::array<const char*, 2> drivers = {"GTiff", nullptr};
    const GDALDatasetUniquePtr dataset(
        GDALDataset::Open(path.c_str(), GDAL_OF_RASTER, drivers.data(), nullptr, nullptr));
    const OGRSpatialReference* const found = dataset ? dataset->GetSpatialRef() : nullptr;
    if (found != nullptr) reference = *found;
  }
  VSIUnlink(path.c_str());
  if (reference.IsProjected() == 0 && reference.IsGeographic() == 0) reference.Clear();
  reference.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  return reference;
}

}  // namespace thalweg
