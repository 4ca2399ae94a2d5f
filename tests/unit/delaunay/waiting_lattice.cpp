// Rows of a lattice against a look at each vertex, in exact arithmetic; the queue of peaks against a sorted
// list.
#include "delaunay/waiting_lattice.hpp"

#include "delaunay/peaks.hpp"

#include <thalweg/geometry/predicates.hpp>

#include <gtest/gtest.h>
#include <support/random.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <tuple>

namespace thalweg::detail {
namespace {

struct Scene {
  std::vector<Point2> xy;
  std::vector<double> z;
  std::vector<bool> waits;
};

// A lattice with gaps, its vertices row by row or shuffled between neighbours.
Scene scene_of(test::Random& random, std::size_t columns, std::size_t rows, Point2 origin, Point2 step) {
  Scene scene;
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t column = 0; column < columns; ++column) {
      scene.xy.push_back(
          {origin.x + static_cast<double>(column) * step.x, origin.y + static_cast<double>(row) * step.y});
      scene.z.push_back(random.integer(0, 3) == 0 ? 7 : random.real(-50, 50));
      scene.waits.push_back(random.integer(0, 9) != 0);
    }
  }
  return scene;
}

bool brute_holds(const OwningTriangle& triangle, Point2 p) {
  for (std::size_t i = 0; i < 3; ++i) {
    const int side = orientation(triangle.corner[(i + 1) % 3], triangle.corner[(i + 2) % 3], p);
    if (side < 0 || (side == 0 && (triangle.owned >> i & 1U) == 0)) return false;
  }
  return true;
}

// Corners on the lattice, near it, or anywhere.
OwningTriangle triangle_in(test::Random& random, const Scene& scene) {
  OwningTriangle triangle;
  do {
    for (Point2& p : triangle.corner) {
      p = scene.xy[random.integer<std::size_t>(0, scene.xy.size() - 1)];
      const int how = random.integer(0, 9);
      if (how == 0) p.x += random.real(-3, 3);
      if (how == 1) p.y += random.real(-3, 3);
      if (how == 2) p.y = std::nextafter(p.y, 1e9);
      if (how == 3) p.x = std::nextafter(p.x, -1e9);
      if (how == 4) p.y += 1e-7;
    }
    if (random.integer(0, 3) == 0) triangle.corner[1].y = triangle.corner[0].y;
  } while (orientation(triangle.corner[0], triangle.corner[1], triangle.corner[2]) == 0);
  if (orientation(triangle.corner[0], triangle.corner[1], triangle.corner[2]) < 0) {
    std::swap(triangle.corner[0], triangle.corner[1]);
  }
  triangle.owned = random.integer(0U, 7U);
  return triangle;
}

void expect_as_brute(const WaitingLattice& lattice, const Scene& scene, const OwningTriangle& triangle,
                     const HeightPlane& plane) {
  std::vector<std::uint32_t> inside, found;
  LatticePeak highest;
  for (std::uint32_t v = 0; v < scene.xy.size(); ++v) {
    if (!scene.waits[v] || !brute_holds(triangle, scene.xy[v])) continue;
    inside.push_back(v);
    const double error = std::abs(scene.z[v] - plane.height(scene.xy[v]));
    if (error < highest.error) continue;
    if (error == highest.error && scene.xy[highest.vertex] < scene.xy[v]) continue;
    highest = {error, v};
  }
  lattice.append(triangle, found);
  std::sort(found.begin(), found.end());
  EXPECT_EQ(found, inside);
  const LatticePeak peak = lattice.peak(triangle, plane);
  EXPECT_EQ(peak.vertex, highest.vertex);
  EXPECT_EQ(peak.error, highest.error);
}

