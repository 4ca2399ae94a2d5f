#pragma once

/// Refuses, before the work starts, what the memory cannot hold.

#include <thalweg/io/write_raster.hpp>
#include <thalweg/pipeline/build.hpp>

#include <cstddef>
#include <string>

namespace thalweg {

/// What a run of the main job needs is estimated from its vertices; it may take more where many lines
/// cross, and at orders above 2.
class MemoryEstimate {
 public:
  /// Looks at what memory there is now.
  explicit MemoryEstimate(const BuildConfig& config);
  /// The survey is projected to a plane, and keeps the coordinates that came in.
  void add_projection();
  /// Throws: Error{OutOfMemory} if the limit or the machine cannot hold a run of so many vertices.
  void require(std::size_t vertices) const;

 private:
  std::size_t room_ = 0;
  std::string limited_by_;
  std::size_t bytes_a_vertex_ = 0;
};

/// Throws: Error{OutOfMemory} if the machine cannot hold the values of a raster, as doubles, and what GDAL
/// makes of them, which a format may have in memory three times (GeoTIFF; formats of text take more).
void require_memory(const RasterGrid& grid, RasterType type);

}  // namespace thalweg
