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

/// What is subtracted from positions before they become single precision; whole numbers.
struct LocalOrigin {
  double x = 0;
  double y = 0;
  double z = 0;
};

/// One file to write: the writer fills `path`, errors name `target`; what belongs to it goes to `pending`.
struct TinWriteJob {
  const std::string& path;
  const std::string& target;
  const TinView& view;
  const CreationOptions& options;
  const LocalOrigin& origin;
  PendingOutputs& pending;
  Overwrite mode;
  Progress& progress;

  [[nodiscard]] std::span<const Point2> xy() const {
    return view.written_xy.empty() ? view.tin.points() : view.written_xy;
  }
};

struct TinFormat {
  FormatInfo info;
  enum class Crs : std::uint8_t { InFile, InSidecar } crs;
  enum class Numbers : std::uint8_t { Double, Single, SingleYUp } numbers;  ///< y up: as glTF has it
  /// Some are written back and forth, or are several files, which a stream does not bear.
  enum class Target : std::uint8_t { Stream, File } target;
  void (*write)(const TinWriteJob& job);
  /// True if a file whose first bytes are these is of this format.
  bool (*recognises)(std::string_view head, const std::string& path);
  TinFile (*read)(const std::string& path, Progress& progress);
};

std::span<const TinFormat> tin_format_table();

/// Throws: Error{Usage} where two creation options K=V have the same key, in any case.
void refuse_repeated_keys(const std::vector<std::string>& pairs);

/// "dir/name.ply" -> "dir/name.prj"
std::string sidecar_path(const std::string& path);

/// "dir/name.stl" -> "dir/name.stl.json", which tells the origin of a file in single precision.
std::string origin_path(const std::string& path);
/// The origin that the file beside `path` tells; zero without one. Throws: Error{BadFormat}.
LocalOrigin read_origin(const std::string& path);
/// The origin that keeps the most digits: zero if single precision holds every number, else the middle of the
/// box.
LocalOrigin choose_origin(std::span<const Point2> xy, std::span<const double> z);
/// Writes the sidecar of an origin; none, and none left, for zero. `y_is_up`: the file's z runs south.
void write_origin(const std::string& target, const TinView& view, const LocalOrigin& origin, bool y_is_up,
                  PendingOutputs& pending, Overwrite mode);

void write_ply(const TinWriteJob& job);
void write_2dm(const TinWriteJob& job);
void write_obj(const TinWriteJob& job);
void write_off(const TinWriteJob& job);
void write_stl(const TinWriteJob& job);
void write_glb(const TinWriteJob& job);
void write_vtu(const TinWriteJob& job);
void write_ugrid(const TinWriteJob& job);
void write_landxml(const TinWriteJob& job);
void write_gpkg(const TinWriteJob& job);
void write_flatgeobuf(const TinWriteJob& job);
void write_shapefile(const TinWriteJob& job);
void write_geojson(const TinWriteJob& job);

TinFile read_ply(const std::string& path, Progress& progress);
TinFile read_2dm(const std::string& path, Progress& progress);
TinFile read_obj(const std::string& path, Progress& progress);
TinFile read_off(const std::string& path, Progress& progress);
TinFile read_stl(const std::string& path, Progress& progress);
TinFile read_ugrid(const std::string& path, Progress& progress);
/// Whether a file is NetCDF with a mesh, rather than a raster.
bool holds_ugrid_mesh(const std::string& path);
TinFile read_landxml(const std::string& path, Progress& progress);
TinFile read_gpkg_tin(const std::string& path, Progress& progress);

}  // namespace thalweg
