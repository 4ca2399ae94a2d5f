// Layers of points, lines and areas: choice, geometry types, heights, kinds, errors that name the feature.
#include "read_fixture.hpp"

#include <gmock/gmock.h>

namespace thalweg {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

class ReadLayers : public ReadTest {
 protected:
  /// A GeoPackage with one layer.
  std::string layer(const std::vector<TestFeature>& features, const std::string& type = "GEOMETRY",
                    const std::string& crs = "EPSG:32611") const {
    std::filesystem::remove(path("one.gpkg"));
    write_layer(path("one.gpkg"), "things", crs, features, type);
    return path("one.gpkg");
  }
};

TEST_F(ReadLayers, TakesHeightsFromPointsAndMultipoints) {
  const ReadResult result = read({layer({{"POINT Z (1 2 3)", "a"},
                                         {"MULTIPOINT Z (4 5 6, 7 8 9)", "b"},
                                         {"GEOMETRYCOLLECTION Z (POINT Z (10 11 12))", "c"},
                                         {"", "d"},
                                         {"POINT EMPTY", "e"}})});
  EXPECT_THAT(result.survey.points.z, ElementsAre(3, 6, 9, 12));
  EXPECT_EQ(result.survey.points.xy[2], (Point2{7, 8}));
  EXPECT_EQ(result.crs.authority, "EPSG:32611");
  EXPECT_TRUE(has_note(result, "2 features without geometry"));
}

TEST_F(ReadLayers, TakesHeightsFromTheNamedField) {
  const ReadOptions elev{.z_field = "elev"};
  EXPECT_THAT(read({layer({{"POINT Z (1 2 3)", "", 30}, {"POINT (1 2)", "", 31}})}, elev).survey.points.z,
              ElementsAre(30, 31));
  EXPECT_THAT(read({layer({{"POINT (1 2)", "7.5"}})}, {.z_field = "kind"}).survey.points.z, ElementsAre(7.5));
  expect_error(ErrorCode::BadFormat, {"feature 1", "kind", "\"high\""}, [&] {
    read({layer({{"POINT (1 2)", "high"}})}, {.z_field = "kind"});
  });
  expect_error(ErrorCode::MissingHeight, {"one.gpkg feature 2", "elev"}, [&] {
    read({layer({{"POINT (1 2)", "", 3}, {"POINT Z (1 2 3)", ""}})}, elev);
  });
  expect_error(ErrorCode::MissingHeight, {"one.gpkg", "height"}, [&] {
    read({layer({{"POINT Z (1 2 3)", ""}})}, {.z_field = "height"});
  });
  expect_error(ErrorCode::MissingHeight, {"one.gpkg feature 1", "--z-field"}, [&] {
    read({layer({{"POINT (1 2)", ""}})});
  });
  EXPECT_THAT(read({layer({{"POINT (1 2)", ""}})}, {.heights = HeightRule::Optional}).survey.points.z,
              ElementsAre(0));
}

TEST_F(ReadLayers, RefusesCoordinatesThatAreNone) {
  expect_error(ErrorCode::BadCoordinate, {"feature 1", "height", "inf"}, [&] {
    read({layer({{"POINT Z (1 2 1e999)", ""}})});
  });
  expect_error(ErrorCode::BadCoordinate, {"feature 2", "inf"}, [&] {
    read({layer({{"POINT Z (1 2 3)", ""}, {"POINT Z (1e999 2 3)", ""}})});
  });
  expect_error(ErrorCode::BadCoordinate, {"feature 1", "vertex 1"}, [&] {
    read_lines(layer({{"LINESTRING (0 0, 1e200 1)", ""}}));
  });
  expect_error(ErrorCode::BadCoordinate, {"feature 1", "vertex 0", "--line-z-field"}, [&] {
    read_lines(layer({{"LINESTRING Z (0 0 -1e999, 1 1 1)", ""}}));
  });
}

TEST_F(ReadLayers, TakesLinesApart) {
  const ReadResult result = read_lines(layer({{"LINESTRING (0 0, 1 1, 2 0)", ""},
                                              {"MULTILINESTRING Z ((0 0 5, 1 0 6), (3 3 7, 4 4 8))", ""},
                                              {"POLYGON ((0 0, 9 0, 9 9, 0 0), (1 1, 2 1, 2 2, 1 1))", ""},
                                              {"LINESTRING EMPTY", ""}}),
                                       {}, EdgeKind::Ridge);
  const std::vector<SurveyLine>& lines = result.survey.lines;
  ASSERT_THAT(lines, SizeIs(5));
  EXPECT_THAT(lines[0].z, IsEmpty());
  EXPECT_THAT(lines[0].xy, SizeIs(3));
  EXPECT_EQ(lines[0].kind, EdgeKind::Ridge);
  EXPECT_THAT(lines[1].z, ElementsAre(5, 6));
  EXPECT_THAT(lines[2].z, ElementsAre(7, 8));
  EXPECT_EQ(lines[2].feature, 2);
  EXPECT_EQ(lines[2].part, 1U);
  EXPECT_EQ(lines[3].xy.front(), lines[3].xy.back());
  EXPECT_EQ(lines[4].part, 1U);
  EXPECT_EQ(result.breaklines_read, 5U);
  EXPECT_EQ(result.breakline_vertices, 15U);
  EXPECT_TRUE(has_note(result, "without geometry"));
}

TEST_F(ReadLayers, LinearisesCurvesAndSkipsWhatIsNoLine) {
  const ReadResult arc = read_lines(layer({{"CIRCULARSTRING (0 0, 1 1, 2 0)", ""},
                                           {"CURVEPOLYGON (CIRCULARSTRING (0 0, 1 1, 2 0, 1 -1, 0 0))", ""},
                                           {"LINESTRING (5 5)", ""}}));
  ASSERT_THAT(arc.survey.lines, SizeIs(2));
  EXPECT_GT(arc.survey.lines[0].xy.size(), 10U);
  EXPECT_EQ(arc.survey.lines[0].xy.front(), (Point2{0, 0}));
  EXPECT_EQ(arc.survey.lines[0].xy.back(), (Point2{2, 0}));
  EXPECT_EQ(arc.survey.lines[1].xy.front(), arc.survey.lines[1].xy.back());
  EXPECT_EQ(arc.breaklines_read, 3U);
  EXPECT_EQ(arc.breakline_vertices, arc.survey.lines[0].xy.size() + arc.survey.lines[1].xy.size());
  EXPECT_TRUE(has_note(arc, "1 lines of fewer than two vertices"));
}

TEST_F(ReadLayers, SkipsArraysThatAreNoLine) {
  const MemorySource memory{.xy = {{0, 0}, {1, 0}, {0, 1}},
                            .z = {1, 2, 3},
                            .lines = {{.kind = EdgeKind::Ridge, .xy = {{0, 0}}},
                                      {.kind = EdgeKind::Ridge, .xy = {{0, 0}, {1, 0}}},
                                      {.kind = EdgeKind::Ridge}}};
  Progress progress;
  const ReadResult result = read_survey({}, {}, {}, progress, memory);
  ASSERT_THAT(result.survey.lines, SizeIs(1));
  EXPECT_EQ(result.survey.lines[0].feature, 1);
  EXPECT_EQ(result.breaklines_read, 3U);
  EXPECT_EQ(result.breakline_vertices, 2U);
  EXPECT_TRUE(has_note(result, "2 lines of fewer than two vertices"));
}

TEST_F(ReadLayers, GivesLinesTheHeightOfAField) {
  const std::string contours =
      layer({{"LINESTRING (0 0, 1 1)", "", 50}, {"LINESTRING Z (0 0 1, 1 1 2)", "", 60}});
  const ReadResult result = read_lines(contours, {.line_z_field = "elev"});
  EXPECT_THAT(result.survey.lines[0].z, ElementsAre(50, 50));
  EXPECT_THAT(result.survey.lines[1].z, ElementsAre(60, 60));
  expect_error(ErrorCode::MissingHeight, {"one.gpkg", "height"},
               [&] { read_lines(contours, {.line_z_field = "height"}); });
  const std::string gap = layer({{"LINESTRING (0 0, 1 1)", ""}});
  expect_error(ErrorCode::MissingHeight, {"feature 1", "elev"},
               [&] { read_lines(gap, {.line_z_field = "elev"}); });
}

TEST_F(ReadLayers, ReadsKindsFromAField) {
  const std::string file = layer({{"LINESTRING (0 0, 1 1)", "Ridge line"},
                                  {"LINESTRING (0 0, 1 1)", "VALLEY"},
                                  {"LINESTRING (0 0, 1 1)", "bridge"},
                                  {"LINESTRING (0 0, 1 1)", "-"}});
  const auto kinds = [&](EdgeKind kind) {
    std::vector<EdgeKind> found;
    for (const SurveyLine& line : read_lines(file, {.kind_field = "kind"}, kind).survey.lines)
      found.push_back(line.kind);
    return found;
  };
  EXPECT_THAT(kinds(EdgeKind::Breakline),
              ElementsAre(EdgeKind::Ridge, EdgeKind::Valley, EdgeKind::Breakline, EdgeKind::Breakline));
  EXPECT_THAT(kinds(EdgeKind::Valley),
              ElementsAre(EdgeKind::Ridge, EdgeKind::Valley, EdgeKind::Valley, EdgeKind::Valley));
  expect_error(ErrorCode::Usage, {"one.gpkg", "type"}, [&] { read_lines(file, {.kind_field = "type"}); });
}

TEST_F(ReadLayers, NamesWrongGeometries) {
  expect_error(ErrorCode::WrongGeometry, {"feature 1", "Line String", "--breaklines"}, [&] {
    read({layer({{"LINESTRING Z (0 0 1, 1 1 1)", ""}})});
  });
  expect_error(ErrorCode::WrongGeometry, {"feature 2", "Point", "line or polygon"}, [&] {
    read_lines(layer({{"LINESTRING (0 0, 1 1)", ""}, {"POINT (1 1)", ""}}));
  });
  expect_error(ErrorCode::WrongGeometry, {"no layer of points", "things (Line String)"}, [&] {
    read({layer({{"LINESTRING (0 0, 1 1)", ""}}, "LINESTRING")});
  });
  const std::string points = layer({{"POINT (1 1)", ""}}, "POINT");
  expect_error(ErrorCode::WrongGeometry, {"one.gpkg|things holds Point"},
               [&] { read_lines(points + "|layername=things"); });
  expect_error(ErrorCode::WrongGeometry, {"feature 1", "no ring"}, [&] {
    read_lines(layer({{"LINESTRING (0 0, 1 1, 1 0)", ""}}), {}, EdgeKind::Boundary);
  });
  EXPECT_THAT(read_lines(layer({{"LINESTRING (0 0, 1 1, 1 0, 0 0)", ""}}), {}, EdgeKind::Lake).survey.lines,
              SizeIs(1));
}

TEST_F(ReadLayers, ChoosesTheOnlyLayerThatFits) {
  const std::string file = path("many.gpkg");
  write_layer(file, "pegs", "EPSG:32611", {{"POINT Z (1 2 3)", ""}}, "POINT");
  write_layer(file, "walls", "EPSG:32611", {{"LINESTRING (0 0, 1 1)", ""}}, "LINESTRING");
  EXPECT_EQ(read({file}).survey.sources[0].layer, "pegs");
  EXPECT_THAT(read_lines(file).survey.lines, SizeIs(1));
  write_layer(file, "pegs2", "EPSG:32611", {{"POINT Z (1 2 4)", ""}}, "POINT");
  expect_error(ErrorCode::Usage, {"several layers", "pegs", "pegs2", "walls", "|layername="},
               [&] { read({file}); });
  EXPECT_THAT(read({file + "|layername=pegs2"}).survey.points.z, ElementsAre(4));
  expect_error(ErrorCode::NotFound, {"no layer pegs3", "pegs2"}, [&] { read({file + "|layername=pegs3"}); });
  write_layer(file, "empty", "EPSG:32611", {}, "POINT");
  expect_error(ErrorCode::EmptyInput, {"many.gpkg|empty"}, [&] { read({file + "|layername=empty"}); });
}

TEST_F(ReadLayers, FiltersByAttributes) {
  const std::string file = layer({{"POINT Z (1 1 1)", "a", 5}, {"POINT Z (2 2 2)", "b", 6}});
  EXPECT_THAT(read({file}, {.where = "elev > 5"}).survey.points.z, ElementsAre(2));
  EXPECT_THAT(read({file}, {.where = "kind = 'a'"}).survey.points.z, ElementsAre(1));
  expect_error(ErrorCode::Usage, {"one.gpkg", "klass"}, [&] { read({file}, {.where = "klass = 'a'"}); });
  expect_error(ErrorCode::EmptyInput, {"elev > 7"}, [&] { read({file}, {.where = "elev > 7"}); });
}

TEST_F(ReadLayers, ReadsLayersThatAConditionDoesNotFitWhole) {
  const std::string points = write("p.csv", "x,y,z,class\n1,1,1,2\n2,2,2,3\n");
  const std::string walls = layer({{"LINESTRING (0 0, 1 1)", ""}});
  const ReadResult result =
      read({points}, {.where = "class = 2"}, {{parse_source(walls), EdgeKind::Breakline}});
  EXPECT_THAT(result.survey.points.z, ElementsAre(1));
  EXPECT_THAT(result.survey.lines, SizeIs(1));
  EXPECT_TRUE(has_note(result, "read without"));
}

TEST_F(ReadLayers, KeepsLinesThatMeetTheBox) {
  const std::string file = layer({{"LINESTRING (-5 0.5, 5 0.5)", ""},
                                  {"LINESTRING (0 2, 2 0)", ""},      // touches the corner
                                  {"LINESTRING (0 2.1, 2.1 0)", ""},  // its box meets, it does not
                                  {"LINESTRING (5 5, 6 6)", ""}});
  const ReadOptions box{.bbox = Box2{0, 0, 1, 1}};
  const ReadResult result = read_lines(file, box);
  EXPECT_THAT(result.survey.lines, SizeIs(2));
  EXPECT_EQ(result.lines_outside_bbox, 2U);
  EXPECT_EQ(result.survey.lines[0].xy.front(), (Point2{-5, 0.5}));

  const std::string around =
      layer({{"POLYGON ((-9 -9, 9 -9, 9 9, -9 9, -9 -9))", ""},
             {"POLYGON ((-9 -9, 9 -9, 9 9, -9 9, -9 -9), (-2 -2, 2 -2, 2 2, -2 2, -2 -2))", ""},
             {"POLYGON ((5 5, 6 5, 6 6, 5 5))", ""}});
  EXPECT_EQ(read_lines(around, box, EdgeKind::Lake).survey.lines.size(), 1U);
  EXPECT_EQ(read_lines(around, box, EdgeKind::Boundary).survey.lines.size(), 4U);
  EXPECT_EQ(read_lines(around, box, EdgeKind::Breakline).survey.lines.size(), 0U);
}

TEST_F(ReadLayers, ReadsGeojsonWithLegacyCrs) {
  const std::string file =
      write("p.geojson",
            R"({"type":"FeatureCollection","crs":{"type":"name","properties":{"name":"EPSG:32611"}},
      "features":[{"type":"Feature","properties":{"kind":"ridge"},"geometry":
      {"type":"LineString","coordinates":[[400000,3800000,5],[400010,3800000,6]]}}]})");
  const ReadResult result = read_lines(file);
  EXPECT_EQ(result.crs.authority, "EPSG:32611");
  EXPECT_THAT(result.survey.lines[0].z, ElementsAre(5, 6));
}

TEST_F(ReadLayers, NamesBrokenFiles) {
  expect_error(ErrorCode::NotFound, {"absent.gpkg"}, [&] { read({path("absent.gpkg")}); });
  expect_error(ErrorCode::NotFound, {"absent.shp"}, [&] { read_lines(path("absent.shp")); });
  expect_error(ErrorCode::Unreadable, {"bad.gpkg"}, [&] { read({write("bad.gpkg", "this is none")}); });
  expect_error(ErrorCode::Unreadable, {"bad.geojson"},
               [&] { read({write("bad.geojson", R"({"type":"FeatureCollection","features":[{)")}); });
}

}  // namespace
}  // namespace thalweg
