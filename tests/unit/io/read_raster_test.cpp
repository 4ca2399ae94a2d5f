// Elevation rasters: cell centres, nodata and its regions, scale, windows; NodataRegion against brute force.
#include "read_fixture.hpp"
#include "support/random.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <sstream>

namespace thalweg {
namespace {

using testing::ElementsAre;
using testing::SizeIs;

/// Rows of an elevation raster: digits are heights, '.' is a cell without data.
using Rows = std::vector<std::string>;

class ReadRaster : public ReadTest {
 protected:
  std::string write_grid(const std::string& name, const Rows& rows, double x = 0, double y = 0,
                         double cell = 1) const {
    std::ostringstream text;
    text.precision(17);
    text << "ncols " << rows[0].size() << "\nnrows " << rows.size() << "\nxllcorner " << x << "\nyllcorner "
         << y << "\ncellsize " << cell << "\nNODATA_value -9\n";
    for (const std::string& row : rows) {
      for (const char c : row) text << (c == '.' ? "-9" : std::string(1, c)) << ' ';
      text << '\n';
    }
    return write(name, text.str());
  }

  /// A virtual raster of 2 x 2 cells over a grid with the values 1 2 / 3 4.
  std::string write_vrt(const std::string& geotransform, const std::string& band,
                        const std::string& more = "") const {
    write_grid("base.asc", {"12", "34"});
    return write("v.vrt",
                 "<VRTDataset rasterXSize='2' rasterYSize='2'>" +
                     (geotransform.empty() ? "" : "<GeoTransform>" + geotransform + "</GeoTransform>") +
                     "<VRTRasterBand dataType='Int16' band='1'>" + band +
                     "<SimpleSource><SourceFilename relativeToVRT='1'>base.asc</SourceFilename>"
                     "<SourceBand>1</SourceBand></SimpleSource></VRTRasterBand>" +
                     more + "</VRTDataset>");
  }
};

TEST_F(ReadRaster, MakesAPointOfEachCellCentreFromTheTop) {
  const ReadResult result = read({write_grid("g.asc", {"12", "34", "56"}, 100, 200, 10)});
  EXPECT_THAT(result.survey.points.z, ElementsAre(1, 2, 3, 4, 5, 6));
  EXPECT_EQ(result.survey.points.xy[0], (Point2{105, 225}));
  EXPECT_EQ(result.survey.points.xy[1], (Point2{115, 225}));
  EXPECT_EQ(result.survey.points.xy[5], (Point2{115, 205}));
  EXPECT_EQ(result.points_read, 6U);
  EXPECT_EQ(result.nodata_skipped, 0U);
  EXPECT_TRUE(result.nodata.empty());
  EXPECT_THAT(result.survey.sources, SizeIs(1));
  EXPECT_THAT(result.survey.points.runs, SizeIs(1));
}

TEST_F(ReadRaster, FollowsRotatedAndFlippedGeotransforms) {
  EXPECT_EQ(read({write_vrt("0, 0, 2, 0, 2, 0", "")}).survey.points.xy[1], (Point2{1, 3}));
  EXPECT_EQ(read({write_vrt("0, 1, 0, 0, 0, 1", "")}).survey.points.xy[2], (Point2{0.5, 1.5}));
  expect_error(ErrorCode::BadFormat, {"v.vrt", "geotransform"},
               [&] { read({write_vrt("0, 1, 1, 0, 1, 1", "")}); });
  expect_error(ErrorCode::Unsupported, {"v.vrt", "georeference"}, [&] { read({write_vrt("", "")}); });
}

TEST_F(ReadRaster, HonoursScaleOffsetUnitMaskAndBands) {
  const std::string north_up = "0, 1, 0, 2, 0, -1";
  EXPECT_THAT(read({write_vrt(north_up, "<Offset>100</Offset><Scale>0.5</Scale>")}).survey.points.z,
              ElementsAre(100.5, 101, 101.5, 102));
  const ReadResult feet = read({write_vrt(north_up, "<UnitType>ft</UnitType>")});
  EXPECT_EQ(feet.crs.vertical_metres_per_unit, 1) << "without a CRS nothing could tell feet";
  EXPECT_THAT(feet.survey.points.z, ElementsAre(0.3048, 2 * 0.3048, 3 * 0.3048, 4 * 0.3048));
  EXPECT_TRUE(has_note(feet, "are brought from units of 0.3048 m to units of 1 m"));
  const ReadResult nodata = read({write_vrt(north_up, "<NoDataValue>3</NoDataValue>")});
  EXPECT_THAT(nodata.survey.points.z, ElementsAre(1, 2, 4));
  EXPECT_EQ(nodata.nodata_skipped, 1U);
  write_grid("mask.asc", {"10", "11"});
  const std::string mask =
      "<MaskBand><VRTRasterBand dataType='Byte'><SimpleSource><SourceFilename relativeToVRT='1'>mask.asc"
      "</SourceFilename><SourceBand>1</SourceBand></SimpleSource></VRTRasterBand></MaskBand>";
  EXPECT_THAT(read({write_vrt(north_up, "", mask)}).survey.points.z, ElementsAre(1, 3, 4));
  const ReadResult bands = read({write_vrt(north_up, "", "<VRTRasterBand dataType='Byte' band='2'/>")});
  EXPECT_THAT(bands.survey.points.z, ElementsAre(1, 2, 3, 4));
  EXPECT_TRUE(has_note(bands, "2 bands"));
}

TEST_F(ReadRaster, TellsHolesFromOutside) {
  const std::string file = write_grid("g.asc", {"11111.",  //
                                                "1.1.1.",  //
                                                "11.111",  //
                                                "111111",  //
                                                "1.1111"});
  const ReadResult result = read({file});
  EXPECT_EQ(result.nodata_skipped, 6U);
  EXPECT_EQ(result.points_read, 24U);
  EXPECT_EQ(result.nodata_holes, 1U);  // connected over corners
  EXPECT_EQ(result.bridged_cells, 3U);
  EXPECT_FALSE(result.nodata.outside({1.5, 3.5}));  // centre of a hole
  EXPECT_TRUE(result.nodata.outside({1.5, 0.6}));
  EXPECT_TRUE(result.nodata.outside({5.4, 3.5}));

  const ReadResult all = read({file}, {.nodata = NodataMode::BridgeAll});
  EXPECT_TRUE(all.nodata.empty());
  EXPECT_EQ(all.nodata_holes, 3U);
  EXPECT_EQ(all.bridged_cells, 6U);
  const ReadResult none = read({file}, {.nodata = NodataMode::BridgeNone});
  EXPECT_EQ(none.nodata_holes, 0U);
  EXPECT_TRUE(none.nodata.outside({1.5, 3.5}));
}

TEST_F(ReadRaster, AsksForAdmissionBeforeAllIsRead) {
  const std::string file = write_grid("g.asc", {"1.11", "1111", "1111", "1111"});
  const auto most = [](std::size_t points) {
    if (points > 5) throw Error(ErrorCode::SizeLimit, std::to_string(points));
  };
  expect_error(ErrorCode::SizeLimit, {"7"}, [&] { read({file}, {.admit = most}); });
}

TEST_F(ReadRaster, JudgesDualCellsByTheirValidCorners) {
  // Centres at 0.5, 1.5, 2.5; the one at (0.5, 2.5) is invalid and touches the frame.
  const ReadResult one = read({write_grid("g.asc", {".11", "111", "111"})});
  EXPECT_TRUE(one.nodata.outside({0.7, 2.3}));
  EXPECT_TRUE(one.nodata.outside({0.5, 2.5}));
  EXPECT_FALSE(one.nodata.outside({1.0, 2.0}));  // on the diagonal
  EXPECT_FALSE(one.nodata.outside({1.2, 1.8}));
  EXPECT_FALSE(one.nodata.outside({2.0, 2.0}));
  EXPECT_FALSE(one.nodata.outside({0.4, 2.7}));  // beyond the frame of centres
  EXPECT_FALSE(one.nodata.outside({-100, 50}));
  // Two valid corners of four make no ground.
  const ReadResult two = read({write_grid("h.asc", {".11", "1.1", "111"})});
  EXPECT_TRUE(two.nodata.outside({1.0, 2.0}));
  EXPECT_FALSE(two.nodata.outside({2.3, 2.3}));
}

TEST_F(ReadRaster, LetsGroundOfAnotherRasterWin) {
  const std::string gap = write_grid("a.asc", {"11.", "11.", "11."});
  EXPECT_TRUE(read({gap}).nodata.outside({2.4, 1.5}));
  const ReadResult both = read({gap, write_grid("b.asc", {"55", "55"}, 1.5, 0.5)});
  EXPECT_FALSE(both.nodata.outside({2.4, 1.5}));
  EXPECT_TRUE(both.nodata.outside({2.4, 0.6}));
}

TEST_F(ReadRaster, TakesTheBoxForTheFrame) {
  const std::string file = write_grid("g.asc", {"1111111", "11...11", "11...11", "1111111", "1111111"});
  const ReadResult result = read({file}, {.bbox = Box2{0, 0, 3.6, 5}});
  EXPECT_EQ(result.points_read, 16U);
  EXPECT_EQ(result.nodata_skipped, 4U);
  EXPECT_EQ(result.outside_bbox, 15U);
  EXPECT_EQ(result.nodata_holes, 0U);  // the box cuts the hole
  EXPECT_TRUE(result.nodata.outside({3, 3}));
  EXPECT_FALSE(result.nodata.outside({4.2, 3}));  // nothing is known beyond the box
  EXPECT_EQ(result.survey.points.xy[0], (Point2{0.5, 4.5}));
  const ReadResult whole = read({file}, {.bbox = Box2{0, 0, 7, 5}});
  EXPECT_EQ(whole.nodata_holes, 1U);
  EXPECT_EQ(whole.outside_bbox, 0U);
  expect_error(ErrorCode::EmptyInput, {"g.asc", "box is 100", "0.5, 0.5, 6.5, 4.5"}, [&] {
    read({file}, {.bbox = Box2{100, 100, 101, 101}});
  });
  expect_error(ErrorCode::EmptyInput, {"g.asc"}, [&] { read({file}, {.bbox = Box2{2.1, 2.1, 3.4, 3.4}}); });
}

TEST_F(ReadRaster, NamesWhatHoldsNothing) {
  expect_error(ErrorCode::EmptyInput, {"n.asc", "4 cells hold no data"}, [&] {
    read({write_grid("n.asc", {"..", ".."})});
  });
  expect_error(ErrorCode::Usage, {"g.asc", "no attributes"}, [&] {
    read({write_grid("g.asc", {"11", "11"})}, {.where = "a = 1"});
  });
  expect_error(ErrorCode::MissingHeight, {"g.asc"}, [&] {
    read({write_grid("g.asc", {"11", "11"})}, {.z_field = "a"});
  });
  const std::string cut = write("cut.asc", "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2\n3");
  expect_error(ErrorCode::Unreadable, {"cut.asc"}, [&] { read({cut}); });
}

TEST_F(ReadRaster, TransformsCentresAndFindsTheWayBack) {
  const std::string file = write_grid("g.asc", {"1111", "11..", "1111"}, 500000, 4000000, 100);
  const ReadResult plain = read({file}, {.source_crs = "EPSG:32611"});
  const ReadResult degrees = read({file}, {.source_crs = "EPSG:32611", .target_crs = "EPSG:4326"});
  EXPECT_EQ(degrees.crs.authority, "EPSG:4326");
  const Point2 p = degrees.survey.points.xy[0];
  EXPECT_NEAR(p.x, -116.9994, 1e-3);
  EXPECT_NEAR(p.y, 36.146, 1e-2);
  // The invalid cell at column 3, row 1 touches the frame; its neighbours tell where it lies in degrees.
  const Point2 north = degrees.survey.points.xy[3];
  const Point2 south = degrees.survey.points.xy[9];
  const Point2 middle{(north.x + south.x) / 2, (north.y + south.y) / 2};
  EXPECT_TRUE(plain.nodata.outside({500349, 4000150}));
  EXPECT_TRUE(degrees.nodata.outside({middle.x - 1e-6, middle.y}));
  EXPECT_FALSE(degrees.nodata.outside({p.x + 1e-6, p.y - 1e-6}));
  EXPECT_FALSE(degrees.nodata.outside({0, 0}));
}

/// The rules of nodata_region.hpp, told again by flooding.
class SlowRegions {
 public:
  explicit SlowRegions(Rows rows) : rows_(std::move(rows)) {
    for (std::size_t r = 0; r < rows_.size(); ++r) {
      for (std::size_t c = 0; c < rows_[0].size(); ++c) {
        if (r == 0 || c == 0 || r + 1 == rows_.size() || c + 1 == rows_[0].size()) flood(c, r);
      }
    }
  }
  [[nodiscard]] bool outside(double x, double y) const {
    const auto width = static_cast<double>(rows_[0].size());
    const auto height = static_cast<double>(rows_.size());
    const double u = x - 0.5;
    const double v = height - y - 0.5;
    if (u < 0 || v < 0 || u > width - 1 || v > height - 1) return false;
    const auto c = static_cast<std::size_t>(std::min(std::floor(u), width - 2));
    const auto r = static_cast<std::size_t>(std::min(std::floor(v), height - 2));
    int invalid = 0;
    bool out = false;
    double distance = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      const std::size_t cc = c + i % 2;
      const std::size_t rr = r + i / 2;
      if (rows_[rr][cc] == '1') continue;
      ++invalid;
      out = out || rows_[rr][cc] == 'o';
      distance = std::abs(u - static_cast<double>(cc)) + std::abs(v - static_cast<double>(rr));
    }
    return out && !(invalid == 1 && distance >= 1);
  }
  [[nodiscard]] std::size_t count(char c) const {
    std::size_t total = 0;
    for (const std::string& row : rows_)
      total += static_cast<std::size_t>(std::count(row.begin(), row.end(), c));
    return total;
  }

