// Source names, CRSs, several sources in one plane, and the real terrains' counts.
#include "read_fixture.hpp"

#include <thalweg/io/crs.hpp>

#include <gmock/gmock.h>

#include <cstdlib>

namespace thalweg {
namespace {

using testing::ElementsAre;

class ParseSource : public ReadTest {};

TEST_F(ParseSource, SplitsPathAndLayer) {
  EXPECT_EQ(parse_source("a b.csv").path, "a b.csv");
  EXPECT_EQ(parse_source("a.gpkg|layername=x|y").path, "a.gpkg");
  EXPECT_EQ(parse_source("a.gpkg|layername=x|y").layer, "x|y");
  EXPECT_EQ(parse_source("a.gpkg|LayerName=Main").layer, "Main");
  EXPECT_EQ(parse_source("odd|name.csv").path, "odd|name.csv");
  for (const std::string text :
       {"", "|layername=x", "a.gpkg|layername=", "a.gpkg|layerid=0", "a.gpkg|layername=x|subset=y"}) {
    expect_error(ErrorCode::Usage, {}, [&] { parse_source(text); });
  }
}

class DescribeCrs : public ReadTest {};

TEST_F(DescribeCrs, TellsUnitsAndEllipsoid) {
  const CrsInfo unknown = describe_crs("");
  EXPECT_FALSE(unknown.known);
  EXPECT_EQ(unknown.horizontal_metres_per_unit, 1);
  const CrsInfo utm = describe_crs("EPSG:32611");
  EXPECT_EQ(utm.authority, "EPSG:32611");
  EXPECT_EQ(utm.name, "WGS 84 / UTM zone 11N");
  EXPECT_FALSE(utm.geographic);
  EXPECT_FALSE(utm.vertical_unit_told);
  const CrsInfo feet = describe_crs("EPSG:2994");
  EXPECT_EQ(feet.horizontal_metres_per_unit, 0.3048);
  EXPECT_EQ(feet.vertical_metres_per_unit, 0.3048);
  EXPECT_FALSE(feet.vertical_unit_told);
  EXPECT_NEAR(feet.flattening, 1 / 298.257222101, 1e-15);
  const CrsInfo compound = describe_crs("EPSG:2994+5703");
  EXPECT_EQ(compound.vertical_metres_per_unit, 1);
  EXPECT_TRUE(compound.vertical_unit_told);
  EXPECT_NEAR(describe_crs("EPSG:32611+6360").vertical_metres_per_unit, 1200.0 / 3937, 1e-12);
  EXPECT_NEAR(describe_crs("+proj=utm +zone=11 +vunits=us-ft").vertical_metres_per_unit, 1200.0 / 3937,
              1e-12);
  const CrsInfo degrees = describe_crs("EPSG:4326");
  EXPECT_TRUE(degrees.geographic);
  EXPECT_EQ(degrees.degrees_per_unit, 1);
  EXPECT_EQ(degrees.vertical_metres_per_unit, 1);
  EXPECT_TRUE(describe_crs("EPSG:4979").vertical_unit_told);
  const CrsInfo grads = describe_crs("EPSG:4807");
  EXPECT_EQ(grads.degrees_per_unit, 0.9);
  EXPECT_NEAR(grads.prime_meridian_deg, 2.33722917, 1e-12);
  EXPECT_EQ(describe_crs("+proj=longlat +R=6370000").flattening, 0);
  EXPECT_EQ(describe_crs(write("a.prj", describe_crs("EPSG:28992").wkt)).authority, "EPSG:28992");
}

TEST_F(DescribeCrs, NamesWhatItCannotUse) {
  for (const std::string text :
       {"bogus", "EPSG:999999", "EPSG:4978", "EPSG:5703", "https://example.com/a.prj"}) {
    expect_error(ErrorCode::BadCrs, {text}, [&] { describe_crs(text); });
  }
}

class ReadSurvey : public ReadTest {
 protected:
  std::string points_in(const std::string& name, const std::string& crs, const std::string& wkt) const {
    write_layer(path(name + ".gpkg"), name, crs, {{wkt, ""}}, "POINT");
    return path(name + ".gpkg");
  }
};

TEST_F(ReadSurvey, BringsSourcesIntoTheFirstCrs) {
  const std::string utm = points_in("utm", "EPSG:32611", "POINT Z (500000 4000000 7)");
  const std::string degrees = points_in("degrees", "EPSG:4326", "POINT Z (-117 36.1449180 8)");
  const std::string none = write("none.csv", "x,y,z\n500000,4000000,9\n");
  const ReadResult result = read({none, utm, degrees});
  EXPECT_EQ(result.crs.authority, "EPSG:32611");
  EXPECT_TRUE(has_note(result, "none.csv declares no CRS"));
  EXPECT_THAT(result.survey.points.z, ElementsAre(9, 7, 8));
  EXPECT_EQ(result.survey.points.xy[0], result.survey.points.xy[1]);
  EXPECT_NEAR(result.survey.points.xy[2].x, 500000, 1e-6);
  EXPECT_NEAR(result.survey.points.xy[2].y, 4000000, 50);
  ASSERT_EQ(result.survey.points.runs.size(), 3U);
  EXPECT_EQ(result.survey.points.runs[2].first, 2U);
  EXPECT_EQ(result.survey.points.runs[2].source, 2U);
  EXPECT_EQ(result.survey.sources[1].file, utm);

  const ReadResult target = read({utm}, {.target_crs = "EPSG:4326"});
  EXPECT_NEAR(target.survey.points.xy[0].x, -117, 1e-9);
  EXPECT_NEAR(target.survey.points.xy[0].y, 36.14, 0.01);
}

TEST_F(ReadSurvey, KeepsEveryBitWhereNothingIsTransformed) {
  const double x = 500000.1234567891;
  const std::string utm = points_in("utm", "EPSG:32611", "POINT Z (500000.1234567891 4000000.3 7.7)");
  for (const std::string crs : {"", "EPSG:32611", "+proj=utm +zone=11 +datum=WGS84", "EPSG:32611+5773"}) {
    const ReadResult result = read({utm}, {.target_crs = crs});
    EXPECT_EQ(result.survey.points.xy[0].x, x) << crs;
    EXPECT_EQ(result.survey.points.z[0], 7.7) << crs;
  }
  const ReadResult assigned = read({utm}, {.assigned_crs = "EPSG:26911"});
  EXPECT_EQ(assigned.survey.points.xy[0].x, x);
  EXPECT_EQ(assigned.crs.authority, "EPSG:26911");
}

TEST_F(ReadSurvey, BringsHeightsToOneUnit) {
  const std::string feet = points_in("feet", "EPSG:2994", "POINT Z (637148.03 849062.47 1000)");
  const ReadResult same = read({feet});
  EXPECT_EQ(same.survey.points.z[0], 1000);
  EXPECT_EQ(same.crs.vertical_metres_per_unit, 0.3048);
  EXPECT_TRUE(has_note(same, "does not tell the unit of heights"));
  const ReadResult metres = read({feet}, {.target_crs = "EPSG:32610"});
  EXPECT_NEAR(metres.survey.points.z[0], 304.8, 1e-9);
  EXPECT_TRUE(has_note(metres, "heights of"));
  const ReadResult told = read({feet}, {.source_crs = "EPSG:2994+5703", .target_crs = "EPSG:32610"});
  EXPECT_EQ(told.survey.points.z[0], 1000);
  EXPECT_NEAR(
      read({feet}, {.source_crs = "EPSG:2994+6360", .target_crs = "EPSG:32610+5703"}).survey.points.z[0],
      1000 * 1200.0 / 3937, 1e-6);
}

TEST_F(ReadSurvey, NamesWhatCannotBeBroughtTogether) {
  const std::string none = write("none.csv", "x,y,z\n500000,4000000,9\n");
  expect_error(ErrorCode::BadCrs, {"EPSG:4326", "--s-crs"},
               [&] { read({none}, {.target_crs = "EPSG:4326"}); });
  expect_error(ErrorCode::BadCrs, {"bogus"}, [&] { read({none}, {.source_crs = "bogus"}); });
  expect_error(ErrorCode::Usage, {"--t-crs"},
               [&] { read({none}, {.target_crs = "EPSG:4326", .assigned_crs = "EPSG:4326"}); });
  expect_error(ErrorCode::BadCoordinate, {"none.csv", "500000, 4000000", "WGS 84"},
               [&] { read({none}, {.assigned_crs = "EPSG:4326"}); });
  const std::string swapped = write("swapped.csv", "x,y,z\n36,-117,9\n");
  expect_error(ErrorCode::BadCoordinate, {"swapped?"},
               [&] { read({swapped}, {.assigned_crs = "EPSG:4326"}); });
  expect_error(ErrorCode::BadCoordinate, {"none.csv", "(500000, 4000000)", "cannot be transformed"},
               [&] { read({none}, {.source_crs = "EPSG:4326", .target_crs = "EPSG:32611"}); });
  const std::string local = points_in("local", "LOCAL_CS[\"site\",UNIT[\"metre\",1]]", "POINT Z (1 2 3)");
  const std::string utm = points_in("utm", "EPSG:32611", "POINT Z (500000 4000000 7)");
  expect_error(ErrorCode::BadCrs, {"local.gpkg", "site"}, [&] { read({utm, local}); });
  EXPECT_EQ(read({local}).crs.name, "site");
}

TEST_F(ReadSurvey, LeavesOutWhatIsOutsideTheBox) {
  const std::string file = write("p.csv", "x,y,z\n0,0,1\n1,1,2\n2,2,3\n");
  const ReadResult result = read({file}, {.bbox = Box2{0.5, 0.5, 2, 2}});
  EXPECT_THAT(result.survey.points.z, ElementsAre(2, 3));
  EXPECT_EQ(result.points_read, 3U);
  EXPECT_EQ(result.outside_bbox, 1U);
  expect_error(ErrorCode::EmptyInput, {"p.csv", "box is 7, 7, 8, 8", "0, 0, 2, 2"}, [&] {
    read({file}, {.bbox = Box2{7, 7, 8, 8}});
  });
  expect_error(ErrorCode::Usage, {"xmin,ymin,xmax,ymax"}, [&] { read({file}, {.bbox = Box2{1, 0, 0, 1}}); });
}

TEST_F(ReadSurvey, TakesTheVerticesOfMeshes) {
  const std::string ply =
      write("m.ply",
            "ply\nformat ascii 1.0\ncomment crs: EPSG:32611\nelement vertex 3\nproperty double x\n"
            "property double y\nproperty double z\nelement face 1\n"
            "property list uchar int vertex_indices\nend_header\n"
            "500000 4000000 1\n500010 4000000 2\n500000 4000010 3\n3 0 1 2\n");
  const ReadResult result = read({ply});
  EXPECT_THAT(result.survey.points.z, ElementsAre(1, 2, 3));
  EXPECT_EQ(result.crs.authority, "EPSG:32611");
  const std::string cloud =
      write("c.ply",
            "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\n"
            "property float z\nend_header\n1 2 3\n4 5 6\n");
  EXPECT_THAT(read({cloud}).survey.points.z, ElementsAre(3, 6));
  expect_error(ErrorCode::Unsupported, {"x.ply"}, [&] { read({write("x.ply", "no mesh")}); });
  expect_error(ErrorCode::NotFound, {"absent.ply"}, [&] { read({path("absent.ply")}); });
}

TEST_F(ReadSurvey, RefusesOptionsThatFitNothing) {
  const std::string file = write("p.csv", "x,y,z\n0,0,1\n1,1,2\n2,2,3\n");
  expect_error(ErrorCode::MissingHeight, {"elev"}, [&] { read({file}, {.line_z_field = "elev"}); });
  expect_error(ErrorCode::Usage, {"kind"}, [&] { read({file}, {.kind_field = "kind"}); });
}

TEST_F(ReadSurvey, ReportsProgressFromNoneToAll) {
  const std::string file = write("p.csv", "x,y,z\n0,0,1\n1,1,2\n");
  std::vector<double> fractions;
  Progress progress([&](const std::string& phase, double fraction) {
    EXPECT_EQ(phase, "read");
    fractions.push_back(fraction);
  });
  const std::vector<SourceSpec> specs{{file, ""}, {file, ""}};
  read_survey(specs, {}, {}, progress);
  ASSERT_GE(fractions.size(), 2U);
  EXPECT_EQ(fractions.front(), 0);
  EXPECT_EQ(fractions.back(), 1);
  EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
}

/// Counts of README.md beside the terrains.
class ReadTerrains : public ReadTest {
 protected:
  void SetUp() override {
    const char* given = std::getenv("THALWEG_TERRAINS");
    terrains_ = given != nullptr ? given : THALWEG_SOURCE_DIR "/../shared/terrains";
    if (!std::filesystem::is_directory(terrains_)) GTEST_SKIP() << "no terrains in " << terrains_;
  }
  [[nodiscard]] std::string terrain(const std::string& name) const { return terrains_ + "/" + name; }

