#include "read_fixture.hpp"

#include <gdal_priv.h>
#include <ogrsf_frmts.h>

#include <stdexcept>

namespace thalweg {

void write_gzip(const std::string& path, const std::string& content) {
  VSILFILE* file = VSIFOpenL(("/vsigzip/" + path).c_str(), "wb");
  if (file == nullptr) throw std::runtime_error("cannot create " + path);
  VSIFWriteL(content.data(), 1, content.size(), file);
  VSIFCloseL(file);
}

void write_layer(const std::string& path, const std::string& layer, const std::string& crs,
                 const std::vector<TestFeature>& features, const std::string& geometry_type) {
  GDALAllRegister();
  CPLSetConfigOption("OGR_SQLITE_SYNCHRONOUS", "OFF");  // the files die with the test
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GPKG");
  const bool exists = std::filesystem::exists(path);
  const GDALDatasetUniquePtr dataset(exists ? GDALDataset::Open(path.c_str(), GDAL_OF_VECTOR | GDAL_OF_UPDATE)
                                            : driver->Create(path.c_str(), 0, 0, 0, GDT_Unknown, nullptr));
  if (!dataset) throw std::runtime_error("cannot create " + path);
  OGRSpatialReference reference;
  if (!crs.empty()) reference.SetFromUserInput(crs.c_str());
  OGRLayer* out = dataset->CreateLayer(layer.c_str(), crs.empty() ? nullptr : &reference,
                                       OGRFromOGCGeomType(geometry_type.c_str()), nullptr);
  OGRFieldDefn kind("kind", OFTString);
  OGRFieldDefn elev("elev", OFTReal);
  out->CreateField(&kind);
  out->CreateField(&elev);
  for (const TestFeature& item : features) {
    OGRFeature feature(out->GetLayerDefn());
    if (item.text != "-") feature.SetField("kind", item.text.c_str());
    if (item.number) feature.SetField("elev", *item.number);
    if (!item.wkt.empty()) {
      OGRGeometry* geometry = nullptr;
      OGRGeometryFactory::createFromWkt(item.wkt.c_str(), nullptr, &geometry);
      if (geometry == nullptr) throw std::runtime_error("bad WKT: " + item.wkt);
      feature.SetGeometryDirectly(geometry);
    }
    if (out->CreateFeature(&feature) != OGRERR_NONE) throw std::runtime_error("cannot write to " + path);
  }
}

}  // namespace thalweg
