// A TIN file is projected where its CRS is geographic.
#include "pipeline/loaded_tin.hpp"

#include <thalweg/base/error.hpp>
#include <thalweg/mesh/validate.hpp>
#include <thalweg/terrain/pits.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace thalweg {

namespace {

constexpr const char* kRepair = "; repair the mesh, or build a TIN of its points (thalweg build)";

}  // namespace

LoadedTin load_tin(TinFile file, const std::string& path, Progress& progress) {
  CrsInfo crs = describe_crs(file.crs);
  Plane plane(crs, file.points);
  std::vector<Point2> points = plane.to_plane(file.points, progress);
  Tin tin = [&]() -> Tin {
    try {
      return {std::move(points), std::move(file.heights), std::move(file.triangles), file.constraints};
    } catch (const Error& error) {
      throw Error(error.code(),
                  path + ": " + error.what() + (error.code() == ErrorCode::InvalidTin ? kRepair : ""));
    }
  }();
  LoadedTin loaded{std::move(tin),       std::move(crs), std::move(plane), {}, std::move(file.vertex_source),
                   std::move(file.notes)};
  if (loaded.plane.projected()) loaded.written = std::move(file.points);
  return loaded;
}

LoadedTin load_tin(const std::string& path, Progress& progress) {
  return load_tin(read_tin(path, progress), path, progress);
}

void refuse_broken(const Tin& tin, const std::string& path) {
  if (const auto violations = validate(tin); !violations.empty()) {
    throw Error(ErrorCode::InvalidTin,
                fmt::format("{}: breaks law {}: {}; `thalweg info` lists all violations{}", path,
                            violations.front().code, violations.front().what, kRepair));
  }
}

std::vector<std::uint8_t> LoadedTin::inner_pits() const {
  std::vector<std::uint8_t> pits = find_pits(tin).is_pit;
  std::replace(pits.begin(), pits.end(), static_cast<std::uint8_t>(PitKind::Boundary), std::uint8_t{0});
  return pits;
}

}  // namespace thalweg
