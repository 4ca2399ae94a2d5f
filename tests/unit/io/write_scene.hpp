#pragma once

/// Small TINs and folders for the tests of files.

#include <thalweg/base/error.hpp>
#include <thalweg/io/read_tin.hpp>
#include <thalweg/io/write_tin.hpp>

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace thalweg::test {

/// A folder that is gone when the test ends.
class TempFolder {
 public:
  TempFolder() {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    path_ = std::filesystem::temp_directory_path() /
            ("thalweg-" + std::to_string(::getpid()) + "-" + test->test_suite_name() + "-" + test->name());
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_);
  }
  ~TempFolder() { std::filesystem::remove_all(path_); }
  TempFolder(const TempFolder&) = delete;
  TempFolder& operator=(const TempFolder&) = delete;

  [[nodiscard]] std::string file(const std::string& name) const { return (path_ / name).string(); }
  /// Names of everything in the folder, sorted.
  [[nodiscard]] std::vector<std::string> names() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(path_))
      names.push_back(entry.path().filename());
    std::sort(names.begin(), names.end());
    return names;
  }

 private:
  std::filesystem::path path_;
};

inline std::string read_text(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

inline void write_text(const std::string& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

/// A grid of columns x rows vertices whose coordinates need all digits, at UTM size; a valley along the
/// middle row, a ridge along the first column that meets it, the rim of the first row a boundary that is also
/// a ridge, and one vertex that is in no triangle.
inline Tin make_grid_tin(std::size_t columns, std::size_t rows) {
  std::vector<Point2> points;
  std::vector<double> heights;
  for (std::size_t j = 0; j < rows; ++j) {
    for (std::size_t i = 0; i < columns; ++i) {
      const double x = static_cast<double>(i), y = static_cast<double>(j);
      points.push_back({377813.655 + x * 30.1, 3792917.828 + y / 3});
      heights.push_back(1000 + 100 * std::sin(x * 0.7) * std::cos(y * 0.4));
    }
  }
  const auto id = [&](std::size_t i, std::size_t j) { return VertexId{j * columns + i}; };
  std::vector<Triangle> triangles;
  for (std::size_t j = 0; j + 1 < rows; ++j) {
    for (std::size_t i = 0; i + 1 < columns; ++i) {
      triangles.push_back({id(i, j), id(i + 1, j), id(i + 1, j + 1)});
      triangles.push_back({id(i, j), id(i + 1, j + 1), id(i, j + 1)});
    }
  }
  std::vector<ConstraintEdge> constraints;
  for (std::size_t i = 0; i + 1 < columns; ++i) {
    constraints.push_back({id(i, rows / 2), id(i + 1, rows / 2), EdgeKind::Valley});
    constraints.push_back({id(i, 0), id(i + 1, 0), EdgeKind::Ridge | EdgeKind::Boundary});
  }
  for (std::size_t j = 0; j + 1 < rows; ++j) constraints.push_back({id(0, j), id(0, j + 1), EdgeKind::Ridge});
  points.push_back({377000.1, 3792000.7});
  heights.push_back(1e-7);
  return {std::move(points), std::move(heights), std::move(triangles), constraints};
}

/// The TIN that a file describes.
inline Tin to_tin(TinFile file) {
  return {std::move(file.points), std::move(file.heights), std::move(file.triangles), file.constraints};
}

inline void expect_same_tin(const Tin& a, const Tin& b) {
  ASSERT_EQ(a.vertex_count(), b.vertex_count());
  ASSERT_EQ(a.triangle_count(), b.triangle_count());
  for (std::size_t v = 0; v < a.vertex_count(); ++v) {
    ASSERT_EQ(a.points()[v], b.points()[v]) << "vertex " << v;
    ASSERT_EQ(a.heights()[v], b.heights()[v]) << "vertex " << v;
  }
  for (std::size_t t = 0; t < a.triangle_count(); ++t) ASSERT_EQ(a.triangles()[t], b.triangles()[t]);
  const std::vector<ConstraintEdge> edges_a = a.constraint_edges();
  const std::vector<ConstraintEdge> edges_b = b.constraint_edges();
  ASSERT_EQ(edges_a.size(), edges_b.size());
  for (std::size_t e = 0; e < edges_a.size(); ++e) {
    EXPECT_EQ(edges_a[e].a, edges_b[e].a);
    EXPECT_EQ(edges_a[e].b, edges_b[e].b);
    EXPECT_EQ(edges_a[e].kind, edges_b[e].kind);
  }
}

/// Writes and commits.
inline void write_file(const std::string& path, const TinView& view, const WriteOptions& options = {},
                       Overwrite mode = Overwrite::No) {
  Progress progress;
  PendingOutputs pending;
  write_tin(path, view, options, pending, mode, progress);
  pending.commit();
}

inline TinFile read_file(const std::string& path) {
  Progress progress;
  return read_tin(path, progress);
}

/// Runs `action` and expects an Error of this code whose message holds every one of `words`.
template <class Action>
void expect_error(ErrorCode code, const std::vector<std::string>& words, const Action& action) {
  try {
    action();
    ADD_FAILURE() << "no error; expected " << error_name(code);
  } catch (const Error& error) {
    EXPECT_EQ(error_name(error.code()), error_name(code)) << error.what();
    for (const std::string& word : words) {
      EXPECT_NE(std::string(error.what()).find(word), std::string::npos)
          << error.what() << "\nlacks: " << word;
    }
  }
}

}  // namespace thalweg::test
