// Point location and interpolation: exact places, heights that keep to their supports.
#include <thalweg/delaunay/surface.hpp>
#include <thalweg/delaunay/triangulate.hpp>
#include <thalweg/geometry/predicates.hpp>
#include <thalweg/mesh/change_tin.hpp>

#include <gtest/gtest.h>
#include <support/random.hpp>

#include <algorithm>
#include <cmath>

namespace thalweg {
namespace {

Tin lattice_tin(std::size_t side, double (*height)(Point2)) {
  std::vector<Point2> points;
  std::vector<double> heights;
  for (std::size_t y = 0; y < side; ++y) {
    for (std::size_t x = 0; x < side; ++x) {
      points.push_back({static_cast<double>(x), static_cast<double>(y)});
      heights.push_back(height(points.back()));
    }
  }
  Progress progress;
  return triangulate(std::move(points), std::move(heights), {}, progress);
}

double slope(Point2 p) {
  return 2 * p.x - p.y + 7;
}

// The smallest triangle that holds p, straight from the definition.
std::optional<TriangleId> triangle_with(const Tin& tin, Point2 p) {
  for (std::size_t t = 0; t < tin.triangle_count(); ++t) {
    const Triangle& c = tin.triangle(TriangleId{t});
    const Point2 q[3] = {tin.point(c[0]), tin.point(c[1]), tin.point(c[2])};
    if (orientation(q[0], q[1], p) >= 0 && orientation(q[1], q[2], p) >= 0 &&
        orientation(q[2], q[0], p) >= 0) {
      return TriangleId{t};
    }
  }
  return std::nullopt;
}

TEST(Interpolation, IsExactWhereAllSupportsAreEqual) {
  test::Random random;
  SCOPED_TRACE(random.trace());
  for (int i = 0; i < 1000; ++i) {
    const double z = random.real(-1000, 1000);
    const Point2 a{random.real(0, 1), 0}, b{0, random.real(0.1, 1)}, c{-random.real(0.1, 1), 0},
        p{0, b.y / 3};
    EXPECT_EQ(interpolate_on_triangle({a, b, c}, {z, z, z}, p), z);
    EXPECT_EQ(interpolate_on_segment(a, z, b, z, p), z);
  }
}

TEST(Interpolation, StaysInRangeAndForgetsTheOrder) {
  test::Random random;
  SCOPED_TRACE(random.trace());
  for (int i = 0; i < 1000; ++i) {
    const Point2 a{random.real(0, 9), random.real(0, 9)}, b{random.real(0, 9), random.real(0, 9)};
    const Point2 c{random.real(0, 9), random.real(0, 9)};
    if (orientation(a, b, c) == 0) continue;
    const double u = random.real(0, 1), v = random.real(0, 1 - u);
    const Point2 p{a.x + u * (b.x - a.x) + v * (c.x - a.x), a.y + u * (b.y - a.y) + v * (c.y - a.y)};
    const double z = interpolate_on_triangle({a, b, c}, {1, 2, 1 + 0x1p-50}, p);
    EXPECT_GE(z, 1);
    EXPECT_LE(z, 2);
    EXPECT_EQ(z, interpolate_on_triangle({c, a, b}, {1 + 0x1p-50, 1, 2}, p));
    EXPECT_EQ(z, interpolate_on_triangle({b, a, c}, {2, 1, 1 + 0x1p-50}, p));
    EXPECT_EQ(interpolate_on_segment(a, 1, b, 2, p), interpolate_on_segment(b, 2, a, 1, p));
  }
}

TEST(Interpolation, EndsOfASegmentAreExact) {
  EXPECT_EQ(interpolate_on_segment({0, 0}, 0.1, {3, 4}, 0.7, {0, 0}), 0.1);
  EXPECT_EQ(interpolate_on_segment({0, 0}, 0.1, {3, 4}, 0.7, {3, 4}), 0.7);
  EXPECT_EQ(interpolate_on_segment({0, 0}, 1, {2, 0}, 3, {1, 0}), 2);
  EXPECT_EQ(interpolate_on_segment({0, 0}, 1, {2, 0}, 3, {9, 0}), 3) << "beyond the end: the end's height";
}

TEST(SurfaceLocator, FindsVerticesEdgesAndInsides) {
  const Tin tin = lattice_tin(4, slope);
  const SurfaceLocator locator(tin);
  EXPECT_EQ(locator.locate({1, 2})->support_count, 1U);
  EXPECT_EQ(locator.locate({1.5, 2})->support_count, 2U);
  EXPECT_EQ(locator.locate({1.25, 2.125})->support_count, 3U);
  EXPECT_EQ(locator.locate({0, 0})->support_count, 1U);
  EXPECT_EQ(locator.locate({3, 2.5})->support_count, 2U);
  EXPECT_FALSE(locator.locate({3.0000001, 2.5}));
  EXPECT_FALSE(locator.locate({-5, 2.5}));
  EXPECT_DOUBLE_EQ(*locator.height_at({1.3, 2.2}), slope({1.3, 2.2}));
}

TEST(SurfaceLocator, AgreesWithBruteForceWithHolesAndAnyHint) {
  test::Random random;
  SCOPED_TRACE(random.trace());
  const Tin whole = lattice_tin(12, slope);
  std::vector<bool> keep(whole.triangle_count());
  for (std::size_t t = 0; t < keep.size(); ++t) keep[t] = random.integer(0, 2) != 0;
  const Tin holed = keep_triangles(whole, keep);
  for (const Tin* tin : {&whole, &holed}) {
    const SurfaceLocator locator(*tin);
    for (int i = 0; i < 500; ++i) {
      Point2 p{random.real(-1, 12), random.real(-1, 12)};
      if (i % 2 == 0) p = {std::round(2 * p.x) / 2, std::round(2 * p.y) / 2};
      const TriangleId hint{random.integer<std::size_t>(0, tin->triangle_count() - 1)};
      const auto place = locator.locate(p, i % 3 == 0 ? TriangleId{} : hint);
      ASSERT_EQ(place.has_value(), triangle_with(*tin, p).has_value());
      if (!place) continue;
      EXPECT_NEAR(locator.height(*place, p), slope(p), 1e-12);
    }
  }
}

TEST(SurfaceLocator, AnEmptySurfaceHoldsNothing) {
  const Tin empty;
  EXPECT_FALSE(SurfaceLocator(empty).locate({0, 0}));
}

}  // namespace
}  // namespace thalweg
