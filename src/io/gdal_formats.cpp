// Drivers are asked for what they say of themselves; GDAL's own order decides between those that share an
// extension (GTiff before COG).
#include "io/gdal_formats.hpp"

#include "io/tin_format.hpp"

#include <thalweg/base/error.hpp>

#include <cpl_minixml.h>

#include <algorithm>
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

bool names(const CPLXMLNode* node, const char* path, const std::string& name) {
  const char* value = CPLGetXMLValue(node, path, nullptr);
  return value != nullptr && EQUAL(value, name.c_str());
}

/// Whether a list of options, as drivers have it in XML, has this one, and its value where values are listed.
bool knows(GDALDriver& driver, const char* list_name, const std::string& key, const std::string& value) {
  const char* xml = driver.GetMetadataItem(list_name);
  const CPLXMLTreeCloser list(xml == nullptr ? nullptr : CPLParseXMLString(xml));
  const CPLXMLNode* option = list.get() == nullptr ? nullptr : list->psChild;
  while (option != nullptr && !names(option, "name", key) && !names(option, "alias", key) &&
         !names(option, "deprecated_alias", key)) {
    option = option->psNext;
  }
  if (option == nullptr || !names(option, "type", "string-select")) return option != nullptr;
  for (const CPLXMLNode* choice = option->psChild; choice != nullptr; choice = choice->psNext) {
    if (!EQUAL(choice->pszValue, "Value")) continue;
    if (names(choice, "", value) || names(choice, "alias", value)) return true;
  }
  return false;
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

DriverOptions sort_options(GDALDriver& driver, const std::vector<std::string>& options, DriverUse use) {
  refuse_repeated_keys(options);
  DriverOptions sorted;
  for (const std::string& option : options) {
    const std::size_t equals = std::min(option.find('='), option.size());
    const std::string key = option.substr(0, equals),
                      value = option.substr(std::min(equals + 1, option.size()));
    const bool of_dataset = knows(driver, GDAL_DMD_CREATIONOPTIONLIST, key, value);
    const bool of_layer =
        use == DriverUse::Vector && knows(driver, GDAL_DS_LAYER_CREATIONOPTIONLIST, key, value);
    if (of_dataset) sorted.dataset.AddString(option.c_str());
    if (of_layer) sorted.layer.AddString(option.c_str());
    if (of_dataset || of_layer) continue;
    throw Error(ErrorCode::Usage, "'" + option + "' is no creation option K=V of " + driver.GetDescription() +
                                      ", or no value of one; `" +
                                      (use == DriverUse::Raster ? "gdalinfo" : "ogrinfo") + " --format " +
                                      driver.GetDescription() + "` lists them");
  }
  return sorted;
}

bool holds_type(GDALDriver& driver, GDALDataType type) {
  const char* list = driver.GetMetadataItem(GDAL_DMD_CREATIONDATATYPES);
  if (list == nullptr) return true;
  const CPLStringList types(CSLTokenizeString2(list, " ", 0));
  return types.FindString(GDALGetDataTypeName(type)) >= 0;
}

}  // namespace thalweg
