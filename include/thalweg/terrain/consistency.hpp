#pragma once

/// Whether drawn valleys and ridges are valleys and ridges of the surface.

#include <thalweg/mesh/tin.hpp>
#include <thalweg/terrain/statistics.hpp>

#include <cstddef>
#include <vector>

namespace thalweg {

/// A drawn edge that is not what it was drawn as.
struct Inconsistency {
  enum class Kind : std::uint8_t {
    ValleyRises,  ///< it rises downstream
    RidgeCrossed  ///< water runs over it from one side to the other
  };
  Kind kind = Kind::ValleyRises;
  VertexId from;  ///< downstream: from the line's higher end to its lower one
  VertexId to;
  double rise_m = 0;
};

/// Lengths in metres in the plane. Downstream: a TIN does not keep the direction in which a line was drawn,
/// so a line of valley edges, from one end or meeting of lines to the next, is taken to run from its higher
/// end to its lower one; closed ones and those with level ends have no direction.
struct Consistency {
  std::size_t valley_edges = 0;
  double valley_length_m = 0;
  double draining_length_m = 0;  ///< of drawn valley edges that are valley edges of the surface
  std::size_t rising_edges = 0;
  double rise_sum_m = 0;
  double rise_max_m = 0;
  std::size_t ridge_edges = 0;
  std::size_t crossed_ridge_edges = 0;
  std::size_t undrawn_valley_edges = 0;  ///< valley edges of the surface that are not drawn
  std::size_t triangles_on_valleys = 0;  ///< all three vertices are on drawn valleys
  std::size_t flat_triangles = 0;
  std::size_t flat_edges = 0;
  std::vector<Inconsistency> places;  ///< rising valleys, then crossed ridges
};

/// Valley edges of the surface are those of `SurfaceFlow::is_valley`, decided exactly. Complexity: linear.
Consistency check_consistency(const Tin& tin, const MetricScale& scale);

}  // namespace thalweg