void expect_rows_of(test::Random& random, Scene scene) {
  auto lattice = WaitingLattice::find(scene.xy, scene.z, scene.waits);
  ASSERT_TRUE(lattice.has_value());
  for (int round = 0; round < 400; ++round) {
    const OwningTriangle triangle = triangle_in(random, scene);
    for (std::size_t v = 0; v < scene.xy.size(); ++v) {  // corners are in, so they do not wait
      if (!scene.waits[v] || std::count(triangle.corner.begin(), triangle.corner.end(), scene.xy[v]) == 0)
        continue;
      lattice->take(scene.xy[v]);
      scene.waits[v] = false;
    }
    const bool level = random.integer(0, 2) == 0;
    const HeightPlane plane{triangle.corner[0], 7, level ? 0 : random.real(-2, 2),
                            level ? 0 : random.real(-2, 2)};
    expect_as_brute(*lattice, scene, triangle, plane);
  }
}

TEST(WaitingLattice, FindsWhatATriangleHolds) {
  test::Random random;
  SCOPED_TRACE(random.trace());
  expect_rows_of(random, scene_of(random, 40, 31, {0, 0}, {1, 1}));
  expect_rows_of(random, scene_of(random, 23, 57, {500000, 5200000}, {10, -10}));
}

// Such coordinates are not evenly spaced, nor are points that look collinear.
TEST(WaitingLattice, RoundedCoordinates) {
  test::Random random;
  SCOPED_TRACE(random.trace());
  expect_rows_of(random, scene_of(random, 35, 30, {-84.1, 36.3}, {1.0 / 1200, -1.0 / 3600}));
  expect_rows_of(random, scene_of(random, 35, 30, {413000.2, 3797000.7}, {27.7483, 30.1}));
}

TEST(WaitingLattice, NoneAmongOthers) {
  test::Random random;
  SCOPED_TRACE(random.trace());
  Scene scene = scene_of(random, 20, 20, {0, 0}, {1, 1});
  scene.waits.assign(scene.waits.size(), true);
  EXPECT_TRUE(WaitingLattice::find(scene.xy, scene.z, scene.waits).has_value());
  scene.xy[77].x += 0.25;
  EXPECT_FALSE(WaitingLattice::find(scene.xy, scene.z, scene.waits).has_value());
  scene.waits[77] = false;
  EXPECT_TRUE(WaitingLattice::find(scene.xy, scene.z, scene.waits).has_value());
  for (std::size_t v = 0; v < scene.waits.size(); ++v) scene.waits[v] = v % 19 == 0;
  EXPECT_FALSE(WaitingLattice::find(scene.xy, scene.z, scene.waits).has_value());
  scene.waits.assign(scene.waits.size(), false);
  EXPECT_FALSE(WaitingLattice::find(scene.xy, scene.z, scene.waits).has_value());
}

TEST(Peaks, HighestFirst) {
  test::Random random;
  SCOPED_TRACE(random.trace());
  std::vector<Point2> xy;
  for (int i = 0; i < 50; ++i) xy.push_back({random.real(0, 1), random.real(0, 1)});
  Peaks peaks(xy);
  std::set<std::tuple<double, Point2, std::uint32_t>> sorted;  // negated errors: the first is the highest
  for (std::uint32_t round = 0; round < 3000; ++round) {
    if (random.integer(0, 2) != 0) {
      const auto vertex = random.integer(0U, 49U);
      const double error =
          random.integer(0, 1) == 0 ? random.integer(1, 4) : std::exp(random.real(-300, 300));
      peaks.push({error, vertex, round});
      sorted.insert({-error, xy[vertex], round});
    }
    const Peak* highest = peaks.highest();
    ASSERT_EQ(highest == nullptr, sorted.empty());
    if (highest == nullptr) continue;
    EXPECT_EQ(highest->error, -std::get<0>(*sorted.begin()));
    EXPECT_EQ(xy[highest->vertex], std::get<1>(*sorted.begin()));
    if (random.integer(0, 1) == 0) continue;
    sorted.erase({-highest->error, xy[highest->vertex], highest->cell});
    peaks.pop();
  }
}

}  // namespace
}  // namespace thalweg::detail
