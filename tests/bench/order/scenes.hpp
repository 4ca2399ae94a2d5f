#pragma once

/// Grounds to measure orders on; each is made once a size and kept.

#include <thalweg/mesh/tin.hpp>

#include <cstddef>
#include <cstdint>

namespace thalweg::bench {

enum class Scene : std::uint8_t {
  Random,     ///< uniform random points in a square, no constraint edges
  Random5,    ///< the same, with 5 % of the edges of their triangulation as constraint edges
  Random20,   ///< the same, 20 %
  Lattice,    ///< a square lattice: every cell cocircular
  Polylines,  ///< random points with winding lines through them
  Comb,       ///< random points between long parallel constraint edges
};

/// The constrained Delaunay triangulation of about `points` vertices, in random order of ids.
const Tin& ground(Scene scene, std::size_t points);

}  // namespace thalweg::bench
