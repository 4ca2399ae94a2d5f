// Sampling against planes, and at vertices.
#include "terrain_scene.hpp"

#include <thalweg/terrain/sample_surface.hpp>

#include <algorithm>
#include <cmath>

namespace thalweg {
namespace {

using test::grid_tin;

TEST(SampleSurface, PlaneByItsFormula) {
  const Tin tin = grid_tin(6, 5, [](double x, double y) { return 3 * x - 4 * y + 7; });
  const SurfaceSampler sampler(tin, {});
  const Progress progress;
  const std::vector<Point2> places = {{0, 0}, {2.5, 1.25}, {4.75, 3.5}, {5, 4}, {5.001, 2}, {-1, 0}};
  const std::vector<double> z = sampler.sample(places, SurfaceValue::Elevation, progress);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(z[i], 3 * places[i].x - 4 * places[i].y + 7, 1e-12);
  EXPECT_TRUE(std::isnan(z[4]));
  EXPECT_TRUE(std::isnan(z[5]));
  EXPECT_NEAR(sampler.sample(places, SurfaceValue::Slope, progress)[1], std::atan(5.0) * 180 / M_PI, 1e-12);
  // Falls towards (-3, 4): north-west, clockwise from north.
  EXPECT_NEAR(sampler.sample(places, SurfaceValue::Aspect, progress)[1], 360 - std::atan2(3, 4) * 180 / M_PI,
              1e-12);
}

// Within a cell whose diagonal rises to the right, u v at its corners becomes the lower of u and v.
TEST(SampleSurface, SaddleByItsFormula) {
  const Tin tin = grid_tin(9, 9, [](double x, double y) { return (x - 4) * (y - 4); });
  const SurfaceSampler sampler(tin, {});
  std::vector<Point2> places;
  for (double x = 0.125; x < 8; x += 0.25) {
    for (double y = 0.0625; y < 8; y += 0.25) places.push_back({x, y});
  }
  const std::vector<double> z = sampler.sample(places, SurfaceValue::Elevation, Progress());
  const std::vector<double> slope = sampler.sample(places, SurfaceValue::Slope, Progress());
  const std::vector<double> aspect = sampler.sample(places, SurfaceValue::Aspect, Progress());
  for (std::size_t i = 0; i < places.size(); ++i) {
    const double left = std::floor(places[i].x), lower = std::floor(places[i].y);
    const double u = places[i].x - left, v = places[i].y - lower;
    EXPECT_NEAR(z[i], (places[i].x - 4) * (places[i].y - 4) - u * v + std::min(u, v), 1e-13);
    const double by_x = lower - 4 + (v > u ? 1 : 0), by_y = left - 4 + (v > u ? 0 : 1);
    EXPECT_NEAR(slope[i], std::atan(std::hypot(by_x, by_y)) * 180 / M_PI, 1e-12);
    if (by_x == 0 && by_y == 0) {
      EXPECT_TRUE(std::isnan(aspect[i]));
    } else {
      const double bearing = std::atan2(-by_x, -by_y) * 180 / M_PI;
      EXPECT_NEAR(aspect[i], bearing < 0 ? bearing + 360 : bearing, 1e-12);
    }
  }
}

// Bounds: a chord's plane is within R^2 / 2 of the largest curvature, 2 / r, and below a concave surface (R,
// the circle's radius, is the root of 1/2); each slope along an axis is the surface's own somewhere on a
// side.
TEST(SampleSurface, ConeByItsFormula) {
  constexpr double kMiddle = 30, kFall = 2;
  const Tin tin =
      grid_tin(61, 61, [](double x, double y) { return 100 - kFall * std::hypot(x - kMiddle, y - kMiddle); });
  const SurfaceSampler sampler(tin, {});
  std::vector<Point2> places;
  for (double angle = 0.01; angle < 6.28; angle += 0.1) {
    for (double r = 8; r < 29; r += 0.7) {
      places.push_back({kMiddle + r * std::sin(angle), kMiddle + r * std::cos(angle)});
    }
  }
  const std::vector<double> z = sampler.sample(places, SurfaceValue::Elevation, Progress());
  const std::vector<double> slope = sampler.sample(places, SurfaceValue::Slope, Progress());
  const std::vector<double> aspect = sampler.sample(places, SurfaceValue::Aspect, Progress());
  for (std::size_t i = 0; i < places.size(); ++i) {
    const double dx = places[i].x - kMiddle, dy = places[i].y - kMiddle, r = std::hypot(dx, dy);
    const double curvature = kFall / (r - std::sqrt(2.0));
    const double below = 100 - kFall * r - z[i];
    EXPECT_GE(below, -1e-12);
    EXPECT_LE(below, 0.25 * curvature);
    const double gradient_error = 2 * curvature;  // two axes, at most the root of 2 away
    EXPECT_NEAR(std::tan(slope[i] * M_PI / 180), kFall, gradient_error);
    const double bearing = std::atan2(dx, dy) * 180 / M_PI;
    EXPECT_LE(std::abs(std::remainder(aspect[i] - bearing, 360)),
              std::asin(gradient_error / kFall) * 180 / M_PI);
  }
}

TEST(SampleSurface, UnitsCount) {
  const Tin tin = grid_tin(3, 3, [](double x, double) { return x; });
  const Progress progress;
  const std::vector<Point2> places = {{0.6, 0.5}};
  const SurfaceSampler feet_high(tin, {.horizontal_metres_per_unit = 1, .vertical_metres_per_unit = 0.3048});
  EXPECT_NEAR(feet_high.sample(places, SurfaceValue::Slope, progress)[0], std::atan(0.3048) * 180 / M_PI,
              1e-12);
}

TEST(SampleSurface, ExactAtVertices) {
  const Tin tin = grid_tin(9, 8, [](double x, double y) { return 100.1 * std::sin(x) + std::cos(y) / 3; });
  const SurfaceSampler sampler(tin, {});
  const std::vector<double> z = sampler.sample(tin.points(), SurfaceValue::Elevation, Progress());
  for (std::size_t v = 0; v < tin.vertex_count(); ++v) EXPECT_EQ(z[v], tin.heights()[v]);
}

TEST(SampleSurface, LevelGroundHasNoAspectAndTheShadeOfTheSunsHeight) {
  const Tin tin = grid_tin(3, 3, [](double, double) { return 5; });
  const SurfaceSampler sampler(tin, {});
  const std::vector<Point2> places = {{0.5, 0.25}};
  EXPECT_TRUE(std::isnan(sampler.sample(places, SurfaceValue::Aspect, Progress())[0]));
  EXPECT_EQ(sampler.sample(places, SurfaceValue::Hillshade, Progress())[0],
            1 + std::round(254 * std::sqrt(0.5)));
}

TEST(SampleSurface, LightComesFromTheNorthWest) {
  const Progress progress;
  const std::vector<Point2> places = {{0.6, 0.5}};
  const Tin towards = grid_tin(3, 3, [](double x, double y) { return x - y; });
  const Tin away = grid_tin(3, 3, [](double x, double y) { return y - x; });
  EXPECT_GT(SurfaceSampler(towards, {}).sample(places, SurfaceValue::Hillshade, progress)[0], 240);
  EXPECT_LT(SurfaceSampler(away, {}).sample(places, SurfaceValue::Hillshade, progress)[0], 10);
}

}  // namespace
}  // namespace thalweg
