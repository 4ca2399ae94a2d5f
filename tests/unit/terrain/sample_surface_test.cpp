// Sampling against planes, and at vertices.
#include "terrain_scene.hpp"

#include <thalweg/terrain/sample_surface.hpp>

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
