#pragma once

/// Random terrains, triangulated.

#include "support/meshes.hpp"

#include <thalweg/delaunay/triangulate.hpp>

#include <cmath>
#include <utility>
#include <vector>

namespace thalweg::test {

/// By turns white noise on scattered points, hills with noise, and a lattice with few levels.
inline Tin random_terrain(int i, Random& random) {
  if (i % 3 == 2) {
    return random_lattice(random.integer<std::size_t>(2, 14), random.integer<std::size_t>(2, 14),
                          random.integer(1, 9), random);
  }
  std::vector<Point2> points;
  std::vector<double> heights;
  for (std::size_t k = random.integer<std::size_t>(3, 250); k > 0; --k) {
    const Point2 p{random.real(0, 100), random.real(0, 100)};
    points.push_back(p);
    const double hills = 10 * std::sin(p.x / 9) * std::cos(p.y / 13) + p.x / 20;
    heights.push_back(i % 3 == 0 ? random.real(0, 10) : hills + random.real(0, 0.5));
  }
  Progress progress;
  return triangulate(std::move(points), std::move(heights), {}, progress);
}

}  // namespace thalweg::test
