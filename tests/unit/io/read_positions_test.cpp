// Positions in text (degrees, minutes and seconds, UTM, MGRS), and heights above a geoid.
#include "read_fixture.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <cstdlib>

namespace thalweg {
namespace {

constexpr double kNearDeg = 1e-9;
constexpr double kNearM = 1e-6;

class ReadPositions : public ReadTest {
 protected:
  /// Expects the one point of a file, and its height 412.5.
  void expect_point(const std::string& content, PositionForm form, Point2 lonlat) {
    const ReadResult result = read({write("p.csv", content)}, {.coords = form});
    ASSERT_EQ(result.survey.points.xy.size(), 1U) << content;
    EXPECT_NEAR(result.survey.points.xy[0].x, lonlat.x, kNearDeg) << content;
    EXPECT_NEAR(result.survey.points.xy[0].y, lonlat.y, kNearDeg) << content;
    EXPECT_EQ(result.survey.points.z[0], 412.5) << content;
    EXPECT_EQ(result.crs.authority, "EPSG:4326");
  }
};

TEST_F(ReadPositions, TakesDegreesMinutesSeconds) {
  const Point2 here = {11 + 30.0 / 60 + 36.0 / 3600, -(47 + 15.0 / 60)};
  for (const char* row :
       {"11d30'36\"E,47d15'00\"S,412.5\n", "11:30:36,-47:15:0,412.5\n", "11.51,-47.25,412.5\n",
        "47:15:00S,11:30:36E,412.5\n", "11 30 36 E,47 15 S,412.5\n", "\"11d30'36\"\"E\",47:15S,412.5\n",
        "lat;lon;z\n47:15:00S;11:30:36E;412.5\n", "lon,lat,z\n11:30:36,-47:15,412.5\n",
        "11°30'36\"E\t47°15'S\t412.5\n", "# survey\n11:30:36E 47:15S 412.5\n"}) {
    expect_point(row, PositionForm::Dms, here);
  }
}

TEST_F(ReadPositions, TakesUtmAndMgrs) {
  // On the central meridian of zone 32 the easting is 500 km; the equator is northing 0.
  expect_point("32N 500000 0,412.5\n", PositionForm::Utm, {9, 0});
  expect_point("32n,500000,0,412.5\n", PositionForm::Utm, {9, 0});
  expect_point("zone,easting,northing,z\n32S,500000,10000000,412.5\n", PositionForm::Utm, {9, 0});
  expect_point("id;z;utm\n7;412.5;60N 500000 0\n", PositionForm::Utm, {177, 0});
  const ReadResult mgrs =
      read({write("m.csv", "mgrs,z\n32TPS7600048000,1\n32T PS 76100 48000,2\n32TPS764480,3\n")},
           {.target_crs = "EPSG:32632", .coords = PositionForm::Mgrs});
  const std::vector<Point2> expected = {{676000.5, 5148000.5}, {676100.5, 5148000.5}, {676450, 5148050}};
  ASSERT_EQ(mgrs.survey.points.xy.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_NEAR(mgrs.survey.points.xy[i].x, expected[i].x, kNearM);
    EXPECT_NEAR(mgrs.survey.points.xy[i].y, expected[i].y, kNearM);
  }
}

TEST_F(ReadPositions, NamesTheRowOfWhatItCannotRead) {
  const auto refused = [&](const std::string& content, PositionForm form, ErrorCode code,
                           const std::vector<std::string>& texts) {
    expect_error(code, texts, [&] { read({write("p.csv", content)}, {.coords = form}); });
  };
  refused("11:30E,47:15N,1\n11:70E,47N,1\n", PositionForm::Dms, ErrorCode::BadCoordinate,
          {"row 2", "11:70E"});
  refused("11:30E,95N,1\n", PositionForm::Dms, ErrorCode::BadCoordinate, {"row 1", "95"});
  refused("11:30E,12E,1\n", PositionForm::Dms, ErrorCode::BadCoordinate, {"row 1"});
  refused("11:30E,4:7:15:9:1N,1\n", PositionForm::Dms, ErrorCode::BadCoordinate, {"row 1", "finer"});
  refused("11:30E,4'7:15:9N,1\n", PositionForm::Dms, ErrorCode::BadCoordinate, {"row 1", "not both"});
  refused("32U 676000 5148000,1\n", PositionForm::Utm, ErrorCode::BadCoordinate, {"row 1", "32U"});
  refused("61N 500000 0,1\n", PositionForm::Utm, ErrorCode::BadCoordinate, {"row 1", "61"});
  refused("32TPS,1\n", PositionForm::Mgrs, ErrorCode::BadCoordinate, {"row 1", "10 km"});
  refused("32TIO7600048000,1\n", PositionForm::Mgrs, ErrorCode::BadCoordinate, {"row 1", "32TIO"});
  refused("32N,500000\n", PositionForm::Utm, ErrorCode::MissingHeight, {"z"});
  refused("id,x,y,z\n1,2,3,4\n", PositionForm::Utm, ErrorCode::BadFormat, {"zone, x, y"});
  refused("11E,47N,\n", PositionForm::Dms, ErrorCode::MissingHeight, {"row 1"});
  expect_error(ErrorCode::Usage, {"--coords", "EPSG:32632", "--t-crs"}, [&] {
    read({write("p.csv", "11E,47N,1\n")}, {.source_crs = "EPSG:32632", .coords = PositionForm::Dms});
  });
}

/// A geoid of 47.5 m everywhere, at the place where the library looks for it.
class ReadGeoid : public ReadTest {
 protected:
  ReadGeoid() {
    constexpr int kWidth = 36, kHeight = 19, kSteps = 475;  // of 0.1 m
    std::string content =
        "P5\n# Geoid file in PGM format for the GeographicLib::Geoid class\n# Description test\n"
        "# DateTime 2000-01-01 00:00:00\n# MaxBilinearError 0.1\n# RMSBilinearError 0.1\n# MaxCubicError "
        "0.1\n"
        "# RMSCubicError 0.1\n# Offset -100\n# Scale 0.1\n# Origin 90N 0E\n# AREA_OR_POINT Point\n"
        "# Vertical_Datum WGS84\n36 19\n65535\n";
    for (int i = 0; i < kWidth * kHeight; ++i) {
      content += static_cast<char>((kSteps + 1000) / 256);
      content += static_cast<char>((kSteps + 1000) % 256);
    }
    std::string file = write("level.pgm", content);
    setenv("GEOGRAPHICLIB_GEOID_PATH", file.substr(0, file.rfind('/')).c_str(), 1);
  }
  ~ReadGeoid() override { unsetenv("GEOGRAPHICLIB_GEOID_PATH"); }
};

TEST_F(ReadGeoid, IsTakenOffOrAdded) {
  const std::string points = write("p.csv", "x,y,z\n11,47,500\n179.9,-89,100\n-179.9,-89,100\n");
  const ReadResult down = read({points}, {.source_crs = "EPSG:4326", .geoid = "level"});
  EXPECT_THAT(down.survey.points.z, testing::Pointwise(testing::DoubleNear(1e-9), {452.5, 52.5, 52.5}));
  EXPECT_TRUE(has_note(down, "47.500 to 47.500 m, were taken off"));
  const ReadResult up =
      read({points}, {.source_crs = "EPSG:4326", .geoid = "level", .heights_above = HeightsAbove::Geoid});
  EXPECT_THAT(up.survey.points.z, testing::Pointwise(testing::DoubleNear(1e-9), {547.5, 147.5, 147.5}));
}

TEST_F(ReadGeoid, IsBroughtToTheUnitOfHeightsAndAppliesToLines) {
  // EPSG:2994 is in international feet, and its heights then are too.
  const std::string feet = write("feet.csv", "x,y,z\n630000,850000,1000\n");
  const ReadResult result = read({feet}, {.source_crs = "EPSG:2994", .geoid = "level"});
  EXPECT_NEAR(result.survey.points.z[0], 1000 - 47.5 / 0.3048, 1e-9);
  write_layer(path("l.gpkg"), "l", "EPSG:32632",
              {{"LINESTRING Z (676000 5148000 10, 676100 5148000 20)", "-"}});
  const ReadResult lines = read_lines(path("l.gpkg"), {.geoid = "level"});
  EXPECT_THAT(lines.survey.lines[0].z, testing::Pointwise(testing::DoubleNear(1e-9), {-37.5, -27.5}));
}

TEST_F(ReadGeoid, IsRefusedWithARemedy) {
  const std::string points = write("p.csv", "x,y,z\n11,47,500\n");
  expect_error(ErrorCode::BadCrs, {"--geoid", "--a-crs"}, [&] { read({points}, {.geoid = "level"}); });
  expect_error(ErrorCode::Usage, {"--geoid", "--s-crs"},
               [&] { read({points}, {.source_crs = "EPSG:4979", .geoid = "level"}); });
  expect_error(ErrorCode::NotFound, {"'egm2008-1'", "geographiclib-get-geoids egm2008-1"},
               [&] { read({points}, {.source_crs = "EPSG:4326", .geoid = "egm2008-1"}); });
  write("broken.pgm", "P5\n");
  expect_error(ErrorCode::BadFormat, {"broken.pgm"},
               [&] { read({points}, {.source_crs = "EPSG:4326", .geoid = "broken"}); });
}

}  // namespace
}  // namespace thalweg
