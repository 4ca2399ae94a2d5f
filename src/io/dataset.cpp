// Datasets as GDAL opens them, and the choice of a layer.
#include "io/dataset.hpp"

#include "io/gdal_session.hpp"
#include "io/netcdf_length.hpp"

#include <thalweg/base/error.hpp>

#include <cpl_string.h>
#include <cpl_vsi.h>
#include <ogrsf_frmts.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace thalweg {

namespace {

std::string list_layers(GDALDataset& dataset) {
  std::string text;
  for (OGRLayer* layer : dataset.GetLayers()) {
    text += (text.empty() ? "" : ", ") + std::string(layer->GetName()) + " (" +
            name_of_geometry(layer->GetGeomType()) + ")";
  }
  return text.empty() ? "none" : text;
}

std::string wanted(LayerUse use) {
  return use == LayerUse::Points ? "points" : "lines or polygons";
}

std::string remedy(LayerUse use) {
  return use == LayerUse::Points ? "; lines belong to --breaklines, --ridges or --valleys"
                                 : "; points go before the output";
}

}  // namespace

bool can_hold(OGRwkbGeometryType type, LayerUse use) {
  switch (wkbFlatten(type)) {
    case wkbUnknown:
    case wkbGeometryCollection:
      return true;
    case wkbPoint:
    case wkbMultiPoint:
      return use == LayerUse::Points;
    case wkbLineString:
    case wkbMultiLineString:
    case wkbPolygon:
    case wkbMultiPolygon:
    case wkbTriangle:
    case wkbCircularString:
    case wkbCompoundCurve:
    case wkbCurvePolygon:
    case wkbMultiCurve:
    case wkbMultiSurface:
    case wkbCurve:
    case wkbSurface:
      return use == LayerUse::Lines;
    default:
      return false;
  }
}

std::string name_of_geometry(OGRwkbGeometryType type) {
  return wkbFlatten(type) == wkbNone ? "no geometry" : OGRGeometryTypeToName(type);
}

OpenedDataset open_dataset(const std::string& path, LayerUse use) {
  check_netcdf_length(path);
  GdalSession session;
  const unsigned kinds = use == LayerUse::Points ? GDAL_OF_RASTER | GDAL_OF_VECTOR : GDAL_OF_VECTOR;
  GDALDatasetUniquePtr dataset(
      GDALDataset::Open(path.c_str(), kinds | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR));
  if (dataset) {
    // Only a dataset's errors count: drivers that find a CRS in another way make warnings of them.
    const std::string errors = session.reason();
    const bool about_crs = errors.find("proj_create") != std::string::npos;
    // GeoJSON and its kin: WGS 84.
    const bool json = std::string_view(dataset->GetDriverName()).find("JSON") != std::string_view::npos;
    const bool vrt = std::string_view(dataset->GetDriverName()) == "VRT";
    return {std::move(dataset), about_crs ? errors : "", json, vrt};
  }
  VSIStatBufL stat;
  const bool names_a_file = path.find(':') == std::string::npos || path.front() == '/';
  if (names_a_file && VSIStatExL(path.c_str(), &stat, VSI_STAT_EXISTS_FLAG) != 0) {
    throw Error(ErrorCode::NotFound, path + ": there is no such file");
  }
  const bool is_csv = path.size() > 4 && EQUAL(path.c_str() + path.size() - 4, ".csv");
  throw Error(
      ErrorCode::Unreadable,
      path + " cannot be opened" + session.reason() +
          (is_csv ? "; lines in a .csv stand as WKT in a column of that name, beside another column" : ""));
}

bool lacks_declared_crs(const OpenedDataset& opened, const OGRSpatialReference* given) {
  // A VRT may say that it has none by an empty element.
  if (given != nullptr && given->IsEmpty()) return !opened.crs_errors.empty() || !opened.is_vrt;
  return !opened.crs_errors.empty() && (given == nullptr || opened.has_default_crs);
}

OGRLayer& choose_layer(GDALDataset& dataset, const SourceSpec& source, LayerUse use) {
  const std::string layers = "; its layers are: " + list_layers(dataset);
  if (!source.layer.empty()) {
    OGRLayer* layer = dataset.GetLayerByName(source.layer.c_str());
    if (layer == nullptr) {
      throw Error(ErrorCode::NotFound, source.path + " has no layer " + source.layer + layers);
    }
    if (!can_hold(layer->GetGeomType(), use)) {
      throw Error(ErrorCode::WrongGeometry, source.path + "|" + source.layer + " holds " +
                                                name_of_geometry(layer->GetGeomType()) + ", not " +
                                                wanted(use) + layers + remedy(use));
    }
    return *layer;
  }
  std::vector<OGRLayer*> fitting;
  for (OGRLayer* layer : dataset.GetLayers()) {
    if (can_hold(layer->GetGeomType(), use)) fitting.push_back(layer);
  }
  if (fitting.empty()) {
    throw Error(ErrorCode::WrongGeometry,
                source.path + " has no layer of " + wanted(use) + layers + remedy(use));
  }
  if (fitting.size() > 1) {
    throw Error(ErrorCode::Usage, source.path + " has several layers of " + wanted(use) + "; name one as " +
                                      source.path + "|layername=NAME" + layers);
  }
  return *fitting.front();
}

std::vector<std::string> files_of_source(const std::string& path) {
  namespace fs = std::filesystem;
  const auto beside = [&path](const char* extension) {
    return fs::path(path).replace_extension(extension).string();
  };
  std::vector<std::string> files = {path, beside(".prj")};
  if (fs::path(path).extension() == ".shp") files.insert(files.end(), {beside(".dbf"), beside(".shx")});
  if (path.starts_with("/vsi")) {  // "/vsizip/folder/archive.zip/file"
    std::string inner = path.substr(std::min(path.find('/', 1), path.size()));
    for (; inner.size() > 1; inner.resize(inner.find_last_of('/'))) {
      files.push_back(inner);
      files.push_back(inner.substr(1));
    }
  }
  if (fs::path(path).extension() == ".vrt") {
    const GdalSession session;
    const GDALDatasetUniquePtr dataset(GDALDataset::Open(path.c_str(), GDAL_OF_RASTER | GDAL_OF_VECTOR));
    const CPLStringList parts(dataset ? dataset->GetFileList() : nullptr);
    for (int i = 0; i < parts.size(); ++i) files.emplace_back(parts[i]);
  }
  return files;
}

}  // namespace thalweg
