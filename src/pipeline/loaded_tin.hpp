#pragma once

/// A TIN file, read and brought to its plane.

#include "pipeline/plane.hpp"

#include <thalweg/mesh/tin.hpp>

#include <span>
#include <string>
#include <vector>

namespace thalweg {

struct LoadedTin {
  Tin tin;
  CrsInfo crs;
  Plane plane;
  std::vector<Point2> written;  ///< empty: the plane's own

  [[nodiscard]] std::span<const Point2> written_points() const {
    return written.empty() ? tin.points() : std::span<const Point2>(written);
  }
};

/// Throws: what reading and projecting throw.
LoadedTin load_tin(const std::string& path, Progress& progress);

}  // namespace thalweg
