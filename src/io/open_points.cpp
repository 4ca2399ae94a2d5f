// What kind of source of points a file is.
#include "base/lower_case.hpp"
#include "io/dataset.hpp"
#include "io/gdal_session.hpp"
#include "io/las_points.hpp"
#include "io/layer_reader.hpp"
#include "io/mesh_points.hpp"
#include "io/raster_points.hpp"
#include "io/source_reader.hpp"
#include "io/text_points.hpp"

#include <thalweg/base/error.hpp>

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>

namespace thalweg {

namespace {

bool has_point_layer(GDALDataset& dataset) {
  for (OGRLayer* layer : dataset.GetLayers()) {
    if (can_hold(layer->GetGeomType(), LayerUse::Points)) return true;
  }
  return false;
}

/// True for the layers that a TIN is written as; its vertices are points.
bool is_tin(GDALDataset& dataset) {
  return dataset.GetLayerByName("triangles") != nullptr && dataset.GetLayerByName("vertices") != nullptr;
}

/// Text, LAS and meshes have one layer, which GDAL and QGIS name as the file. Throws: Error{NotFound}.
void refuse_other_layer(const SourceSpec& spec) {
  if (spec.layer.empty()) return;
  std::filesystem::path path(spec.path);
  if (extension_of(spec.path) == ".gz") path = path.stem();
  if (spec.layer == path.stem()) return;
  throw Error(ErrorCode::NotFound,
              spec.path + " has no layer " + spec.layer + "; it has one, and needs no |layername=");
}

std::string list_subdatasets(GDALDataset& dataset) {
  std::string list;
  char** const entries = dataset.GetMetadata("SUBDATASETS");
  for (char** entry = entries; entry != nullptr && *entry != nullptr; ++entry) {
    const std::string_view text(*entry);
    const std::size_t equals = text.find('=');
    if (equals == std::string_view::npos || text.substr(0, equals).find("_NAME") == std::string_view::npos)
      continue;
    list += (list.empty() ? "" : ", ") + std::string(text.substr(equals + 1));
  }
  return list;
}

}  // namespace

std::unique_ptr<SourceReader> open_points(const SourceSpec& spec, const ReadOptions& options,
                                          const Progress& progress) {
  const bool las = is_las(spec), mesh = !las && is_mesh(spec), text = !las && !mesh && is_text(spec);
  if (las || mesh || text) refuse_other_layer(spec);
  if (las) return open_las(spec);
  if (mesh) return open_mesh(spec, progress);
  if (text) return open_text(spec, options);
  OpenedDataset opened = open_dataset(spec.path, LayerUse::Points);
  GDALDataset& dataset = *opened.dataset;
  if (spec.layer.empty() && is_tin(dataset)) {
    return open_layer_points({spec.path, "vertices"}, std::move(opened));
  }
  const bool has_raster = dataset.GetRasterCount() > 0;
  if (!spec.layer.empty() || has_point_layer(dataset) || (dataset.GetLayerCount() > 0 && !has_raster)) {
    return open_layer_points(spec, std::move(opened));
  }
  if (has_raster) return open_raster(spec, std::move(opened));
  const std::string parts = list_subdatasets(dataset);
  if (!parts.empty())
    throw Error(ErrorCode::Usage, spec.path + " holds several rasters; name one of: " + parts);
  throw Error(ErrorCode::EmptyInput, spec.path + " holds neither layers nor rasters");
}

}  // namespace thalweg
