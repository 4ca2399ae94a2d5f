// Formats with traps of their own: single precision, one layer, several files, other axes.
#include "write_scene.hpp"

#include <gdal_priv.h>
#include <gmock/gmock.h>
#include <ogrsf_frmts.h>

#include <cstring>

namespace thalweg {
namespace {

using test::expect_error;
using test::make_grid_tin;
using test::read_file;
using test::TempFolder;
using test::write_file;
using test::write_text;
using testing::HasSubstr;

// A grid as a DEM in UTM gives it: without the vertex outside, which no triangle of an STL would hold.
Tin make_dem_tin() {
  const Tin tin = make_grid_tin(9, 7);
  const std::size_t used = tin.vertex_count() - 1;
  return {{tin.points().begin(), tin.points().begin() + static_cast<std::ptrdiff_t>(used)},
          {tin.heights().begin(), tin.heights().begin() + static_cast<std::ptrdiff_t>(used)},
          {tin.triangles().begin(), tin.triangles().end()},
          {}};
}

TEST(WriteOff, ReadsBackEveryBit) {
  const TempFolder folder;
  const Tin tin = make_dem_tin();
  write_file(folder.file("a.off"), {.tin = tin, .crs_authority = "EPSG:32611"});
  EXPECT_THAT(folder.names(), testing::ElementsAre("a.off", "a.prj"));
  TinFile file = read_file(folder.file("a.off"));
  EXPECT_THAT(file.crs, HasSubstr("32611"));
  test::expect_same_tin(tin, test::to_tin(std::move(file)));
}

// Plain floats at this northing are 0.25 m apart; with the origin of the sidecar they are not.
TEST(WriteStl, KeepsMillimetresByALocalOrigin) {
  const TempFolder folder;
  const Tin tin = make_dem_tin();
  write_file(folder.file("a.stl"), {.tin = tin, .crs_authority = "EPSG:32611"});
  EXPECT_THAT(folder.names(), testing::ElementsAre("a.prj", "a.stl", "a.stl.json"));
  const TinFile file = read_file(folder.file("a.stl"));
  ASSERT_EQ(file.points.size(), tin.vertex_count());
  ASSERT_EQ(file.triangles.size(), tin.triangle_count());
  for (std::size_t t = 0; t < file.triangles.size(); ++t) {
    for (std::size_t i = 0; i < 3; ++i) {
      const VertexId there = file.triangles[t][i], here = tin.triangles()[t][i];
      EXPECT_NEAR(file.points[there.index()].x, tin.point(here).x, 1e-4);
      EXPECT_NEAR(file.points[there.index()].y, tin.point(here).y, 1e-4);
      EXPECT_NEAR(file.heights[there.index()], tin.height(here), 1e-4);
    }
  }
  const std::string sidecar = test::read_text(folder.file("a.stl.json"));
  EXPECT_THAT(sidecar, HasSubstr("\"origin\""));
  EXPECT_THAT(sidecar, HasSubstr("EPSG:32611"));
  write_text(folder.file("a.stl.json"), "{}");
  expect_error(ErrorCode::BadFormat, {"a.stl.json", "origin"}, [&] { read_file(folder.file("a.stl")); });
}

TEST(WriteStl, NoOriginWhereSinglePrecisionHoldsEveryNumber) {
  const TempFolder folder;
  const Tin tin({{0, 0}, {10, 0}, {10.5, 10}}, {1, 2, 3}, {{VertexId{0}, VertexId{1}, VertexId{2}}}, {});
  write_file(folder.file("a.stl"), {.tin = tin});
  EXPECT_THAT(folder.names(), testing::ElementsAre("a.stl"));
  test::expect_same_tin(tin, test::to_tin(read_file(folder.file("a.stl"))));
}

TEST(ReadStl, TextOfOthers) {
  const TempFolder folder;
  write_text(folder.file("a.stl"),
             "solid hill\nfacet normal 0 0 1\n outer loop\n  vertex 0 0 5\n  vertex 1 0 6\n  vertex 0 1e0 7\n"
             " endloop\nendfacet\nendsolid hill\n");
  const TinFile file = read_file(folder.file("a.stl"));
  EXPECT_EQ(file.points, (std::vector<Point2>{{0, 0}, {1, 0}, {0, 1}}));
  EXPECT_EQ(file.heights, (std::vector<double>{5, 6, 7}));
  EXPECT_EQ(file.triangles.size(), 1U);
}

TEST(WriteGlb, HeaderTellsTheLengthAndTheOrigin) {
  const TempFolder folder;
  const Tin tin = make_grid_tin(9, 7);
  write_file(folder.file("a.glb"), {.tin = tin, .crs_authority = "EPSG:32611"});
  EXPECT_THAT(folder.names(), testing::ElementsAre("a.glb", "a.glb.json", "a.prj"));
  const std::string bytes = test::read_text(folder.file("a.glb"));
  EXPECT_EQ(bytes.substr(0, 4), "glTF");
  std::uint32_t length = 0;
  std::memcpy(&length, bytes.data() + 8, sizeof length);
  EXPECT_EQ(length, bytes.size());
  EXPECT_EQ(bytes.size() % 4, 0U);
  EXPECT_THAT(bytes.substr(0, 400), HasSubstr("\"extras\":{\"origin\":["));
}

// northing easting elevation; faces marked invisible are no surface; ids are any words.
TEST(ReadLandXml, AxesAndInvisibleFacesOfOthers) {
  const TempFolder folder;
  write_text(folder.file("a.xml"), R"(<?xml version="1.0"?>
<LandXML xmlns="http://www.landxml.org/schema/LandXML-1.2" version="1.2">
 <CoordinateSystem epsgCode="2056"/>
 <Surfaces><Surface name="s"><SourceData><Breaklines>
   <Breakline brkType="standard"><PntList3D>200 100 5 200 110 6 300 300 9</PntList3D></Breakline></Breaklines>
   <Boundaries><Boundary bndType="outer"><PntList3D>200 110 6 210 100 7</PntList3D></Boundary></Boundaries>
 </SourceData><Definition surfType="TIN"><Pnts>
   <P id="p1">200 100 5</P><P id="p2">200 110 6</P><P id="p9">210 100 7</P><P id="p3">210 110 8</P></Pnts>
  <Faces><F>p1 p2 p9</F><F i="1">p2 p3 p9</F></Faces></Definition></Surface></Surfaces></LandXML>)");
  const TinFile file = read_file(folder.file("a.xml"));
  EXPECT_EQ(file.crs, "EPSG:2056");
  ASSERT_EQ(file.points.size(), 4U);
  EXPECT_EQ(file.points[1], (Point2{110, 200}));
  EXPECT_EQ(file.heights[1], 6);
  ASSERT_EQ(file.triangles.size(), 1U);
  EXPECT_EQ(file.triangles[0], (Triangle{VertexId{0}, VertexId{1}, VertexId{2}}));
  ASSERT_EQ(file.constraints.size(), 2U);
  EXPECT_EQ(file.constraints[0].kind, EdgeKind::Breakline);
  EXPECT_EQ(file.constraints[1].kind, EdgeKind::Boundary);
}

TEST(ReadLandXml, BrokenFiles) {
  const TempFolder folder;
  const auto refuse = [&](ErrorCode code, const std::string& text, const std::string& word) {
    write_text(folder.file("a.xml"), text);
    expect_error(code, {"a.xml", word}, [&] { read_file(folder.file("a.xml")); });
  };
  const std::string head = "<LandXML><Surfaces><Surface name='a'><Definition>",
                    tail = "</Definition></Surface></Surfaces></LandXML>";
  refuse(ErrorCode::BadFormat, "<LandXML><Surfaces>", "XML");
  refuse(ErrorCode::EmptyInput, "<LandXML></LandXML>", "no surface");
  refuse(ErrorCode::BadFormat, head + "<Pnts><P id='1'>0 0 x</P></Pnts><Faces/>" + tail, "'x'");
  refuse(ErrorCode::MissingHeight, head + "<Pnts><P id='1'>0 0</P></Pnts><Faces/>" + tail, "point 1");
  refuse(ErrorCode::BadFormat, head + "<Pnts><P id='1'>0 0 0</P></Pnts><Faces><F>1 2 1</F></Faces>" + tail,
         "point 2");
}

// Each in a layer of polygons, with heights and CRS, as GDAL reads it.
class OneLayer : public testing::TestWithParam<const char*> {};

INSTANTIATE_TEST_SUITE_P(AllFormats, OneLayer, testing::Values(".fgb", ".shp", ".geojson"),
                         [](const auto& param) { return std::string(param.param).substr(1); });

TEST_P(OneLayer, HoldsTrianglesWithHeightsAndCrs) {
  const TempFolder folder;
  const std::string path = folder.file(std::string("a") + GetParam());
  const Tin tin = make_grid_tin(5, 4);
  write_file(path, {.tin = tin, .crs_authority = "EPSG:32611"});
  GDALAllRegister();
  const GDALDatasetUniquePtr dataset(GDALDataset::Open(path.c_str(), GDAL_OF_VECTOR | GDAL_OF_READONLY));
  ASSERT_NE(dataset, nullptr);
  OGRLayer* layer = dataset->GetLayer(0);
  EXPECT_EQ(layer->GetFeatureCount(), static_cast<GIntBig>(tin.triangle_count()));
  EXPECT_STREQ(layer->GetSpatialRef()->GetAuthorityCode(nullptr), "32611");
  std::size_t found = 0;
  const double most_off = std::string(GetParam()) == ".geojson" ? 1e-9 : 0;  // GDAL writes 15 digits
  for (const auto& feature : layer) {
    const OGRPoint corner = [&] {
      OGRPoint point;
      feature->GetGeometryRef()->toPolygon()->getExteriorRing()->getPoint(0, &point);
      return point;
    }();
    for (const char* name : {"a", "b", "c"}) {
      const VertexId v{static_cast<std::size_t>(feature->GetFieldAsInteger64(name))};
      const double off =
          std::max({std::abs(tin.point(v).x - corner.getX()), std::abs(tin.point(v).y - corner.getY()),
                    std::abs(tin.height(v) - corner.getZ())});
      if (off <= most_off) ++found;
    }
  }
  EXPECT_EQ(found, tin.triangle_count());
}

TEST_P(OneLayer, BreaklinesAndEqualBytes) {
  const TempFolder folder;
  const std::string path = folder.file(std::string("a") + GetParam());
  const Tin tin = make_grid_tin(5, 4);
  const WriteOptions options{.creation_options = {"LAYER=breaklines"}};
  write_file(path, {.tin = tin}, options);
  const std::string first = test::read_text(path);
  write_file(path, {.tin = tin}, options, Overwrite::Yes);
  EXPECT_TRUE(first == test::read_text(path));
  expect_error(ErrorCode::Usage, {"rivers", "LAYER"}, [&] {
    write_file(path, {.tin = tin}, {.creation_options = {"LAYER=rivers"}}, Overwrite::Yes);
  });
}

TEST(WriteShapefile, IsSeveralFilesOrNone) {
  const TempFolder folder;
  const Tin tin = make_grid_tin(5, 4);
  write_file(folder.file("a.shp"), {.tin = tin, .crs_authority = "EPSG:32611"});
  EXPECT_THAT(folder.names(), testing::ElementsAre("a.cpg", "a.dbf", "a.prj", "a.shp", "a.shx"));
  std::filesystem::remove(folder.file("a.shp"));
  expect_error(ErrorCode::OutputExists, {"a."}, [&] { write_file(folder.file("a.shp"), {.tin = tin}); });
  EXPECT_EQ(folder.names().size(), 4U);
}

}  // namespace
}  // namespace thalweg
