// Broken and lying TIN files: each is refused with the place of the fault, quickly and without taking memory.
#include "write_scene.hpp"

#include <cstring>

namespace thalweg {
namespace {

using test::expect_error;
using test::make_grid_tin;
using test::read_file;
using test::TempFolder;
using test::write_file;
using test::write_text;

const std::string kPlyHead =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 1\nproperty list uchar int vertex_indices\n";
const std::string kPlyVertices = "0 0 1\n1 0 2\n0 1 3\n";

struct BrokenFile {
  const char* name;
  std::string extension;
  std::string text;
  ErrorCode code;
  std::vector<std::string> words;
};

void PrintTo(const BrokenFile& file, std::ostream* out) {
  *out << file.name;
}

class BrokenFiles : public testing::TestWithParam<BrokenFile> {};

TEST_P(BrokenFiles, AreRefusedWithThePlaceOfTheFault) {
  const TempFolder folder;
  const std::string path = folder.file("a" + GetParam().extension);
  write_text(path, GetParam().text);
  std::vector<std::string> words = GetParam().words;
  words.push_back(path);
  expect_error(GetParam().code, words, [&] { read_file(path); });
}

using enum ErrorCode;

INSTANTIATE_TEST_SUITE_P(
    Ply, BrokenFiles,
    testing::Values(
        BrokenFile{"NoEnd", ".ply", kPlyHead, BadFormat, {"line 9", "end_header"}},
        BrokenFile{
            "NoFormat", ".ply", "ply\nelement vertex 1\nend_header\n", BadFormat, {"line 3", "format"}},
        BrokenFile{
            "UnknownFormat", ".ply", "ply\nformat utf8 1.0\nend_header\n", BadFormat, {"line 2", "utf8"}},
        BrokenFile{
            "UnknownLine", ".ply", "ply\nformat ascii 1.0\nnonsense\nend_header\n", BadFormat, {"line 3"}},
        BrokenFile{"UnknownType",
                   ".ply",
                   "ply\nformat ascii 1.0\nelement vertex 1\nproperty real x\nend_header\n",
                   BadFormat,
                   {"line 4", "real"}},
        BrokenFile{
            "FloatCount",
            ".ply",
            "ply\nformat ascii 1.0\nelement face 1\nproperty list float int vertex_indices\nend_header\n",
            BadFormat,
            {"line 4"}},
        BrokenFile{"PropertyFirst",
                   ".ply",
                   "ply\nformat ascii 1.0\nproperty int x\nend_header\n",
                   BadFormat,
                   {"line 3"}},
        BrokenFile{
            "Twice", ".ply", kPlyHead + "element face 1\nend_header\n", BadFormat, {"line 9", "twice"}},
        BrokenFile{"NegativeCount",
                   ".ply",
                   "ply\nformat ascii 1.0\nelement vertex -1\nend_header\n",
                   BadFormat,
                   {"line 3"}},
        BrokenFile{"HugeCount",
                   ".ply",
                   "ply\nformat ascii 1.0\nelement vertex 99999999999999999999\nend_header\n",
                   BadFormat,
                   {"line 3"}},
        BrokenFile{"LyingCount",
                   ".ply",
                   "ply\nformat binary_little_endian 1.0\nelement vertex 4000000000\nproperty double x\n"
                   "property double y\nproperty double z\nend_header\n123456",
                   BadFormat,
                   {"byte", "promises 4000000000"}},
        BrokenFile{"LyingCountOfNothing",
                   ".ply",
                   "ply\nformat binary_little_endian 1.0\nelement junk 4000000000\nend_header\n",
                   BadFormat,
                   {"junk"}},
        BrokenFile{
            "LyingList",
            ".ply",
            "ply\nformat binary_little_endian 1.0\nelement junk 1\nproperty list uint uchar a\nend_header\n"
            "\xff\xff\xff\x7f",
            BadFormat,
            {"byte", "impossible length"}},
        BrokenFile{"NegativeList",
                   ".ply",
                   "ply\nformat ascii 1.0\nelement junk 1\nproperty list int int a\nend_header\n-3 1 2\n",
                   BadFormat,
                   {"line 6"}},
        BrokenFile{
            "CutOff", ".ply", kPlyHead + "end_header\n0 0 1\n1 0 2\n0 1 3", BadFormat, {"line", "face"}},
        BrokenFile{"CutOffInRecord",
                   ".ply",
                   kPlyHead + "end_header\n" + kPlyVertices + "3 0 1",
                   BadFormat,
                   {"line 13", "ends"}},
        BrokenFile{
            "NoZ",
            ".ply",
            "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nend_header\n0 0\n",
            BadFormat,
            {"'z'"}},
        BrokenFile{"Word",
                   ".ply",
                   kPlyHead + "end_header\n0 0 1\n1 zero 2\n0 1 3\n3 0 1 2\n",
                   BadFormat,
                   {"line 11", "zero"}},
        BrokenFile{"NotFinite",
                   ".ply",
                   kPlyHead + "end_header\n0 0 1\n1 0 nan\n0 1 3\n3 0 1 2\n",
                   BadCoordinate,
                   {"line 11", "vertex 1"}},
        BrokenFile{"Quads",
                   ".ply",
                   kPlyHead + "end_header\n" + kPlyVertices + "4 0 1 2 0\n",
                   WrongGeometry,
                   {"line 13", "face 0", "4 corners"}},
        BrokenFile{"OutOfRange",
                   ".ply",
                   kPlyHead + "end_header\n" + kPlyVertices + "3 0 1 3\n",
                   BadFormat,
                   {"face 0", "vertex 3", "only 3"}},
        BrokenFile{"NegativeIndex",
                   ".ply",
                   kPlyHead + "end_header\n" + kPlyVertices + "3 0 1 -1\n",
                   BadFormat,
                   {"face 0"}},
        BrokenFile{"BadKind",
                   ".ply",
                   kPlyHead +
                       "element edge 1\nproperty int vertex1\nproperty int vertex2\nproperty int "
                       "kind\nend_header\n" +
                       kPlyVertices + "3 0 1 2\n0 1 64\n",
                   BadFormat,
                   {"kind", "64"}},
        BrokenFile{"BadOrder",
                   ".ply",
                   kPlyHead + "property int order\nend_header\n" + kPlyVertices + "3 0 1 2 -1\n",
                   BadFormat,
                   {"order"}},
        BrokenFile{
            "NoTriangles",
            ".ply",
            "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
            "end_header\n" +
                kPlyVertices,
            EmptyInput,
            {"no triangles"}}),
    [](const auto& param) { return std::string(param.param.name); });

INSTANTIATE_TEST_SUITE_P(
    Text2dm, BrokenFiles,
    testing::Values(
        BrokenFile{"Quad", ".2dm", "MESH2D\nE4Q 1 1 2 3 4 1\n", WrongGeometry, {"line 2", "E4Q"}},
        BrokenFile{"Quadratic", ".2dm", "MESH2D\nE6T 1 1 2 3 4 5 6 1\n", WrongGeometry, {"line 2"}},
        BrokenFile{"Descending", ".2dm", "MESH2D\nND 2 0 0 0\nND 1 1 0 0\n", BadFormat, {"line 3", "ascend"}},
        BrokenFile{"Repeated", ".2dm", "MESH2D\nND 1 0 0 0\nND 1 1 0 0\n", BadFormat, {"line 3"}},
        BrokenFile{"ZeroId", ".2dm", "MESH2D\nND 0 0 0 0\n", BadFormat, {"line 2", "positive"}},
        BrokenFile{"HugeId", ".2dm", "MESH2D\nND 99999999999 0 0 0\n", BadFormat, {"line 2"}},
        BrokenFile{"Short", ".2dm", "MESH2D\nND 1 0 0\n", BadFormat, {"line 2", "ends before z"}},
        BrokenFile{"Word", ".2dm", "MESH2D\nND 1 0 zero 0\n", BadFormat, {"line 2", "zero"}},
        BrokenFile{"Infinite", ".2dm", "MESH2D\nND 1 0 1e999 0\n", BadCoordinate, {"line 2", "y is"}},
        BrokenFile{"MissingNode",
                   ".2dm",
                   "MESH2D\nE3T 1 1 2 9 1\nND 1 0 0 0\nND 2 1 0 0\nND 3 0 1 0\n",
                   BadFormat,
                   {"triangle number 1", "node 9"}},
        BrokenFile{"OpenString", ".2dm", "MESH2D\nNS 1 2\nND 1 0 0 0\n", BadFormat, {"line 3", "no end"}},
        BrokenFile{"OpenStringAtEnd", ".2dm", "MESH2D\nND 1 0 0 0\nNS 1 2\n", BadFormat, {"no end"}},
        BrokenFile{"LeastId", ".2dm", "MESH2D\nNS 1 -9223372036854775808 1 valley\n", BadFormat, {"line 2"}},
        BrokenFile{"Empty", ".2dm", "MESH2D\n", EmptyInput, {"no vertices"}}),
    [](const auto& param) { return std::string(param.param.name); });

INSTANTIATE_TEST_SUITE_P(
    Obj, BrokenFiles,
    testing::Values(BrokenFile{"Quad",
                               ".obj",
                               "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n",
                               WrongGeometry,
                               {"line 5", "4 corners"}},
                    BrokenFile{"Pair", ".obj", "v 0 0 0\nf 1 1\n", WrongGeometry, {"line 2"}},
                    BrokenFile{"Zero", ".obj", "v 0 0 0\nf 0 1 1\n", BadFormat, {"line 2", "'0'"}},
                    BrokenFile{"TooFarBack", ".obj", "v 0 0 0\nf -2 1 1\n", BadFormat, {"line 2", "'-2'"}},
                    BrokenFile{"OutOfRange",
                               ".obj",
                               "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n",
                               BadFormat,
                               {"face number 1", "vertex 4"}},
                    BrokenFile{
                        "Huge", ".obj", "v 0 0 0\nf 1 2 99999999999999999999\n", BadFormat, {"line 2"}},
                    BrokenFile{"NoHeight", ".obj", "v 0 0\n", BadFormat, {"line 1", "z"}},
                    BrokenFile{"OtherText", ".obj", "x,y,z\n1,2,3\n", BadFormat, {"line 1", "x,y,z"}},
                    BrokenFile{"Empty", ".obj", "", EmptyInput, {"no vertices"}}),
    [](const auto& param) { return std::string(param.param.name); });

INSTANTIATE_TEST_SUITE_P(Other, BrokenFiles,
                         testing::Values(BrokenFile{"Unknown", ".tin", "hello", Unsupported, {"PLY", "GPKG"}},
                                         BrokenFile{"NoDatabase",
                                                    ".gpkg",
                                                    std::string("SQLite format 3\0garbage", 24),
                                                    BadFormat,
                                                    {"GeoPackage"}}),
                         [](const auto& param) { return std::string(param.param.name); });

TEST(BrokenTinFiles, MissingFileAndFolder) {
  const TempFolder folder;
  expect_error(ErrorCode::NotFound, {"none.ply"}, [&] { read_file(folder.file("none.ply")); });
  expect_error(ErrorCode::Unreadable, {"folder"}, [&] { read_file(folder.file("")); });
}

// Every prefix of a good file, and every file with one byte changed, is read or refused, and nothing else.
class DamagedFiles : public testing::TestWithParam<const char*> {};

INSTANTIATE_TEST_SUITE_P(AllFormats, DamagedFiles,
                         testing::Values(".ply", ".2dm", ".obj", ".off", ".stl", ".xml"),
                         [](const auto& param) { return std::string(param.param).substr(1); });

TEST_P(DamagedFiles, AreReadOrRefused) {
  const TempFolder folder;
  const std::string path = folder.file(std::string("a") + GetParam());
  const Tin tin = make_grid_tin(2, 2);
  write_file(path, {.tin = tin});
  const std::string good = test::read_text(path);
  const auto try_text = [&](const std::string& text) {
    std::filesystem::remove(path);  // a file that is truncated and rewritten is flushed to the disk each time
    write_text(path, text);
    try {
      read_file(path);
    } catch (const Error&) {
    }
  };
  const std::size_t step = 1 + good.size() / 500;  // every byte of a short file, some of a long one
  for (std::size_t size = 0; size < good.size(); size += step) try_text(good.substr(0, size));
  for (std::size_t i = 0; i < good.size(); i += step) {
    for (const char value : {'\0', '\xff', '9', '-', '\n'}) {
      std::string text = good;
      text[i] = value;
      try_text(text);
    }
  }
}

TEST(ReadTin, NetcdfCutAnywhereIsRefused) {
  const TempFolder folder;
  const std::string path = folder.file("a.nc");
  const Tin tin = make_grid_tin(3, 3);
  write_file(path, {.tin = tin});
  const std::string good = test::read_text(path);
  constexpr std::size_t kPadding = 4;  // after the last value
  for (std::size_t cut = kPadding; cut < good.size(); cut += 1 + cut / 20) {
    std::filesystem::remove(path);
    write_text(path, good.substr(0, good.size() - cut));
    EXPECT_THROW(read_file(path), Error) << cut << " of " << good.size() << " bytes are missing";
  }
  write_text(path, good.substr(0, good.size() - 2 * kPadding));
  expect_error(BadFormat, {path, "cut off"}, [&] { read_file(path); });
}

TEST(ReadTin, PlyOfOthers) {
  const TempFolder folder;
  const std::string head =
      "obj_info made elsewhere\r\ncomment crs:EPSG:2056\r\nelement camera 1\r\nproperty list uchar float "
      "view\r\n"
      "property short mode\r\nelement vertex 3\r\nproperty uchar red\r\nproperty float x\r\nproperty float "
      "y\r\n"
      "property double z\r\nelement face 1\r\nproperty list uint8 uint32 vertex_index\r\n"
      "property list uchar float uv\r\nend_header\r\n";
  write_text(folder.file("ascii.ply"),
             "ply\r\nformat ascii 1.0\r\n" + head +
                 "2 0.5 0.5 7\r\n255 0 0 1\r\n255 1 0 +2\r\n255 0 1 3e0\r\n3 0 1 2 2 0 0\r\n");
  std::string binary = "ply\r\nformat binary_big_endian 1.0\r\n" + head;
  const auto put = [&](auto value) {
    char raw[sizeof(value)];
    std::memcpy(raw, &value, sizeof(value));
    for (std::size_t i = sizeof(value); i > 0; --i)
      binary += raw[i - 1];  // the tests run on little-endian machines
  };
  put(std::uint8_t{2}), put(0.5F), put(0.5F), put(std::int16_t{7});
  for (const auto& [x, y, z] :
       {std::tuple(0.F, 0.F, 1.), std::tuple(1.F, 0.F, 2.), std::tuple(0.F, 1.F, 3.)}) {
    put(std::uint8_t{255}), put(x), put(y), put(z);
  }
  put(std::uint8_t{3}), put(0U), put(1U), put(2U), put(std::uint8_t{2}), put(0.F), put(0.F);
  write_text(folder.file("binary.ply"), binary);
  for (const char* name : {"ascii.ply", "binary.ply"}) {
    const TinFile file = read_file(folder.file(name));
    EXPECT_EQ(file.crs, "EPSG:2056") << name;
    EXPECT_EQ(file.points, (std::vector<Point2>{{0, 0}, {1, 0}, {0, 1}})) << name;
    EXPECT_EQ(file.heights, (std::vector<double>{1, 2, 3})) << name;
    ASSERT_EQ(file.triangles.size(), 1U) << name;
    EXPECT_EQ(file.triangles[0][2], VertexId{2U}) << name;
  }
}

TEST(ReadTin, TextMeshesOfOthers) {
  const TempFolder folder;
  write_text(
      folder.file("a.2dm"),
      "MESH2D\nMESHNAME \"x\"\nND 10 0 0 1\r\nND  20\t1 0 2\nND 25 0 1 3\nE3T 7 10 20 25\nE2L 8 10 20 1\n"
      "NS 10 20 -25 4 inflow\nNS 10\nNS -20 5 valley\nBEGPARAMDEF\n");
  TinFile file = read_file(folder.file("a.2dm"));
  EXPECT_EQ(file.points.size(), 3U);
  ASSERT_EQ(file.constraints.size(), 3U);
  EXPECT_EQ(file.constraints[0].kind, EdgeKind::Valley);
  EXPECT_EQ(file.constraints[0].b, VertexId{1U});
  EXPECT_EQ(file.constraints[1].kind, EdgeKind::Breakline) << "what else it means is not known";
  EXPECT_EQ(file.constraints[2].kind, EdgeKind::Breakline);

  write_text(
      folder.file("a.OBJ"),
      "# made elsewhere\nmtllib a.mtl\no thing\nv 0 0 1 0.5 0.5 0.5\nv 1 0 2\nv 0 1 3\nvn 0 0 1\n\nusemtl m\n"
      "s off\nf 1/1/1 2//1 -1\nl 1 2\ng ridge\nl -3 -2 -1");
  file = read_file(folder.file("a.OBJ"));
  EXPECT_EQ(file.points.size(), 3U);
  EXPECT_EQ(file.triangles[0][2], VertexId{2U});
  ASSERT_EQ(file.constraints.size(), 3U);
  EXPECT_EQ(file.constraints[1].kind, EdgeKind::Ridge);
  EXPECT_EQ(file.constraints[2].kind, EdgeKind::Breakline);
}

}  // namespace
}  // namespace thalweg
