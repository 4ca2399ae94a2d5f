#pragma once

/// Values of a TIN's surface at places: height, slope, aspect, shade.

#include <thalweg/base/progress.hpp>
#include <thalweg/mesh/tin.hpp>
#include <thalweg/terrain/statistics.hpp>

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace thalweg {

/// What is asked of the surface.
enum class SurfaceValue : std::uint8_t {
  Elevation,  ///< height, in the TIN's own unit
  Hillshade,  ///< 1 (dark) to 255, light from the north-west (315 degrees), 45 degrees high
  Slope,      ///< degrees from the horizontal
  Aspect  ///< degrees clockwise from +y of the direction in which the ground falls; none where it is level
};

/// Answers what the surface of a TIN is like. Keeps a reference to the TIN, which must stay where it is.
///
/// Laws: (1) elevation at a vertex is the vertex's height, to the last bit; (2) elevation lies in the range
/// of the heights of the triangle's corners; (3) places outside of the closed surface are NaN; (4) the
/// answers do not depend on the number of threads. Slope, aspect and hillshade are those of the triangle that
/// holds the place, each of them one plane; on an edge, of one of its two triangles.
class SurfaceSampler {
 public:
  SurfaceSampler(const Tin& tin, MetricScale scale);
  ~SurfaceSampler();
  SurfaceSampler(const SurfaceSampler&) = delete;
  SurfaceSampler& operator=(const SurfaceSampler&) = delete;

  /// The values at `places`, in the TIN's plane; NaN where there is none. Throws: Error{Cancelled}.
  /// Complexity: a short walk a place if neighbours in the list are near each other; on all threads.
  [[nodiscard]] std::vector<double> sample(std::span<const Point2> places, SurfaceValue value,
                                           const Progress& progress) const;

 private:
  struct Index;
  std::unique_ptr<const Index> index_;
};

}  // namespace thalweg
