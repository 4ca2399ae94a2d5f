// Drivers are asked for what they say of themselves; GDAL's own order decides between those that share an
// extension (GTiff before COG).
#include "io/gdal_formats.hpp"

#include <cpl_string.h>

#include <filesystem>

namespace thalweg {

namespace {

bool writes(GDALDriver& driver, DriverUse use) {
  const auto says = [&](const char* what) {
    const char* value = driver.GetMetadataItem(what);
    return value != nullptr && EQUAL(value, "YES");
  };
  if (!says(use == DriverUse::Raster ? GDAL_DCAP_RASTER : GDAL_DCAP_VECTOR)) return false;
  return says(GDAL_DCAP_CREATE) || (use == DriverUse::Raster && says(GDAL_DCAP_CREATECOPY));
}

bool has_extension(GDALDriver& driver, const std::string& extension) {
  const char* list = driver.GetMetadataItem(GDAL_DMD_EXTENSIONS);
  const CPLStringList extensions(CSLTokenizeString2(list == nullptr ? "" : list, " ", 0));
  return extensions.FindString(extension.c_str()) >= 0;
}

}  // namespace

GDALDriver* find_output_driver(const std::string& path, const std::string& format, DriverUse use) {
  GDALDriverManager& drivers = *GetGDALDriverManager();
  if (!format.empty()) {
    GDALDriver* driver = drivers.GetDriverByName(format.c_str());
    return driver != nullptr && writes(*driver, use) ? driver : nullptr;
  }
  std::string extension = std::filesystem::path(path).extension().string();
  if (extension.size() < 2) return nullptr;
  extension.erase(0, 1);
  for (int i = 0; i < drivers.GetDriverCount(); ++i) {
    GDALDriver* driver = drivers.GetDriver(i);
    if (writes(*driver, use) && has_extension(*driver, extension)) return driver;
  }
  return nullptr;
}

}  // namespace thalweg
