// Files of arbitrary content. What comes out of them is used: a mesh is optimised again and checked.
#include "fuzz/byte_reader.hpp"
#include "fuzz/laws.hpp"
#include "fuzz/scratch.hpp"
#include "fuzz/target.hpp"
#include "fuzz/target_list.hpp"

#include <thalweg/io/read_tin.hpp>
#include <thalweg/pipeline/build.hpp>
#include <thalweg/pipeline/verify_tin.hpp>

#include <array>
#include <cmath>
#include <string>

namespace thalweg::fuzz {

namespace {

/// `verify` and the optimiser take their time on larger ones.
constexpr std::size_t kMostTriangles = 300;

void run_mesh(std::string_view bytes) {
  const std::string path = scratch_path("input.mesh");
  write_file(path, bytes);
  Progress progress;
  TinFile file;
  if (error_of([&] { file = read_tin(path, progress); }) || file.triangles.size() > kMostTriangles) return;
  OptimizeConfig config;
  config.input = path;
  BuiltTin built;
  if (error_of([&] { built = optimized_tin(config, progress); })) return;
  check_built(built, config.labelling.definition);
}

std::vector<std::string> seed_meshes() {
  return tiny_tin().meshes;
}

struct PointsFile {
  const char* extension;
  ReadOptions options;
};

std::vector<PointsFile> points_files() {
  ReadOptions any, named, box, dms, utm, mgrs;
  any.heights = HeightRule::Optional;
  named.z_field = "height";
  box.bbox = Box2{0, 0, 10, 10};
  dms.coords = PositionForm::Dms;
  utm.coords = PositionForm::Utm;
  mgrs.coords = PositionForm::Mgrs;
  return {{".csv", {}},  {".csv", any},  {".txt", named}, {".xyz", box}, {".csv", dms},
          {".csv", utm}, {".csv", mgrs}, {".las", {}},    {".asc", {}},  {".geojson", named},
          {".tsv", any}, {".ply", {}},   {".dat", dms},   {".las", box}};
}

void run_points(std::string_view input) {
  static const std::vector<PointsFile> files = points_files();
  ByteReader bytes(input);
  const PointsFile& file = files[bytes.pick(files.size())];
  const std::string path = scratch_path(std::string("points") + file.extension);
  write_file(path, bytes.rest());
  ReadResult read;
  Progress progress;
  const std::array points{SourceSpec{path, ""}};
  if (error_of([&] { read = read_survey(points, {}, file.options, progress); })) return;
  const SurveyPoints& got = read.survey.points;
  if (got.xy.empty() || got.xy.size() != got.z.size()) throw Finding("no points, and no error");
  for (std::size_t i = 0; i < got.xy.size(); ++i) {
    if (!std::isfinite(got.xy[i].x + got.xy[i].y + got.z[i])) throw Finding("a coordinate is not finite");
  }
}

std::string with_index(std::size_t index, std::string_view bytes) {
  return std::string(1, static_cast<char>(index)) + std::string(bytes);
}

std::string seed_las() {
  constexpr std::size_t kHeader = 227, kRecord = 20;
  std::string file(kHeader + 3 * kRecord, '\0');
  const auto put = [&file](std::size_t at, auto value) {
    std::memcpy(file.data() + at, &value, sizeof value);
  };
  file.replace(0, 4, "LASF");
  file[24] = 1;
  file[25] = 2;
  put(94, std::uint16_t{kHeader});
  put(96, std::uint32_t{kHeader});
  put(105, std::uint16_t{kRecord});
  put(107, std::uint32_t{3});
  for (std::size_t axis = 0; axis < 3; ++axis) put(131 + 8 * axis, 0.01);
  for (std::int32_t i = 0; i < 9; ++i) put(kHeader + kRecord * (i / 3) + 4 * (i % 3), i * i * 100);
  return file;
}

std::vector<std::string> seed_points() {
  const std::string rows = "# comment\nx,y,z\n1,2,3\n4.5,6e0,-7\r\n\n8,9,10\n";
  return {
      with_index(0, rows),
      with_index(1, "a;b\n1;2\n3;4\n5;nan\n"),
      with_index(2, "x y height\n1 2 3\n4 5 6\n7 8\n"),
      with_index(3, "1\t2\t3\n4\t5\t1e300\n"),
      with_index(4, "x,y,z\n11d30'15\"E,47:15:00N,500\n-11.5042,47 15 0,7\n"),
      with_index(5, "utm,z\n32N 676000 5148000,4\n32N 676010 5148020,5\n"),
      with_index(5, "zone,x,y,z\n32N,676000,5148000,4\n"),
      with_index(6, "mgrs,z\n32TPT7612345678,9\n32TPT 76123 45679,9\n"),
      with_index(7, seed_las()),
      with_index(8, "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\nNODATA_value -9\n1 2\n3 -9\n"),
      with_index(9, R"({"type":"FeatureCollection","features":[{"type":"Feature","properties":{"height":3},)"
                    R"("geometry":{"type":"MultiPoint","coordinates":[[1,2,3],[4,5,6]]}}]})"),
      with_index(10, "x\ty\n1\t2\n3\t4\n"),
      with_index(11, tiny_tin().meshes.front())};
}

void run_lines(std::string_view input) {
  constexpr std::array kKinds{EdgeKind::Breakline, EdgeKind::Ridge, EdgeKind::Valley,
                              EdgeKind::Boundary,  EdgeKind::Hole,  EdgeKind::Lake};
  ByteReader bytes(input);
  BuildConfig config;
  const EdgeKind kind = kKinds[bytes.pick(kKinds.size())];
  const bool json = bytes.flag();
  if (bytes.flag()) config.read.line_z_field = "z";
  if (bytes.flag()) config.read.kind_field = "kind";
  const std::string path = scratch_path(json ? "lines.geojson" : "lines.csv");
  write_file(path, bytes.rest());
  config.lines = {{{path, ""}, kind}};
  config.read.assigned_crs = "EPSG:32632";
  MemorySource points;
  for (int i = 0; i < 16; ++i) {
    points.xy.push_back({static_cast<double>(i % 4), static_cast<double>(i / 4)});
    points.z.push_back(i * 5 % 7);
  }
  BuiltTin built;
  Progress progress;
  if (error_of([&] { built = build_tin(config, points, progress); })) return;
  if (built.tin.triangle_count() <= kMostTriangles) check_built(built, config.labelling.definition);
}

std::vector<std::string> seed_lines() {
  const auto with_options = [](int kind, int json, int z, int kinds, std::string_view bytes) {
    std::string input;
    for (const int option : {kind, json, z, kinds}) input += static_cast<char>(option);
    return input + std::string(bytes);
  };
  const std::string_view feature =
      R"({"type":"FeatureCollection","features":[{"type":"Feature","properties":{"z":3,"kind":"ridge"},)"
      R"("geometry":{"type":"LineString","coordinates":[[0.5,1],[2.5,1.5,4],[3,3]]}}]})";
  const std::string_view rings =
      "id,z,kind,WKT\n1,2,valley,\"POLYGON((0.5 0.5,2.5 0.5,2 2.5,0.5 0.5),(1 1,2 1,1.5 1.5,1 1))\"\n"
      "2,1,ridge,\"MULTIPOLYGON(((0 0,1 0,0 1,0 0)))\"\n";
  const std::string_view curves =
      "id,WKT\n1,\"CIRCULARSTRING(0 0,1 1,2 0)\"\n2,\"LINESTRING Z(0 0 1,3 3 2)\"\n"
      "3,\"MULTILINESTRING((0 3,3 0),(1 0,1 3))\"\n4,\"LINESTRING EMPTY\"\n";
  return {with_options(0, 1, 0, 0, feature), with_options(1, 1, 1, 1, feature),
          with_options(3, 0, 0, 0, rings),   with_options(4, 0, 0, 1, rings),
          with_options(5, 0, 1, 0, rings),   with_options(2, 0, 0, 0, curves)};
}

void verify_tiny(const std::string& report, const std::string& proof) {
  Progress progress;
  error_of([&] {
    verify_tin({.input = tiny_tin().mesh,
                .report_path = report,
                .proof_path = proof,
                .definition = {},
                .order = {},
                .reference = {},
                .points = {},
                .lines = {},
                .read = {}},
               progress);
  });
}

void run_report(std::string_view bytes) {
  const std::string path = scratch_path("input.json");
  write_file(path, bytes);
  verify_tiny(path, "");
}

void run_proof(std::string_view bytes) {
  const std::string path = scratch_path("input.proof");
  write_file(path, bytes);
  verify_tiny(tiny_tin().report, path);
}

std::vector<std::string> seed_reports() {
  return {read_file(tiny_tin().report)};
}

std::vector<std::string> seed_proofs() {
  return {read_file(tiny_tin().proof)};
}

}  // namespace

Target mesh_target() {
  return {"mesh", run_mesh, seed_meshes};
}
Target points_target() {
  return {"points", run_points, seed_points};
}
Target lines_target() {
  return {"lines", run_lines, seed_lines};
}
Target report_target() {
  return {"report", run_report, seed_reports};
}
Target proof_target() {
  return {"proof", run_proof, seed_proofs};
}

}  // namespace thalweg::fuzz
