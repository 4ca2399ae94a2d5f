#pragma once

/// The table of TIN formats: who writes and reads what.

#include <thalweg/io/read_tin.hpp>
#include <thalweg/io/write_tin.hpp>

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace thalweg {

/// The creation options that a user gave, checked against those that the format declares.
class CreationOptions {
 public:
  /// Throws: Error{Usage} for a pair that is no KEY=VALUE, for an unknown key and for a value that is not
  /// offered.
  CreationOptions(const std::vector<std::string>& pairs, const FormatInfo& format);
  [[nodiscard]] bool enabled(std::string_view key) const;
  /// The values of a list: "LAYERS=a,b". An empty list is not accepted.
  [[nodiscard]] std::vector<std::string> list(std::string_view key) const;

 private:
  [[nodiscard]] const std::string& value(std::string_view key) const;
  struct Option {
    std::string key;
    std::string value;
  };
  std::vector<Option> options_;
};

/// One file to write: the writer fills `path`, errors name `target`.
struct TinWriteJob {
  const std::string& path;
  const std::string& target;
  const TinView& view;
  const CreationOptions& options;
  Progress& progress;

  [[nodiscard]] std::span<const Point2> xy() const {
    return view.written_xy.empty() ? view.tin.points() : view.written_xy;
  }
};

struct TinFormat {
  FormatInfo info;
  enum class Crs : std::uint8_t { InFile, InSidecar } crs;
  void (*write)(const TinWriteJob& job);
  /// True if a file whose first bytes are these is of this format.
  bool (*recognises)(std::string_view head, const std::string& path);
  TinFile (*read)(const std::string& path, Progress& progress);
};

std::span<const TinFormat> tin_format_table();

/// "dir/name.ply" -> "dir/name.prj"
std::string sidecar_path(const std::string& path);

void write_ply(const TinWriteJob& job);
void write_2dm(const TinWriteJob& job);
void write_obj(const TinWriteJob& job);
void write_gpkg(const TinWriteJob& job);

TinFile read_ply(const std::string& path, Progress& progress);
TinFile read_2dm(const std::string& path, Progress& progress);
TinFile read_obj(const std::string& path, Progress& progress);
TinFile read_gpkg_tin(const std::string& path, Progress& progress);

}  // namespace thalweg
