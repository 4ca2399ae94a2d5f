#pragma once

/// Small sources, written into a folder of the test's own.

#include <thalweg/base/error.hpp>
#include <thalweg/io/source.hpp>

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

namespace thalweg {

class ReadTest : public testing::Test {
 protected:
  ReadTest() {
    const testing::TestInfo& test = *testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::temp_directory_path() / ("thalweg_" + std::string(test.test_suite_name()) +
                                                        "_" + test.name() + "_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder_);
  }
  ~ReadTest() override { std::filesystem::remove_all(folder_); }

  [[nodiscard]] std::string path(const std::string& name) const { return (folder_ / name).string(); }

  std::string write(const std::string& name, const std::string& content) const {
    std::ofstream(folder_ / name, std::ios::binary) << content;
    return path(name);
  }

  /// Reads point sources, given as on the command line.
  static ReadResult read(const std::vector<std::string>& points, const ReadOptions& options = {},
                         const std::vector<LineSource>& lines = {}) {
    std::vector<SourceSpec> specs;
    for (const std::string& point : points) specs.push_back(parse_source(point));
    Progress progress;
    return read_survey(specs, lines, options, progress);
  }
  static ReadResult read_lines(const std::string& source, const ReadOptions& options = {},
                               EdgeKind kind = EdgeKind::Breakline) {
    return read({}, options, {{parse_source(source), kind}});
  }

  /// Expects that `work` throws this code, and that the message holds all the texts.
  template <class Work>
  static void expect_error(ErrorCode code, const std::vector<std::string>& texts, const Work& work) {
    try {
      work();
      ADD_FAILURE() << "nothing was thrown";
    } catch (const Error& error) {
      EXPECT_EQ(error_name(error.code()), error_name(code)) << error.what();
      for (const std::string& text : texts) {
        EXPECT_NE(std::string(error.what()).find(text), std::string::npos)
            << error.what() << "\nlacks: " << text;
      }
    }
  }

  static bool has_note(const ReadResult& result, const std::string& text) {
    for (const std::string& note : result.notes) {
      if (note.find(text) != std::string::npos) return true;
    }
    return false;
  }

 private:
  std::filesystem::path folder_;
};

/// Writes a compressed file.
void write_gzip(const std::string& path, const std::string& content);

/// One feature of a layer to be written.
struct TestFeature {
  std::string wkt;                              ///< empty: no geometry
  std::string text;                             ///< value of the field "kind"; "-": null
  std::optional<double> number = std::nullopt;  ///< value of the field "elev"
};

/// Writes (or adds) a layer of any geometry with the fields kind (text) and elev (real) to a GeoPackage.
void write_layer(const std::string& path, const std::string& layer, const std::string& crs,
                 const std::vector<TestFeature>& features, const std::string& geometry_type = "GEOMETRY");

}  // namespace thalweg
