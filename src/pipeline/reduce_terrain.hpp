#pragma once

/// Terrains with fewer vertices.

#include "pipeline/surface.hpp"

#include <thalweg/delaunay/triangulate.hpp>

#include <cstddef>
#include <optional>

namespace thalweg {

/// The terrain of the vertices that are in a kept triangle; ids close up in order.
Terrain without_lonely_vertices(Terrain terrain, TriangulationEngine engine, Progress& progress);

struct SimplifyLimits {
  std::optional<double> max_error_m;
  std::optional<std::size_t> max_points;
  TriangulationEngine engine = TriangulationEngine::Flat;
};

/// The terrain with as few vertices as the limits allow, and what was left out; fills the report's
/// simplification but for the errors of the result. Pre: all vertices are in kept triangles.
Terrain simplified(Terrain terrain, const SimplifyLimits& limits, const Plane& plane, Report& report,
                   Progress& progress);

}  // namespace thalweg
