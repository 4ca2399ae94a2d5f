#pragma once

/// The flip heuristic for few local minima, as a baseline to measure the optimum against.

#include <thalweg/mesh/tin.hpp>
#include <thalweg/order/fixed_faces.hpp>

namespace thalweg::bench {

/// Flips edges of the triangulation as long as both new triangles are candidates and the new edge ends in the
/// lowest of the four corners, which never makes a vertex a local minimum. Edges in order of their ends;
/// those around a flipped one are looked at again. Based on: T. de Kok, M. van Kreveld, M. Loeffler,
/// Generating realistic terrains with higher-order Delaunay triangulations, 2007, section 4.
Tin flip_to_lowest(const Tin& delaunay, const FixedFaces& faces);

}  // namespace thalweg::bench
