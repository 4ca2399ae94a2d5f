// Which diagonals points left out bar, and how far a TIN is from them, against plain code.
#include "support/first_order_scene.hpp"
#include "support/plain_surface.hpp"

#include <thalweg/geometry/predicates.hpp>
#include <thalweg/mesh/change_tin.hpp>
#include <thalweg/terrain/source_error.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace thalweg {
namespace {

// The error of a point, found by looking into every triangle.
long double plain_error(const Tin& tin, Point2 p, double z) {
  for (const Triangle& t : tin.triangles()) {
    const Point2 a = tin.point(t[0]), b = tin.point(t[1]), c = tin.point(t[2]);
    const auto area = [](Point2 o, Point2 q, Point2 r) {
      return (static_cast<long double>(q.x) - o.x) * (static_cast<long double>(r.y) - o.y) -
             (static_cast<long double>(q.y) - o.y) * (static_cast<long double>(r.x) - o.x);
    };
    const long double wa = area(p, b, c), wb = area(a, p, c), wc = area(a, b, p);
    if (wa < 0 || wb < 0 || wc < 0) continue;
    const long double height =
        (wa * tin.height(t[0]) + wb * tin.height(t[1]) + wc * tin.height(t[2])) / area(a, b, c);
    return std::abs(z - height);
  }
  ADD_FAILURE() << "a point is outside";
  return 0;
}

LeftOutPoints random_points(const Tin& tin, std::size_t count, test::Random& random) {
  LeftOutPoints points;
  while (points.xy.size() < count) {
    const auto t = random.integer<std::size_t>(0, tin.triangle_count() - 1);
    std::array<double, 3> weight{random.real(0.05, 1), random.real(0.05, 1), random.real(0.05, 1)};
    const double sum = weight[0] + weight[1] + weight[2];
    Point2 p;
    for (std::size_t i = 0; i < 3; ++i) {
      p.x += weight[i] / sum * tin.point(tin.triangle(TriangleId{t})[i]).x;
      p.y += weight[i] / sum * tin.point(tin.triangle(TriangleId{t})[i]).y;
    }
    points.xy.push_back(p);
    points.z.push_back(random.real(-1, 5));
    points.triangle.emplace_back(t);
  }
  return points;
}

TEST(SourceError, ADiagonalIsBarredExactlyIfAPointWouldBeTooFar) {
  test::Random random;
  SCOPED_TRACE(random.trace());
  Progress progress;
  std::size_t barred = 0, free = 0;
  for (int round = 0; round < 60; ++round) {
    const test::Scene scene = test::random_scene(random, 12, 5);
    const LeftOutPoints points = random_points(scene.tin, 25, random);
    const double limit = random.real(0.5, 4);
    std::vector<Quadrilateral> kept = scene.quadrilaterals;
    bar_diagonals(scene.tin, points, limit, kept, progress);
    for (const Quadrilateral& q : scene.quadrilaterals) {
      const std::array<std::uint8_t, 1> flip{1};
      const Tin flipped = test::with_diagonals(scene.tin, std::vector{q}, flip);
      bool too_far = false;
      for (std::size_t i = 0; i < points.xy.size(); ++i) {
        const TriangleId t = points.triangle[i];
        if (t != Tin::triangle_of(q.diagonal) && t != Tin::triangle_of(scene.tin.twin(q.diagonal))) continue;
        too_far = too_far || plain_error(flipped, points.xy[i], points.z[i]) > limit;
      }
      EXPECT_EQ(std::find(kept.begin(), kept.end(), q) == kept.end(), too_far);
      ++(too_far ? barred : free);
    }
  }
  EXPECT_GT(barred, 50U);
  EXPECT_GT(free, 50U);
}

TEST(SourceError, IsMeasuredOnTheFlippedTin) {
  test::Random random;
  SCOPED_TRACE(random.trace());
  for (int round = 0; round < 40; ++round) {
    const test::Scene scene = test::random_scene(random, 12, 5);
    const LeftOutPoints points = random_points(scene.tin, 40, random);
    std::vector<HalfedgeId> flips;
    for (const Quadrilateral& q : scene.quadrilaterals) {
      if (random.integer(0, 1) == 1) flips.push_back(q.diagonal);
    }
    const Tin after = flip_edges(scene.tin, flips).tin;
    const LeftOutPoints moved = relocated(points, scene.tin, after);
    const SourceError error = measure_error(after, moved);
    long double largest = 0, squares = 0;
    for (std::size_t i = 0; i < points.xy.size(); ++i) {
      const long double here = plain_error(after, points.xy[i], points.z[i]);
      largest = std::max(largest, here);
      squares += here * here;
    }
    EXPECT_NEAR(error.largest, static_cast<double>(largest), 1e-9);
    EXPECT_NEAR(error.rms, std::sqrt(static_cast<double>(squares / (40 + after.vertex_count()))), 1e-9);
  }
}

}  // namespace
}  // namespace thalweg
