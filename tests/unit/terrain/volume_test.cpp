// Volumes of bodies whose volume is known, and laws on random ones.
#include "support/meshes.hpp"

#include <thalweg/delaunay/triangulate.hpp>
#include <thalweg/terrain/volume.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <vector>

namespace thalweg {
namespace {

using test::make_tin;
using test::triangle;

Tin tin_of(std::vector<Point2> points, std::vector<double> heights) {
  Progress progress;
  return triangulate(std::move(points), std::move(heights), {}, progress);
}

// Base 4 by 4 at the given height, apex 3 above it.
Tin pyramid(double base = 0, Point2 at = {0, 0}) {
  return make_tin(
      {{at.x, at.y}, {at.x + 4, at.y}, {at.x + 4, at.y + 4}, {at.x, at.y + 4}, {at.x + 2, at.y + 2}},
      {triangle(0, 1, 4), triangle(1, 2, 4), triangle(2, 3, 4), triangle(3, 0, 4)}, {},
      {base, base, base, base, base + 3});
}

Tin square(double x0, double y0, double x1, double y1, double z) {
  return make_tin({{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}, {triangle(0, 1, 2), triangle(0, 2, 3)}, {},
                  {z, z, z, z});
}

TEST(Volume, OfAPyramidAboveAPlane) {
  const Progress progress;
  const Volumes whole = volume_above(pyramid(), 0, progress);
  EXPECT_DOUBLE_EQ(whole.above, 16);
  EXPECT_EQ(whole.below, 0);
  EXPECT_DOUBLE_EQ(whole.area, 16);
  EXPECT_DOUBLE_EQ(whole.area_above, 16);
  // Above 1 there is a pyramid of two thirds the size; below it the rest of the box is missing.
  const Volumes cut = volume_above(pyramid(), 1, progress);
  EXPECT_DOUBLE_EQ(cut.above, 16 * 8.0 / 27);
  EXPECT_DOUBLE_EQ(cut.below, 16 - (16 - 16 * 8.0 / 27));
  EXPECT_DOUBLE_EQ(cut.area_above, 16 * 4.0 / 9);
  EXPECT_DOUBLE_EQ(cut.area_below, 16 - 16 * 4.0 / 9);
  const Volumes under = volume_above(pyramid(), 10, progress);
  EXPECT_EQ(under.above, 0);
  EXPECT_DOUBLE_EQ(under.below, 16 * 10 - 16);
}

TEST(Volume, FarFromTheOriginCostsNoDigits) {
  const Progress progress;
  const Point2 far{677000, 5150000};
  EXPECT_DOUBLE_EQ(volume_above(pyramid(2000, far), 2001, progress).above, 16 * 8.0 / 27);
  EXPECT_DOUBLE_EQ(
      volume_between(pyramid(2000, far), square(far.x - 3, far.y - 3, far.x + 9, far.y + 9, 2000), progress)
          .above,
      16);
}

TEST(Volume, BetweenTins) {
  const Progress progress;
  const Volumes onto_plane = volume_between(pyramid(), square(-1, -1, 7, 9, 1), progress);
  const Volumes above = volume_above(pyramid(), 1, progress);
  EXPECT_NEAR(onto_plane.above, above.above, 1e-12);
  EXPECT_NEAR(onto_plane.below, above.below, 1e-12);
  EXPECT_NEAR(onto_plane.area, 16, 1e-12);
  // Only half of the pyramid lies over this square.
  const Volumes half = volume_between(pyramid(), square(-1, -1, 2, 9, 0), progress);
  EXPECT_NEAR(half.above, 8, 1e-12);
  EXPECT_NEAR(half.area, 8, 1e-12);
  const Volumes apart = volume_between(pyramid(), square(5, 5, 6, 6, 0), progress);
  EXPECT_EQ(apart.area, 0);
  EXPECT_EQ(apart.above + apart.below, 0);
  // Two tilted planes cross along x = 2: wedges of 4 by 2 by 2 on each side.
  const Tin one =
      make_tin({{0, 0}, {4, 0}, {4, 4}, {0, 4}}, {triangle(0, 1, 2), triangle(0, 2, 3)}, {}, {0, 4, 4, 0});
  const Tin other =
      make_tin({{0, 0}, {4, 0}, {4, 4}, {0, 4}}, {triangle(0, 1, 3), triangle(1, 2, 3)}, {}, {2, 2, 2, 2});
  const Volumes wedges = volume_between(one, other, progress);
  EXPECT_NEAR(wedges.above, 8, 1e-12);
  EXPECT_NEAR(wedges.below, 8, 1e-12);
}

TEST(Volume, LawsOnRandomTins) {
  test::Random random;
  SCOPED_TRACE(random.trace());
  const Progress progress;
  for (int round = 0; round < 15; ++round) {
    const auto rough = [&](std::size_t count) {
      std::vector<Point2> points{{0, 0}, {10, 0}, {10, 10}, {0, 10}};
      std::vector<double> heights;
      while (points.size() < count) points.push_back({random.real(0, 10), random.real(0, 10)});
      for (std::size_t i = 0; i < count; ++i) heights.push_back(random.real(-2, 2));
      return tin_of(points, heights);
    };
    const Tin a = rough(40), b = rough(25);
    const Volumes ab = volume_between(a, b, progress), ba = volume_between(b, a, progress);
    EXPECT_NEAR(ab.above, ba.below, 1e-9);
    EXPECT_NEAR(ab.below, ba.above, 1e-9);
    EXPECT_NEAR(ab.area, 100, 1e-9);
    EXPECT_NEAR(ab.area_above + ab.area_below, 100, 1e-9);
    const double level = random.real(-3, 3);
    const Volumes over_a = volume_above(a, level, progress), over_b = volume_above(b, level, progress);
    EXPECT_NEAR(ab.above - ab.below, over_a.above - over_a.below - over_b.above + over_b.below, 1e-9);
    const Volumes plane = volume_between(a, square(-1, -1, 11, 11, level), progress);
    EXPECT_NEAR(plane.above, over_a.above, 1e-9);
    EXPECT_NEAR(plane.area_below, over_a.area_below, 1e-9);
    EXPECT_NEAR(volume_between(a, a, progress).above, 0, 1e-12);
  }
}

}  // namespace
}  // namespace thalweg
