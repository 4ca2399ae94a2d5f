#pragma once

/// Small TINs with their first-order quadrilaterals.

#include "support/random.hpp"

#include <thalweg/delaunay/triangulate.hpp>
#include <thalweg/order/quadrilaterals.hpp>

#include <algorithm>
#include <cstdlib>
#include <set>
#include <vector>

namespace thalweg::test {

struct Scene {
  Tin tin;
  std::vector<Quadrilateral> quadrilaterals;
};

/// How many scenes a long test takes: as many as usual, or as the environment variable THALWEG_SCENES says.
inline int scene_count(int usual) {
  const char* wanted = std::getenv("THALWEG_SCENES");
  return wanted != nullptr ? std::max(1, std::atoi(wanted)) : usual;
}

/// A scene with at most `limit` quadrilaterals; heights are whole numbers below `levels`.
inline Scene random_scene(Random& random, std::size_t limit, int levels, bool lattice) {
  std::set<Point2> places;
  const auto columns = random.integer<std::size_t>(2, 5), rows = random.integer<std::size_t>(2, 5);
  if (lattice) {
    for (std::size_t i = 0; i < columns * rows; ++i) {
      places.insert({static_cast<double>(i % columns) * 2, static_cast<double>(i / columns) * 2});
    }
  } else {
    const auto count = random.integer<std::size_t>(5, 2 * limit);
    while (places.size() < count) {
      places.insert({static_cast<double>(random.integer(0, 60)), static_cast<double>(random.integer(0, 60))});
    }
  }
  std::vector<Point2> points(places.begin(), places.end());
  std::shuffle(points.begin(), points.end(), random.engine());
  std::vector<double> heights;
  for (std::size_t i = 0; i < points.size(); ++i) heights.push_back(random.integer(0, levels - 1));
  Progress progress;
  const Tin plain = triangulate(points, heights, {}, progress);
  std::vector<ConstraintEdge> constraints;
  const int share = random.integer(0, 3);
  for (std::size_t i = 0; i < plain.halfedge_count(); ++i) {
    const HalfedgeId h{i};
    if (!plain.represents_edge(h) || random.integer(0, 19) >= share) continue;
    constraints.push_back(
        {plain.origin(h), plain.target(h), random.integer(0, 3) == 0 ? EdgeKind::Lake : EdgeKind::Valley});
  }
  Scene scene{triangulate(points, heights, constraints, progress), {}};
  scene.quadrilaterals = find_quadrilaterals(scene.tin, {}, progress);
  if (scene.quadrilaterals.size() > limit) scene.quadrilaterals.resize(limit);
  return scene;
}

/// One in three is a lattice.
inline Scene random_scene(Random& random, std::size_t limit, int levels) {
  const bool lattice = random.integer(0, 2) == 0;
  return random_scene(random, limit, levels, lattice);
}

}  // namespace thalweg::test
