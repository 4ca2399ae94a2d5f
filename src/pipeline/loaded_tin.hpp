#pragma once

/// A TIN file, read and brought to its plane.

#include "pipeline/plane.hpp"

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

/// Throws: what reading and projecting throw.
LoadedTin load_tin(const std::string& path, Progress& progress);

}  // namespace thalweg
