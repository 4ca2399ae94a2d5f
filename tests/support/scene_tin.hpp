#pragma once

/// From a scene of the oracle to the TIN that the library works on.

#include <thalweg/delaunay/triangulate.hpp>
#include <thalweg/mesh/change_tin.hpp>
#include <thalweg/mesh/ground_mode.hpp>
#include <thalweg/mesh/tin.hpp>

#include <support/oracle/scene.hpp>

#include <utility>
#include <vector>

namespace thalweg::test {

inline GroundMode mode_of(const oracle::Scene& scene) {
  return scene.polygon_mode() ? GroundMode::Polygon : GroundMode::Hull;
}

inline VertexId vertex(int site) {
  return VertexId{static_cast<std::size_t>(site)};
}

inline Triangle triangle(const oracle::Corners& corners) {
  return {vertex(corners[0]), vertex(corners[1]), vertex(corners[2])};
}

/// The ground of a scene: its constrained Delaunay triangulation, of the hull or inside of the boundary.
inline Tin ground_of(const oracle::Scene& scene) {
  std::vector<Point2> points;
  for (const oracle::Site& site : scene.sites) {
    points.push_back({static_cast<double>(site.x), static_cast<double>(site.y)});
  }
  std::vector<ConstraintEdge> edges;
  for (const auto& [a, b] : scene.constraints) edges.push_back({vertex(a), vertex(b), EdgeKind::Breakline});
  for (const auto& [a, b] : scene.boundary) edges.push_back({vertex(a), vertex(b), EdgeKind::Boundary});
  Progress progress;
  Tin tin = triangulate(points, std::vector<double>(points.size(), 0.0), edges, progress);
  if (!scene.polygon_mode()) return tin;
  std::vector<bool> keep;
  for (const Triangle& t : tin.triangles()) {
    oracle::Spot centroid{0, 0, 3};
    for (const VertexId v : t) {
      centroid.x += scene.at(static_cast<int>(v.index())).x;
      centroid.y += scene.at(static_cast<int>(v.index())).y;
    }
    keep.push_back(oracle::in_ground(scene, centroid));
  }
  return keep_triangles(tin, keep);
}

}  // namespace thalweg::test
