// Tables of text: separators, headers, columns, errors that name the row, filters, blocks.
#include "read_fixture.hpp"

#include <gmock/gmock.h>

namespace thalweg {
namespace {

using testing::ElementsAre;

class ReadText : public ReadTest {
 protected:
  /// The one point (x, y, z) of a file with this content.
  std::vector<double> point_of(const std::string& content, const std::string& name = "p.csv",
                               const ReadOptions& options = {}) {
    const ReadResult result = read({write(name, content)}, options);
    EXPECT_EQ(result.survey.points.xy.size(), 1U) << content;
    if (result.survey.points.xy.empty()) return {};
    return {result.survey.points.xy[0].x, result.survey.points.xy[0].y, result.survey.points.z[0]};
  }
};

TEST_F(ReadText, TakesEverySeparatorWithAndWithoutHeader) {
  for (const std::string separator : {",", ";", "\t", " ", "    ", " \t ", " , "}) {
    const std::string header = "x" + separator + "y" + separator + "z\n";
    const std::string row = "1.5" + separator + "-2e1" + separator + "+30\n";
    EXPECT_THAT(point_of(row), ElementsAre(1.5, -20, 30)) << "separator '" << separator << "'";
    EXPECT_THAT(point_of(header + row), ElementsAre(1.5, -20, 30)) << "separator '" << separator << "'";
  }
}

TEST_F(ReadText, FindsColumnsByName) {
  EXPECT_THAT(point_of("id,z,y,x\n9,3,2,1\n"), ElementsAre(1, 2, 3));
  EXPECT_THAT(point_of("LAT;LON;Elevation\n2;1;3\n"), ElementsAre(1, 2, 3));
  EXPECT_THAT(point_of("Northing\tEasting\tHEIGHT\n2\t1\t3\n"), ElementsAre(1, 2, 3));
  EXPECT_THAT(point_of("\"latitude\",\"longitude\",\"elev\"\n\"2\",\"1\",\"3\"\n"), ElementsAre(1, 2, 3));
  EXPECT_THAT(point_of("name,x,y,z\n\"a, b\",1,2,3\n"), ElementsAre(1, 2, 3));
  EXPECT_THAT(point_of("long lat elev\n1 2 3\n"), ElementsAre(1, 2, 3));
  EXPECT_THAT(point_of("x y 2020\n1 2 3\n"), ElementsAre(1, 2, 3));
}

TEST_F(ReadText, TakesTheFirstThreeColumnsElse) {
  EXPECT_THAT(point_of("1,2,3,4,5\n"), ElementsAre(1, 2, 3));
  EXPECT_THAT(point_of("a,b,c\n1,2,3\n"), ElementsAre(1, 2, 3));
  const ReadResult result = read({write("n.csv", "x,y,level\n1,2,3\n")});
  EXPECT_TRUE(has_note(result, "level"));
  EXPECT_EQ(result.survey.points.z[0], 3);
  expect_error(ErrorCode::BadFormat, {"n.csv", "id, x, b"},
               [&] { read({write("n.csv", "id,x,b\n1,2,3\n")}); });
  expect_error(ErrorCode::MissingHeight, {"n.csv", "id, x, y, level", "--z-field"},
               [&] { read({write("n.csv", "id,x,y,level\n1,2,3,4\n")}); });
}

TEST_F(ReadText, TakesHeightsFromTheNamedColumn) {
  EXPECT_THAT(point_of("x,y,z,dtm\n1,2,3,4\n", "p.csv", {.z_field = "DTM"}), ElementsAre(1, 2, 4));
  EXPECT_THAT(point_of("1,2,3,4\n", "p.csv", {.z_field = "field_4"}), ElementsAre(1, 2, 4));
  expect_error(ErrorCode::MissingHeight, {"p.csv", "dsm"},
               [&] { read({write("p.csv", "x,y,z\n1,2,3\n")}, {.z_field = "dsm"}); });
}

TEST_F(ReadText, PassesOverCommentsBlankRowsAndMarks) {
  EXPECT_THAT(point_of("\xef\xbb\xbf# made by hand\r\n\r\nx,y,z\r\n  # no point\r\n1,2,3\r\n\r\n"),
              ElementsAre(1, 2, 3));
  EXPECT_THAT(point_of("\xef\xbb\xbf\"x\",\"y\",\"z\"\n1,2,3"), ElementsAre(1, 2, 3));
  EXPECT_THAT(point_of("//X Y Z\n1 2 3\n"), ElementsAre(1, 2, 3));
  EXPECT_THAT(point_of("# y x z\n2 1 3\n"), ElementsAre(1, 2, 3));
  EXPECT_THAT(point_of("# y x of the survey of 1999, z\n1 2 3\n"), ElementsAre(1, 2, 3));
}

TEST_F(ReadText, ReadsEveryDigit) {
  EXPECT_THAT(point_of("637148.03000000003,4882486.2380000001,-0.1\n"),
              ElementsAre(637148.03, 4882486.238, -0.1));
  EXPECT_THAT(point_of("123456789012345678,1E-3,.5\n"), ElementsAre(123456789012345678.0, 0.001, 0.5));
}

TEST_F(ReadText, NamesTheBrokenRow) {
  const auto fails = [&](ErrorCode code, const std::string& content, std::vector<std::string> texts) {
    texts.push_back("bad.csv row 3");
    expect_error(code, texts, [&] { read({write("bad.csv", "x,y,z\n1,2,3\n" + content + "\n")}); });
  };
  fails(ErrorCode::BadFormat, "1,abc,3", {"column 2 (y)", "\"abc\"", "put # before"});
  fails(ErrorCode::BadFormat, "1,2", {"column 3 (z)", "2 columns"});
  fails(ErrorCode::BadFormat, "1,2,3.0.1", {"column 3 (z)", "3.0.1"});
  fails(ErrorCode::BadFormat, "1,2m,3", {"column 2 (y)", "2m"});
  fails(ErrorCode::BadFormat, "x,y,z", {"column 1 (x)"});
  fails(ErrorCode::BadFormat, ",2,3", {"column 1 (x)"});
  fails(ErrorCode::MissingHeight, "1,2,", {"column 3 (z)", "empty"});
  fails(ErrorCode::BadCoordinate, "1,nan,3", {"column 2 (y)", "nan"});
  fails(ErrorCode::BadCoordinate, "1,2,-inf", {"column 3 (z)", "inf"});
  fails(ErrorCode::BadCoordinate, "1e999,2,3", {"column 1 (x)", "1e999"});
  fails(ErrorCode::BadCoordinate, "1e120,2,3", {"column 1 (x)"});
  for (const char* two_ways :
       {"x;y;z\n1;2.5;3\n1;2,5;3\n", "x;y;z\n1;2,5;3\n1;2.5;3\n", "1;2,5;3\n1;1.234,5;3\n"}) {
    expect_error(ErrorCode::BadFormat, {"row ", "with a point, or all with a comma"},
                 [&] { read({write("bad.csv", two_ways)}); });
  }
  expect_error(ErrorCode::BadFormat, {"row 1", "\"P1\""}, [&] { read({write("bad.csv", "P1,1,2,3\n")}); });
}

TEST_F(ReadText, DecimalsWithAComma) {
  const std::vector<Point2> xy = {{4, 2.5}, {-1.25, 7}};
  for (const char* text : {"z;y;x\n\n3,125;2,5;4\n-2;7;-1,25\n", "4;2,5;3,125\n-1,25;7;-2\n",
                           "\"x\"\t\"y\"\t\"z\"\n4\t\"2,5\"\t 3,125\r\n-1,25\t7\t-2\r\n"}) {
    const ReadResult result = read({write("comma.csv", text)});
    EXPECT_EQ(result.survey.points.xy, xy) << text;
    EXPECT_THAT(result.survey.points.z, testing::ElementsAre(3.125, -2)) << text;
    EXPECT_THAT(result.notes, testing::Contains(testing::HasSubstr("written with a comma"))) << text;
  }
  const std::string file = write("where.csv", "x;y;z;q\n1;2;3;0,5\n4;5;6;1,5\n");
  EXPECT_EQ(read({file}, {.where = "q > 1"}).survey.points.xy, (std::vector<Point2>{{4, 5}}));
}

TEST_F(ReadText, NamesWhatIsNoTable) {
  expect_error(ErrorCode::EmptyInput, {"e.csv"}, [&] { read({write("e.csv", "")}); });
  expect_error(ErrorCode::EmptyInput, {"e.csv"}, [&] { read({write("e.csv", "# only\n\n")}); });
  expect_error(ErrorCode::EmptyInput, {"e.csv"}, [&] { read({write("e.csv", "x,y,z\n")}); });
  expect_error(ErrorCode::BadFormat, {"e.csv", "one column"}, [&] { read({write("e.csv", "hello\n")}); });
  expect_error(ErrorCode::BadFormat, {"e.csv", "UTF-8"},
               [&] { read({write("e.csv", std::string("\xff\xfex\0,\0y\0", 8))}); });
  expect_error(ErrorCode::BadFormat, {"e.csv", "64 MiB"},
               [&] { read({write("e.csv", "1,2,3\n" + std::string((64U << 20U) + 1, '1'))}); });
  expect_error(ErrorCode::NotFound, {"absent.csv"}, [&] { read({path("absent.csv")}); });
  expect_error(ErrorCode::NotFound, {"absent.csv.gz"}, [&] { read({path("absent.csv.gz")}); });
  std::filesystem::create_directory(path("folder.csv"));
  expect_error(ErrorCode::Unreadable, {"folder.csv"}, [&] { read({path("folder.csv")}); });
}

TEST_F(ReadText, LetsHeightsBeOptional) {
  const ReadOptions optional{.heights = HeightRule::Optional};
  EXPECT_THAT(point_of("1,2\n", "p.csv", optional), ElementsAre(1, 2, 0));
  EXPECT_THAT(point_of("x,y,z\n1,2,\n", "p.csv", optional), ElementsAre(1, 2, 0));
  EXPECT_THAT(point_of("x,y,z\n1,2\n", "p.csv", optional), ElementsAre(1, 2, 0));
  EXPECT_THAT(point_of("id,x,y\n9,1,2\n", "p.csv", optional), ElementsAre(1, 2, 0));
  EXPECT_THAT(point_of("x,y,z\n1,2,3\n", "p.csv", optional), ElementsAre(1, 2, 3));
}

TEST_F(ReadText, FiltersByAttributes) {
  const std::string file =
      write("f.csv", "x,y,z,class,name\n1,1,1,2,a\n2,2,2,3,b\n# -\n3,3,3,,\"c\"\n4,4,4,2,\n");
  EXPECT_EQ(read({file}, {.where = "class = 2"}).survey.points.z, (std::vector<double>{1, 4}));
  EXPECT_EQ(read({file}, {.where = "name IN ('b', 'c')"}).survey.points.z, (std::vector<double>{2, 3}));
  EXPECT_EQ(read({file}, {.where = "class IS NULL AND z > 2"}).survey.points.z, (std::vector<double>{3}));
  EXPECT_EQ(read({file}, {.where = "class = 2"}).points_read, 2U);
  expect_error(ErrorCode::Usage, {"f.csv", "klass"}, [&] { read({file}, {.where = "klass = 2"}); });
  expect_error(ErrorCode::Usage, {"f.csv"}, [&] { read({file}, {.where = "class = = 2"}); });
  expect_error(ErrorCode::EmptyInput, {"f.csv", "class = 7"}, [&] { read({file}, {.where = "class = 7"}); });
  const std::string plain = write("g.csv", "5 5 5 2\n6 6 6 3\n");
  EXPECT_EQ(read({plain}, {.where = "field_4 = 3"}).survey.points.z, (std::vector<double>{6}));
}

TEST_F(ReadText, ReadsRowsAcrossBlocks) {
  std::string content = "x,y,z\n";
  constexpr int kRows = 200000;  // several blocks of 1 MiB, rows of changing length
  for (int i = 0; i < kRows; ++i) {
    content += std::to_string(i) + "," + std::to_string(i % 977) + "." +
               std::string(static_cast<std::size_t>(i % 13), '0') + "5," + std::to_string(-i) + "\n";
  }
  const ReadResult result = read({write("big.csv", content)});
  ASSERT_EQ(result.points_read, static_cast<std::size_t>(kRows));
  for (int i = 0; i < kRows; ++i) {
    const auto at = static_cast<std::size_t>(i);
    ASSERT_EQ(result.survey.points.xy[at].x, i);
    ASSERT_EQ(result.survey.points.z[at], -i);
  }
  expect_error(ErrorCode::BadFormat, {"big.csv row 200002"},
               [&] { read({write("big.csv", content + "1,2,x\n")}); });
}

TEST_F(ReadText, ReadsCompressedFiles) {
  const std::string content = "x,y,z\n1,2,3\n4,5,6\n";
  const std::string file = path("p.csv.gz");
  write_gzip(file, content);
  EXPECT_EQ(read({file}).survey.points.z, (std::vector<double>{3, 6}));
  EXPECT_EQ(read({"/vsigzip/" + file}).survey.points.z, (std::vector<double>{3, 6}));
  std::filesystem::resize_file(file, std::filesystem::file_size(file) - 12);
  expect_error(ErrorCode::Unreadable, {"p.csv.gz"}, [&] { read({file}); });
}

TEST_F(ReadText, KnowsRastersByTheirContent) {
  const std::string grid =
      "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\nNODATA_value -9\n1 2\n3 4\n";
  EXPECT_EQ(read({write("grid.asc", grid)}).survey.points.z, (std::vector<double>{1, 2, 3, 4}));
  EXPECT_EQ(read({write("grid.txt", grid)}).survey.points.z, (std::vector<double>{1, 2, 3, 4}));
  EXPECT_EQ(read({write("list.asc", "1 2 3\n4 5 6\n")}).survey.points.z, (std::vector<double>{3, 6}));
  EXPECT_EQ(read({write("list.xyz", "0 1 3\n1 1 6\n0 0 7\n1 0 8\n")}).survey.points.z,
            (std::vector<double>{3, 6, 7, 8}));
}

TEST_F(ReadText, FindsItsCrsBesideIt) {
  const std::string file = write("p.csv", "x,y,z\n400000,3800000,3\n");
  EXPECT_FALSE(read({file}).crs.known);
  write("p.prj", "+proj=utm +zone=11 +datum=WGS84 +units=m +no_defs\n");
  EXPECT_EQ(read({file}).crs.known, true);
  EXPECT_EQ(read({file}).crs.geographic, false);
  EXPECT_EQ(read({file}, {.source_crs = "EPSG:32612"}).crs.authority, "EPSG:32612");
  write("p.prj", "nonsense");
  expect_error(ErrorCode::BadCrs, {"p.prj"}, [&] { read({file}); });
}

TEST_F(ReadText, AsksAboutDegreesWithoutCrs) {
  const std::string file = write("p.csv", "lon,lat,z\n-117,35,3\n");
  EXPECT_TRUE(has_note(read({file}), "longitude and latitude"));
  EXPECT_FALSE(has_note(read({file}, {.assigned_crs = "EPSG:4326"}), "longitude and latitude"));
}

TEST_F(ReadText, StopsWhenAsked) {
  std::string content;
  for (int i = 0; i < 100000; ++i) content += "1 2 3\n";
  const std::string file = write("p.xyz", content);
  const std::vector<SourceSpec> specs{{file, ""}};
  Progress progress;
  progress.cancel();
  expect_error(ErrorCode::Cancelled, {}, [&] { read_survey(specs, {}, {}, progress); });
}

}  // namespace
}  // namespace thalweg
