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
  VertexId from;  ///< downstream
  VertexId to;
  double rise_m = 0;
};

/// Lengths in metres in the plane. Downstream: a TIN does not keep the direction in which a line was drawn,
/// so all water of a net of valley edges that hang together is taken to leave at one vertex, that for which
/// heights along lines have to change least so that none rises towards it. Lines between whose ends there is
/// another way run from the higher end to the lower one; closed ones, and such with level ends, have no
/// direction.
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
