// What is written reads back as the same TIN, in every format; sidecars; creation options.
#include "write_scene.hpp"

#include <gmock/gmock.h>

namespace thalweg {
namespace {

using test::expect_error;
using test::make_grid_tin;
using test::read_file;
using test::TempFolder;
using test::write_file;
using testing::HasSubstr;

class RoundTrip : public testing::TestWithParam<const char*> {
 protected:
  TempFolder folder_;
  std::string path_ = folder_.file(std::string("tin") + GetParam());
};

INSTANTIATE_TEST_SUITE_P(AllFormats, RoundTrip,
                         testing::Values(".ply", ".2dm", ".obj", ".gpkg", ".nc", ".xml"),
                         [](const auto& param) { return std::string(param.param).substr(1); });

TEST_P(RoundTrip, KeepsEveryBitAndEveryKind) {
  const Tin tin = make_grid_tin(13, 9);
  write_file(path_, {.tin = tin});
  TinFile file = read_file(path_);
  EXPECT_EQ(file.crs, "");
  test::expect_same_tin(tin, test::to_tin(std::move(file)));
}

TEST_P(RoundTrip, KeepsAwkwardNumbers) {
  const std::vector<Point2> points = {
      {-0.1, 1.0 / 3}, {1e15, -1e-5}, {123456789.123456789, 1e16}, {-1e16, 5e-324}};
  const std::vector<double> heights = {1e6, 500000, 0.1 + 0.2, 100};
  const Tin tin(points, heights,
                {{VertexId{0}, VertexId{1}, VertexId{2}}, {VertexId{0}, VertexId{2}, VertexId{3}}}, {});
  write_file(path_, {.tin = tin});
  test::expect_same_tin(tin, test::to_tin(read_file(path_)));
}

TEST_P(RoundTrip, WritesTheCoordinatesThatCameIn) {
  const Tin tin = make_grid_tin(3, 3);
  std::vector<Point2> written;
  for (const Point2 p : tin.points()) written.push_back({p.x / 1e5, p.y / 1e5});
  write_file(path_, {.tin = tin, .written_xy = written});
  const TinFile file = read_file(path_);
  EXPECT_EQ(file.points, written);
}

TEST_P(RoundTrip, KeepsTheCrs) {
  const Tin tin = make_grid_tin(3, 3);
  write_file(path_, {.tin = tin, .crs_wkt = "", .crs_authority = "EPSG:32611"});
  const std::string crs = read_file(path_).crs;
  EXPECT_THAT(crs, testing::AnyOf(testing::Eq("EPSG:32611"), HasSubstr("AUTHORITY[\"EPSG\",\"32611\"]]")));
}

TEST_P(RoundTrip, EqualInputGivesEqualBytes) {
  const Tin tin = make_grid_tin(5, 5);
  const std::vector<std::uint16_t> orders(tin.triangle_count(), 1);
  const TinView view{.tin = tin, .crs_authority = "EPSG:32611", .triangle_orders = orders};
  write_file(path_, view);
  const std::string first = test::read_text(path_);
  write_file(path_, view, {}, Overwrite::Yes);
  EXPECT_TRUE(first == test::read_text(path_));
}

TEST_P(RoundTrip, CancelLeavesNothing) {
  const Tin tin = make_grid_tin(60, 60);
  Progress progress([&](const std::string&, double) { progress.cancel(); });
  expect_error(ErrorCode::Cancelled, {}, [&] {
    PendingOutputs pending;
    write_tin(path_, {.tin = tin}, {}, pending, Overwrite::No, progress);
    pending.commit();
  });
  EXPECT_TRUE(folder_.names().empty());
}

TEST_P(RoundTrip, RefusesToOverwriteAndThenDoes) {
  const Tin tin = make_grid_tin(4, 4);
  test::write_text(path_, "something else");
  expect_error(ErrorCode::OutputExists, {path_}, [&] { write_file(path_, {.tin = tin}); });
  EXPECT_EQ(test::read_text(path_), "something else");
  write_file(path_, {.tin = tin}, {}, Overwrite::Yes);
  test::expect_same_tin(tin, test::to_tin(read_file(path_)));
}

TEST_P(RoundTrip, FormatByNameWhateverTheExtension) {
  const std::string name = path_ + ".dat";
  const Tin tin = make_grid_tin(4, 4);
  if (std::string(GetParam()) == ".obj") return;  // has no signature to be recognised by
  const auto known = std::find_if(tin_formats().begin(), tin_formats().end(), [](const FormatInfo& format) {
    return format.extensions.front() == GetParam();
  });
  write_file(name, {.tin = tin}, {.format = known->name});
  test::expect_same_tin(tin, test::to_tin(read_file(name)));
}

TEST(WritePly, HeaderIsWhatQgisReads) {
  const TempFolder folder;
  const Tin tin = make_grid_tin(2, 2);
  const std::vector<std::uint16_t> orders = {0, 7};
  write_file(folder.file("a.ply"), {.tin = tin, .crs_authority = "EPSG:32611", .triangle_orders = orders});
  const std::string text = test::read_text(folder.file("a.ply"));
  const std::string header =
      "ply\nformat binary_little_endian 1.0\ncomment crs: EPSG:32611\nelement vertex 5\nproperty double x\n"
      "property double y\nproperty double z\nelement face 2\nproperty list uchar int vertex_indices\n"
      "property int order\nelement edge 3\nproperty int vertex1\nproperty int vertex2\nproperty uchar "
      "kind\nend_header\n";
  EXPECT_EQ(text.substr(0, header.size()), header);
  EXPECT_EQ(text.size(), header.size() + 5 * 24 + 2 * 17 + 3 * 9);
  EXPECT_EQ(read_file(folder.file("a.ply")).triangle_orders, orders);
  EXPECT_EQ(folder.names(), std::vector<std::string>{"a.ply"});
}

TEST(WritePly, CrsWithoutCodeIsWktInTheComment) {
  const TempFolder folder;
  const Tin tin = make_grid_tin(2, 2);
  const std::string wkt = "LOCAL_CS[\"my site\",\n  UNIT[\"metre\",1]]";
  write_file(folder.file("a.ply"), {.tin = tin, .crs_wkt = wkt});
  EXPECT_EQ(read_file(folder.file("a.ply")).crs, "LOCAL_CS[\"my site\",   UNIT[\"metre\",1]]");
}

TEST(WriteTin, EdgesCanBeLeftOut) {
  const TempFolder folder;
  const Tin tin = make_grid_tin(4, 4);
  for (const char* name : {"a.ply", "a.2dm", "a.obj"}) {
    write_file(folder.file(name), {.tin = tin}, {.creation_options = {"edges=no"}});
    EXPECT_TRUE(read_file(folder.file(name)).constraints.empty()) << name;
  }
}

TEST(WriteTin, TextFormatsAreWhatOthersRead) {
  const TempFolder folder;
  const Tin tin({{0, 0}, {10, 0}, {10.5, 10}}, {1, 2, 1e-7}, {{VertexId{0}, VertexId{1}, VertexId{2}}},
                std::vector<ConstraintEdge>{{VertexId{0}, VertexId{1}, EdgeKind::Valley},
                                            {VertexId{1}, VertexId{2}, EdgeKind::Valley | EdgeKind::Hole}});
  write_file(folder.file("a.2dm"), {.tin = tin});
  EXPECT_EQ(test::read_text(folder.file("a.2dm")),
            "MESH2D\nNUM_MATERIALS_PER_ELEM 1\nE3T 1 1 2 3 1\nND 1 0 0 1\nND 2 10 0 2\nND 3 10.5 10 1e-07\n"
            "NS 1 -2 1 valley\nNS 2 -3 2 valley+hole\n");
  write_file(folder.file("a.obj"), {.tin = tin});
  EXPECT_EQ(
      test::read_text(folder.file("a.obj")),
      "v 0 0 1\nv 10 0 2\nv 10.5 10 1e-07\ng surface\nf 1 2 3\ng valley\nl 1 2\ng valley hole\nl 2 3\n");
}

TEST(WriteTin, SidecarsBelongToTheOutput) {
  const TempFolder folder;
  const Tin tin = make_grid_tin(3, 3);
  write_file(folder.file("a.2dm"), {.tin = tin, .crs_authority = "EPSG:28992"});
  EXPECT_EQ(folder.names(), (std::vector<std::string>{"a.2dm", "a.prj"}));
  EXPECT_THAT(test::read_text(folder.file("a.prj")), HasSubstr("Amersfoort / RD New"));

  // Another output of the same name: its sidecar is in the way, with a CRS as without.
  expect_error(ErrorCode::OutputExists, {"a.prj"}, [&] { write_file(folder.file("a.obj"), {.tin = tin}); });
  expect_error(ErrorCode::OutputExists, {"a.prj"},
               [&] { write_file(folder.file("a.obj"), {.tin = tin, .crs_authority = "EPSG:32611"}); });
  EXPECT_EQ(folder.names(), (std::vector<std::string>{"a.2dm", "a.prj"}));
  // With the same CRS they share it.
  write_file(folder.file("a.off"), {.tin = tin, .crs_authority = "EPSG:28992"});
  EXPECT_EQ(folder.names(), (std::vector<std::string>{"a.2dm", "a.off", "a.prj"}));
  // None of them changes it where one of another kind needs it.
  test::write_text(folder.file("a.shp"), "");
  expect_error(ErrorCode::Usage, {"a.prj", "a.shp"},
               [&] { write_file(folder.file("a.2dm"), {.tin = tin}, {}, Overwrite::Yes); });
  std::filesystem::remove(folder.file("a.shp"));
  write_file(folder.file("a.2dm"), {.tin = tin}, {}, Overwrite::Yes);
  EXPECT_EQ(folder.names(), (std::vector<std::string>{"a.2dm", "a.off"}));
}

TEST(WriteTin, RefusalsListWhatIsKnown) {
  const TempFolder folder;
  const Tin tin = make_grid_tin(3, 3);
  const auto write = [&](const char* name, const WriteOptions& options) {
    write_file(folder.file(name), {.tin = tin}, options);
  };
  expect_error(ErrorCode::Usage, {".tab", "PLY", "GPKG", "--of"}, [&] { write("a.tab", {}); });
  expect_error(ErrorCode::Usage, {"without an extension", "PLY"}, [&] { write("a", {}); });
  expect_error(ErrorCode::Usage, {"'XYZ'", "OBJ"}, [&] { write("a.ply", {.format = "XYZ"}); });
  expect_error(ErrorCode::Usage, {"COLOUR", "EDGES=YES|NO"},
               [&] { write("a.ply", {.creation_options = {"COLOUR=YES"}}); });
  expect_error(ErrorCode::Usage, {"'EDGES'"}, [&] { write("a.ply", {.creation_options = {"EDGES"}}); });
  expect_error(ErrorCode::Usage, {"'MAYBE'"}, [&] { write("a.ply", {.creation_options = {"EDGES=MAYBE"}}); });
  expect_error(ErrorCode::Usage, {"'rivers'", "breaklines"},
               [&] { write("a.gpkg", {.creation_options = {"LAYERS=triangles,rivers"}}); });
  EXPECT_TRUE(folder.names().empty());
}

TEST(TinFormats, AreAllWrittenAndMostAreRead) {
  std::vector<std::string> written, read;
  for (const FormatInfo& format : tin_formats()) {
    if (format.writes) written.push_back(format.name);
    if (format.reads) read.push_back(format.name);
  }
  EXPECT_THAT(written, testing::IsSupersetOf({"PLY", "2DM", "UGRID", "OBJ", "STL", "OFF", "GLB", "VTU",
                                              "LandXML", "GPKG", "FlatGeobuf", "Shapefile", "GeoJSON"}));
  EXPECT_THAT(read, testing::IsSupersetOf({"PLY", "2DM", "UGRID", "OBJ", "STL", "OFF", "LandXML", "GPKG"}));
}

}  // namespace
}  // namespace thalweg
