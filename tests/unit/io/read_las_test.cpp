// LAS files made byte by byte from the specification.
#include "read_fixture.hpp"

#include <thalweg/io/format_info.hpp>

#include <gmock/gmock.h>

#include <bit>
#include <cstdint>

namespace thalweg {
namespace {

using testing::ElementsAre;

struct LasPoint {
  std::int32_t x, y, z;
  unsigned return_number = 1, returns = 1, point_class = 2;
  bool withheld = false;
};

class LasFile {
 public:
  LasFile(unsigned minor, unsigned format, std::size_t record)
      : minor_(minor), format_(format), record_(record) {}

  LasFile& crs_record(std::uint16_t id, const std::string& body, std::string user = "LASF_Projection") {
    ++records_;
    put(vlrs_, 0, 2);
    user.resize(16);
    vlrs_ += user;
    put(vlrs_, id, 2);
    put(vlrs_, body.size(), 2);
    vlrs_ += std::string(32, '\0') + body;
    return *this;
  }

  [[nodiscard]] std::string bytes(const std::vector<LasPoint>& points, double scale, double offset_x) const {
    const std::size_t header = minor_ == 4 ? 375 : minor_ == 3 ? 235 : 227;
    std::string text = "LASF" + std::string(20, '\0');
    put(text, 1, 1);
    put(text, minor_, 1);
    text.resize(94);
    put(text, header, 2);
    put(text, header + vlrs_.size(), 4);
    put(text, records_, 4);
    put(text, format_, 1);
    put(text, record_, 2);
    put(text, minor_ == 4 ? 0 : points.size(), 4);
    text.resize(131);
    for (int i = 0; i < 3; ++i) put_double(text, scale);
    for (const double offset : {offset_x, 0.0, 0.0}) put_double(text, offset);
    text.resize(227);
    if (minor_ == 4) {
      text.resize(247);
      put(text, points.size(), 8);
    }
    text.resize(header);
    text += vlrs_;
    for (const LasPoint& p : points) text += record(p);
    return text;
  }

  static void put(std::string& text, std::uint64_t value, std::size_t width) {
    for (std::size_t i = 0; i < width; ++i) text += static_cast<char>(value >> (8 * i) & 0xffU);
  }

 private:
  static void put_double(std::string& text, double value) {
    put(text, std::bit_cast<std::uint64_t>(value), 8);
  }

  [[nodiscard]] std::string record(const LasPoint& p) const {
    std::string text;
    for (const std::int32_t value : {p.x, p.y, p.z}) put(text, static_cast<std::uint32_t>(value), 4);
    put(text, 0, 2);
    if (format_ >= 6) {
      put(text, p.return_number | p.returns << 4U, 1);
      put(text, p.withheld ? 4 : 0, 1);
      put(text, p.point_class, 1);
    } else {
      put(text, p.return_number | p.returns << 3U, 1);
      put(text, p.point_class | (p.withheld ? 0x80U : 0U), 1);
    }
    text.resize(record_);
    return text;
  }

