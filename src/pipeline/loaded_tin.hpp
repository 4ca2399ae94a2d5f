#pragma once

/// A TIN file, read and brought to its plane.

#include "pipeline/plane.hpp"

#include <thalweg/io/read_tin.hpp>
#include <thalweg/io/write_tin.hpp>
#include <thalweg/mesh/tin.hpp>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace thalweg {

struct LoadedTin {
  Tin tin;
  CrsInfo crs;
  Plane plane;
  std::vector<Point2> written;              ///< empty: the plane's own
  std::vector<std::uint8_t> vertex_source;  ///< as in TinView; empty: not known
  std::vector<std::string> notes;           ///< what reading it took otherwise than it stands there

  [[nodiscard]] std::span<const Point2> written_points() const {
    return written.empty() ? tin.points() : std::span<const Point2>(written);
  }

  /// For writers, and which vertices it marks as pits: those that are not at the boundary.
  [[nodiscard]] std::vector<std::uint8_t> inner_pits() const;
  [[nodiscard]] TinView view(std::span<const std::uint8_t> is_pit) const {
    return {.tin = tin,
            .written_xy = written,
            .crs_wkt = crs.wkt,
            .crs_authority = crs.authority,
            .is_pit = is_pit,
            .vertex_source = vertex_source};
  }
};

/// Brings what was read of `path` to its plane. Throws: what projecting throws; Error{InvalidTin} naming the
/// file, for triangles that make no surface.
LoadedTin load_tin(TinFile file, const std::string& path, Progress& progress);
/// The same of a file. Throws: what reading throws, too.
LoadedTin load_tin(const std::string& path, Progress& progress);
/// Throws: Error{InvalidTin} naming the file and the first law that its TIN breaks.
void refuse_broken(const Tin& tin, const std::string& path);

}  // namespace thalweg