 private:
  void flood(std::size_t c, std::size_t r) {
    if (r >= rows_.size() || c >= rows_[0].size() || rows_[r][c] != '.') return;
    rows_[r][c] = 'o';
    for (std::size_t dr = 0; dr < 3; ++dr) {
      for (std::size_t dc = 0; dc < 3; ++dc) flood(c + dc - 1, r + dr - 1);
    }
  }
  Rows rows_;
};

TEST_F(ReadRaster, AgreesWithFloodingOnRandomHoles) {
  test::Random random;
  SCOPED_TRACE(random.trace());
  for (int trial = 0; trial < 60; ++trial) {
    const auto width = random.integer<std::size_t>(2, 14);
    const auto height = random.integer<std::size_t>(2, 14);
    const int holes = random.integer(1, 9);
    Rows rows(height, std::string(width, '1'));
    for (std::string& row : rows) {
      for (char& c : row) c = random.integer(0, 9) < holes ? '.' : '1';
    }
    rows[0][0] = '1';
    const ReadResult result = read({write_grid("r.asc", rows)});
    const SlowRegions slow(rows);
    EXPECT_EQ(result.bridged_cells, slow.count('.'));
    for (int i = 0; i < 100; ++i) {
      const double x = random.real(-0.5, static_cast<double>(width) + 0.5);
      const double y = random.real(-0.5, static_cast<double>(height) + 0.5);
      ASSERT_EQ(result.nodata.outside({x, y}), slow.outside(x, y)) << x << ", " << y;
    }
  }
}

}  // namespace
}  // namespace thalweg