  unsigned minor_, format_;
  std::size_t record_;
  std::size_t records_ = 0;
  std::string vlrs_;
};

std::string geo_keys(const std::vector<std::array<std::uint16_t, 2>>& keys) {
  std::string body;
  for (const std::uint64_t word : {std::size_t{1}, std::size_t{1}, std::size_t{0}, keys.size()})
    LasFile::put(body, word, 2);
  for (const auto& [id, value] : keys) {
    for (const std::uint64_t word :
         {std::uint64_t{id}, std::uint64_t{0}, std::uint64_t{1}, std::uint64_t{value}})
      LasFile::put(body, word, 2);
  }
  return body;
}

class ReadLas : public ReadTest {};

const std::vector<LasPoint> kPoints = {
    {-1, 2, 3, 1, 2, 2}, {1000, 7, 100010, 2, 2, 9}, {5, 6, 7, 1, 1, 2, true}};

TEST_F(ReadLas, CoordinatesAreTheDecimalsThatWereMeasured) {
  const std::string file = write("a.las", LasFile(2, 1, 28).bytes(kPoints, 0.001, 500000.5));
  const ReadResult result = read({file});
  EXPECT_THAT(result.survey.points.xy, ElementsAre(Point2{500000.499, 0.002}, Point2{500001.5, 0.007}));
  EXPECT_THAT(result.survey.points.z, ElementsAre(0.003, 100.01));
  EXPECT_FALSE(result.crs.known);
  EXPECT_THAT(result.notes, testing::Contains(testing::HasSubstr("1 points marked as withheld")));
}

TEST_F(ReadLas, OtherScalesAreMultiplied) {
  const std::string file = write("a.las", LasFile(3, 0, 20).bytes({{3, 1, 1}}, 0.3, 0.1));
  EXPECT_EQ(read({file}).survey.points.xy[0].x, 3 * 0.3 + 0.1);
}

TEST_F(ReadLas, ClassesAndReturns) {
  for (const auto& [minor, format, record] :
       {std::array<unsigned, 3>{2, 3, 34}, std::array<unsigned, 3>{4, 6, 30}}) {
    const std::string file = write("a.las", LasFile(minor, format, record).bytes(kPoints, 0.01, 0));
    EXPECT_EQ(read({file}).survey.points.z.size(), 2U);
    EXPECT_THAT(read({file}, {.classes = {9, 13}}).survey.points.z, ElementsAre(1000.1));
    EXPECT_THAT(read({file}, {.returns = LasReturns::First}).survey.points.z, ElementsAre(0.03));
    EXPECT_THAT(read({file}, {.returns = LasReturns::Last}).survey.points.z, ElementsAre(1000.1));
  }
  expect_error(ErrorCode::Usage, {"--classes"}, [&] { read({write("p.csv", "0,0,1\n")}, {.classes = {2}}); });
}

TEST_F(ReadLas, CrsOfKeysAndOfWkt) {
  const std::string keys = geo_keys({{1024, 1}, {3072, 32632}, {4096, 5703}});
  ReadResult result =
      read({write("a.las", LasFile(2, 0, 20).crs_record(34735, keys).bytes(kPoints, 0.01, 0))});
  EXPECT_EQ(result.crs.geographic, false);
  EXPECT_THAT(result.crs.wkt, testing::HasSubstr("32632"));
  EXPECT_THAT(result.crs.wkt, testing::HasSubstr("5703"));
  EXPECT_TRUE(result.crs.vertical_unit_told);
  const std::string wkt =
      "PROJCS[\"WGS 84 / UTM zone 11N\",GEOGCS[\"WGS 84\",DATUM[\"WGS_1984\",SPHEROID[\"WGS "
      "84\",6378137,298.257223563]],"
      "PRIMEM[\"Greenwich\",0],UNIT[\"degree\",0.0174532925199433]],PROJECTION[\"Transverse_Mercator\"],"
      "PARAMETER[\"latitude_of_origin\",0],PARAMETER[\"central_meridian\",-117],PARAMETER[\"scale_factor\",0."
      "9996],"
      "PARAMETER[\"false_easting\",500000],PARAMETER[\"false_northing\",0],UNIT[\"metre\",1],AUTHORITY["
      "\"EPSG\",\"32611\"]]";
  result = read({write("b.las", LasFile(4, 7, 36).crs_record(2112, wkt).bytes(kPoints, 0.01, 0))});
  EXPECT_EQ(result.crs.authority, "EPSG:32611");
  const std::string feet = geo_keys({{3072, 32632}, {4099, 9002}});
  result = read({write("c.las", LasFile(2, 0, 20).crs_record(34735, feet).bytes(kPoints, 0.01, 0))});
  EXPECT_EQ(result.crs.vertical_metres_per_unit, 0.3048);
}

// A transverse Mercator in feet, of parameters: false easting 1000 ft, central meridian 9, scale 0.9999.
TEST_F(ReadLas, CrsOfParameters) {
  constexpr std::uint16_t kDoubles = 34736, kUser = 32767;
  std::string keys, doubles;
  for (const std::uint16_t word : std::vector<std::uint16_t>{
           1,    1,        0, 10,                               // version, number of keys
           1024, 0,        1, 1,     2048, 0,        1, 4258,   // projected, of ETRS89
           3072, 0,        1, kUser, 3074, 0,        1, kUser,  // no code
           3075, 0,        1, 1,     3076, 0,        1, 9002,   // transverse Mercator, international feet
           3080, kDoubles, 1, 0,     3081, kDoubles, 1, 1,      // its origin
           3082, kDoubles, 1, 2,     3092, kDoubles, 1, 3}) {
    LasFile::put(keys, word, 2);
  }
  for (const double value : {9.0, 0.0, 1000.0, 0.9999})
    LasFile::put(doubles, std::bit_cast<std::uint64_t>(value), 8);
  LasFile file(2, 0, 20);
  file.crs_record(34735, keys).crs_record(kDoubles, doubles);
  ReadResult result = read({write("a.las", file.bytes(kPoints, 0.01, 0))});
  EXPECT_EQ(result.crs.horizontal_metres_per_unit, 0.3048);
  EXPECT_THAT(result.crs.wkt, testing::HasSubstr("0.9999"));
  EXPECT_THAT(result.crs.wkt, testing::HasSubstr("304.8"));
  EXPECT_THAT(result.notes, testing::Contains(testing::HasSubstr("no code")));

  // WKT goes before, libLAS's record too; and keys that make no sense are said to.
  file.crs_record(2112, describe_crs("EPSG:2994").wkt, "liblas");
  result = read({write("b.las", file.bytes(kPoints, 0.01, 0))});
  EXPECT_EQ(result.crs.authority, "EPSG:2994");
  EXPECT_THAT(result.notes, testing::Not(testing::Contains(testing::HasSubstr("own making"))));
  const std::string alone = geo_keys({{1024, 1}, {3072, kUser}});
  result = read({write("c.las", LasFile(2, 0, 20).crs_record(34735, alone).bytes(kPoints, 0.01, 0))});
  EXPECT_FALSE(result.crs.known);
  EXPECT_THAT(result.notes, testing::Contains(testing::HasSubstr("--s-crs")));
}

TEST_F(ReadLas, RefusesWithTheRemedy) {
  const std::string good = LasFile(2, 0, 20).bytes(kPoints, 0.01, 0);
  expect_error(ErrorCode::NotFound, {"none.las"}, [&] { read({path("none.las")}); });
  expect_error(ErrorCode::BadFormat, {"b.las"}, [&] { read({write("b.las", "LASF")}); });
  expect_error(ErrorCode::BadFormat, {"c.las", "after point 2 of 3"},
               [&] { read({write("c.las", good.substr(0, good.size() - 1))}); });
  for (const unsigned flag : {64U, 128U}) {  // no stream that LASzip wrote stands there
    expect_error(reads_laz() ? ErrorCode::BadFormat : ErrorCode::Unsupported,
                 {"d.laz", reads_laz() ? "PDAL" : "laszip"},
                 [&] { read({write("d.laz", LasFile(4, flag + 6, 30).bytes(kPoints, 0.01, 0))}); });
  }
  expect_error(ErrorCode::BadFormat, {"e.las", "scale"},
               [&] { read({write("e.las", LasFile(2, 0, 20).bytes(kPoints, 0, 0))}); });
  for (std::size_t size = 0; size < good.size(); size += 3) {
    try {
      read({write("f.las", good.substr(0, size))});
    } catch (const Error&) {
    }
  }
}

}  // namespace
}  // namespace thalweg
