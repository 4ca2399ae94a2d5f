// A disk that fills up at any byte gives WriteFailed and no file.
// The portable way to a small disk: a limit on the size of files (setrlimit), its signal ignored.
#include "write_scene.hpp"

#include <thalweg/io/write_raster.hpp>

#include <sys/resource.h>

#include <csignal>
#include <stdexcept>

namespace thalweg {
namespace {

using test::expect_error;
using test::make_grid_tin;
using test::TempFolder;

class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) : old_handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &old_);
    const rlimit limit{bytes, old_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() {
    setrlimit(RLIMIT_FSIZE, &old_);
    std::signal(SIGXFSZ, old_handler_);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;

 private:
  void (*old_handler_)(int);
  rlimit old_{};
};

class FullDisk : public testing::TestWithParam<const char*> {};

INSTANTIATE_TEST_SUITE_P(AllFormats, FullDisk,
                         testing::Values(".ply", ".2dm", ".obj", ".gpkg", ".nc", ".xml", ".off", ".stl",
                                         ".glb", ".vtu", ".fgb", ".geojson"),
                         [](const auto& param) { return std::string(param.param).substr(1); });

TEST_P(FullDisk, GivesWriteFailedAndNoFile) {
  const TempFolder folder;
  const std::string path = folder.file(std::string("a") + GetParam());
  const Tin tin = make_grid_tin(15, 10);
  const TinView view{.tin = tin, .crs_authority = "EPSG:32611"};
  test::write_file(path, view);
  const std::uintmax_t whole = std::filesystem::file_size(path);
  std::filesystem::remove_all(path);
  for (const std::string& name : folder.names()) std::filesystem::remove(folder.file(name));
  for (const std::uintmax_t part : {std::uintmax_t{0}, whole / 3, whole - 1}) {
    expect_error(ErrorCode::WriteFailed, {path.substr(0, path.size() - 4), "no partial file"}, [&] {
      const FileSizeLimit limit(part);
      test::write_file(path, view);
    });
    EXPECT_TRUE(folder.names().empty()) << part;
  }
  const FileSizeLimit limit(whole);
  test::write_file(path, view);
  EXPECT_EQ(std::filesystem::file_size(path), whole);
}

TEST(WriteRaster, PassesOnWhatAReportThrows) {
  const TempFolder folder;
  const std::vector<double> values(2500, 1);
  Progress progress([](const std::string& phase, double fraction) {
    if (phase.starts_with("write") && fraction > 0) throw std::logic_error("stop");
  });
  const RasterView view{.grid = {0, 0, 1, 50, 50}, .values = values};
  {
    PendingOutputs pending;
    EXPECT_THROW(write_raster(folder.file("a.tif"), view, {}, pending, Overwrite::No, progress),
                 std::logic_error);
  }
  EXPECT_TRUE(folder.names().empty());
}

TEST(FullDisk, DeviceWithoutRoom) {
  const Tin tin = make_grid_tin(20, 20);
  expect_error(ErrorCode::WriteFailed, {"/dev/full"},
               [&] { test::write_file("/dev/full", {.tin = tin}, {.format = "PLY"}); });
}

}  // namespace
}  // namespace thalweg
