// The layers of a GeoPackage, read back by GDAL itself.
#include "write_scene.hpp"

#include <gdal_priv.h>
#include <ogrsf_frmts.h>

namespace thalweg {
namespace {

using test::make_grid_tin;
using test::TempFolder;
using test::write_file;

GDALDatasetUniquePtr open_layers(const std::string& path) {
  GDALAllRegister();
  return GDALDatasetUniquePtr(GDALDataset::Open(path.c_str(), GDAL_OF_VECTOR | GDAL_OF_READONLY));
}

TEST(WriteGpkg, LayersHoldWhatIsKnown) {
  const TempFolder folder;
  const Tin tin = make_grid_tin(5, 4);
  std::vector<std::uint8_t> pits(tin.vertex_count(), 0), sources(tin.vertex_count(), 0);
  pits[7] = 1;
  sources[3] = 2;
  std::vector<std::uint16_t> orders(tin.triangle_count(), 1);
  orders[2] = 3;
  const std::vector<Conflict> conflicts = {
      {Conflict::Kind::PointOnLine, {1, 2}, 10, 12, 10, "a.gpkg|v", "b.gpkg|r"}};
  write_file(folder.file("a.gpkg"), {.tin = tin,
                                     .crs_authority = "EPSG:32611",
                                     .is_pit = pits,
                                     .vertex_source = sources,
                                     .triangle_orders = orders,
                                     .conflicts = conflicts});
  const auto dataset = open_layers(folder.file("a.gpkg"));
  ASSERT_NE(dataset, nullptr);
  EXPECT_EQ(dataset->GetLayerCount(), 5);

  OGRLayer* layer = dataset->GetLayerByName("triangles");
  ASSERT_NE(layer, nullptr);
  EXPECT_EQ(layer->GetFeatureCount(), static_cast<GIntBig>(tin.triangle_count()));
  EXPECT_EQ(layer->GetGeomType(), wkbPolygon25D);
  EXPECT_STREQ(layer->GetSpatialRef()->GetAuthorityCode(nullptr), "32611");
  OGRFeatureUniquePtr feature(layer->GetFeature(3));
  EXPECT_EQ(feature->GetFieldAsInteger("order"), 3);
  EXPECT_EQ(feature->GetFieldAsInteger("a"), static_cast<int>(tin.triangles()[2][0].value()));
  EXPECT_TRUE(feature->GetGeometryRef()->IsValid());

  layer = dataset->GetLayerByName("edges");
  ASSERT_NE(layer, nullptr);
  EXPECT_EQ(layer->GetFeatureCount(), static_cast<GIntBig>(tin.edge_count()));
  layer->SetAttributeFilter("kind = 'ridge+boundary' AND kind_bits = 10");
  EXPECT_EQ(layer->GetFeatureCount(), 4);

  layer = dataset->GetLayerByName("vertices");
  ASSERT_NE(layer, nullptr);
  layer->SetAttributeFilter("is_pit = 1");
  EXPECT_EQ(layer->GetFeatureCount(), 1);
  layer->SetAttributeFilter("source = 'crossing' AND id = 3");
  EXPECT_EQ(layer->GetFeatureCount(), 1);

  layer = dataset->GetLayerByName("breaklines");
  ASSERT_NE(layer, nullptr);
  layer->SetAttributeFilter("kind = 'valley'");
  EXPECT_EQ(layer->GetFeatureCount(), 1);
  feature.reset(layer->GetNextFeature());
  EXPECT_EQ(feature->GetGeometryRef()->toLineString()->getNumPoints(), 5);

  layer = dataset->GetLayerByName("conflicts");
  ASSERT_NE(layer, nullptr);
  feature.reset(layer->GetNextFeature());
  EXPECT_STREQ(feature->GetFieldAsString("kind"), "point-on-line");
  EXPECT_EQ(feature->GetFieldAsDouble("z_b"), 12);
  EXPECT_STREQ(feature->GetFieldAsString("source_b"), "b.gpkg|r");
  EXPECT_EQ(test::read_file(folder.file("a.gpkg")).triangle_orders, orders);
}

TEST(WriteGpkg, LayersCanBeChosen) {
  const TempFolder folder;
  const Tin tin = make_grid_tin(5, 4);
  write_file(folder.file("a.gpkg"), {.tin = tin},
             {.creation_options = {"LAYERS=Triangles,breaklines", "SPATIAL_INDEX=NO"}});
  const auto dataset = open_layers(folder.file("a.gpkg"));
  ASSERT_NE(dataset, nullptr);
  EXPECT_EQ(dataset->GetLayerCount(), 2);

  // Without vertices the numbers are new and the vertex in no triangle is lost; the surface is the same.
  const TinFile file = test::read_file(folder.file("a.gpkg"));
  EXPECT_EQ(file.points.size(), tin.vertex_count() - 1);
  EXPECT_EQ(file.triangles.size(), tin.triangle_count());
  EXPECT_EQ(test::to_tin(file).constraint_edges().size(), tin.constraint_edges().size());
}

TEST(WriteGpkg, GeographicCoordinatesStayLongitudeLatitude) {
  const TempFolder folder;
  const Tin tin({{-84.4, 36.4}, {-84.3, 36.4}, {-84.35, 36.5}}, {1, 2, 3},
                {{VertexId{0}, VertexId{1}, VertexId{2}}}, {});
  write_file(folder.file("a.gpkg"), {.tin = tin, .crs_authority = "EPSG:4326"});
  const auto dataset = open_layers(folder.file("a.gpkg"));
  OGREnvelope box;
  ASSERT_EQ(dataset->GetLayerByName("triangles")->GetExtent(&box), OGRERR_NONE);
  EXPECT_EQ(box.MinX, -84.4);
  EXPECT_EQ(box.MaxY, 36.5);
  EXPECT_EQ(test::read_file(folder.file("a.gpkg")).crs, "EPSG:4326");
}

}  // namespace
}  // namespace thalweg
