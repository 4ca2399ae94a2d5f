#include "fuzz/scratch.hpp"

#include <thalweg/io/write_tin.hpp>
#include <thalweg/pipeline/build.hpp>

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>

namespace thalweg::fuzz {

namespace {

class Folder {
 public:
  Folder() {
    path_ = std::filesystem::temp_directory_path() / ("thalweg-fuzz-" + std::to_string(getpid()));
    std::filesystem::create_directories(path_);
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

TinyTin make_tiny_tin() {
  const std::string points = scratch_path("seed.csv"), lines = scratch_path("seed-lines.csv");
  std::string rows = "x,y,z\n";
  for (int i = 0; i < 25; ++i) {
    rows += std::to_string(i % 5) + "," + std::to_string(i / 5) + "," + std::to_string(i * 7 % 11) + "\n";
  }
  write_file(points, rows);
  write_file(lines, "id,WKT\n1,\"LINESTRING Z (0.5 0.5 3,3.5 2.5 1)\"\n");
  TinyTin tiny{.mesh = scratch_path("seed.ply"),
               .report = scratch_path("seed.json"),
               .proof = scratch_path("seed.proof"),
               .meshes = {}};
  BuildConfig config;
  config.points = {{points, ""}};
  config.lines = {{{lines, ""}, EdgeKind::Valley}};
  config.read.assigned_crs = "EPSG:32632";
  for (const FormatInfo& format : tin_formats()) {
    if (!format.reads) continue;
    Progress progress;
    config.output.path = scratch_path("seed" + format.extensions.front());
    config.output.overwrite = true;
    build(config, progress);
    tiny.meshes.push_back(read_file(config.output.path));
  }
  Progress progress;
  config.output.path = tiny.mesh;
  config.output.report_path = tiny.report;
  config.output.proof_path = tiny.proof;
  build(config, progress);
  return tiny;
}

}  // namespace

std::string scratch_path(std::string_view name) {
  static const Folder folder;
  return (folder.path() / name).string();
}

void write_file(const std::string& path, std::string_view bytes) {
  std::ofstream file(path, std::ios::binary | std::ios::trunc);
  file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

std::string read_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

const TinyTin& tiny_tin() {
  static const TinyTin tiny = make_tiny_tin();
  return tiny;
}

}  // namespace thalweg::fuzz