 private:
  std::string terrains_;
};

TEST_F(ReadTerrains, HoldWhatTheirReadmeSays) {
  EXPECT_EQ(read({terrain("bigtujunga_srtm30/dem.tif")}).points_read, 200000U);
  const ReadResult degrees = read({terrain("jacksboro_lonlat/dem.tif")});
  EXPECT_EQ(degrees.points_read, 403U * 344U);
  EXPECT_TRUE(degrees.crs.geographic);
  const ReadResult marsh = read({terrain("tidal_marsh_nodata/dem.tif")});
  EXPECT_EQ(marsh.points_read, 100448U);
  EXPECT_EQ(marsh.nodata_skipped, 300U * 452U - 100448U);
  EXPECT_EQ(marsh.nodata_holes, 0U);
  EXPECT_FALSE(marsh.nodata.empty());
  const ReadResult holes = read({terrain("slovenia_lidar1m/dem_nan_holes.tif")});
  EXPECT_EQ(holes.nodata_skipped, 109U);
  EXPECT_EQ(holes.nodata_holes, 108U);  // one lies in the first column
  EXPECT_EQ(read({terrain("staffordshire_sk00_contours/contours.gpkg")}).points_read, 56U);
  EXPECT_EQ(read({terrain("baja_ship_tracks_lonlat/soundings.csv")}).points_read, 82970U);
  EXPECT_EQ(read({terrain("autzen_lidar_feet/all_points.csv")}, {.where = "class = 2"}).points_read, 2719U);
}

TEST_F(ReadTerrains, HoldTheLinesThatTheirReadmeSays) {
  const auto lines = [&](const std::string& source) {
    const ReadResult result = read_lines(terrain(source));
    return std::pair(result.breaklines_read, result.breakline_vertices);
  };
  EXPECT_EQ(lines("bigtujunga_srtm30/lines.gpkg|layername=valleys"), std::pair(219UL, 5892UL));
  // One of them is a single vertex.
  EXPECT_EQ(lines("bigtujunga_srtm30/lines.gpkg|layername=ridges"), std::pair(224UL, 5731UL));
  EXPECT_EQ(lines("jacksboro_lonlat/lines.gpkg|layername=ridges_3d"), std::pair(217UL, 4877UL));
  EXPECT_EQ(lines("staffordshire_sk00_contours/contours.gpkg|layername=contours"), std::pair(322UL, 34644UL));
  EXPECT_EQ(lines("delft_ahn3_bgt/bgt.gpkg|layername=breaklines_3d"), std::pair(199UL, 4298UL));
}

}  // namespace
}  // namespace thalweg
