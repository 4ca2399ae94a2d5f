// The optimiser on small TINs against all their first-order triangulations, valued by plain code.
#include "support/first_order_scene.hpp"
#include "support/plain_surface.hpp"
#include "support/random.hpp"

#include <thalweg/optimize/optimize.hpp>
#include <thalweg/order/quadrilaterals.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace thalweg::test {
namespace {

constexpr double kTolerance = 1e-7;  // of a sum of some dozens of angles, each rounded to 2^-32

struct Values {
  std::vector<std::uint8_t> flipped;
  std::size_t pits = 0;
  double angles = 0;
  [[nodiscard]] auto flips() const { return std::count(flipped.begin(), flipped.end(), 1); }
};

Values value_of(const Scene& scene, std::vector<std::uint8_t> flipped) {
  const Tin tin = with_diagonals(scene.tin, scene.quadrilaterals, flipped);
  return {std::move(flipped), plain_pits(tin), plain_normal_angle_sum(tin, 2, 0.5)};
}

std::vector<Values> all_values(const Scene& scene) {
  std::vector<Values> values;
  const std::size_t count = scene.quadrilaterals.size();
  for (std::size_t bits = 0; bits < std::size_t{1} << count; ++bits) {
    std::vector<std::uint8_t> flipped;
    for (std::size_t q = 0; q < count; ++q) flipped.push_back(static_cast<std::uint8_t>(bits >> q & 1U));
    values.push_back(value_of(scene, std::move(flipped)));
  }
  return values;
}

std::size_t fewest_pits(const std::vector<Values>& values) {
  std::size_t fewest = std::numeric_limits<std::size_t>::max();
  for (const Values& v : values) fewest = std::min(fewest, v.pits);
  return fewest;
}

double least_angles(const std::vector<Values>& values) {
  double least = std::numeric_limits<double>::infinity();
  for (const Values& v : values) least = std::min(least, v.angles);
  return least;
}

OptimizeResult run(const Scene& scene, std::vector<Objective> criteria) {
  Progress progress;
  return optimize_first_order(
      scene.tin, scene.quadrilaterals,
      {.criteria = std::move(criteria), .horizontal_metres_per_unit = 2, .vertical_metres_per_unit = 0.5},
      progress);
}

void expect_line(const CriterionResult& line, double delaunay, double result, double bound) {
  EXPECT_NEAR(line.delaunay, delaunay, kTolerance) << line.name;
  EXPECT_NEAR(line.result, result, kTolerance) << line.name;
  EXPECT_NEAR(line.bound, bound, kTolerance) << line.name;
}

void expect_fewest_flips(const Values& got, const std::vector<Values>& values) {
  for (const Values& v : values) {
    const bool ties = v.pits == got.pits && std::abs(v.angles - got.angles) < kTolerance / 1000;
    EXPECT_TRUE(!ties || v.flips() >= got.flips());
  }
}

void check_scene(const Scene& scene) {
  std::vector<Values> values = all_values(scene);
  const Values delaunay = values.front();
  const double least = least_angles(values);
  const std::size_t fewest = fewest_pits(values);

  const OptimizeResult smooth = run(scene, {Criterion::NormalAngleSum});
  const Values smoothest = value_of(scene, smooth.flipped);
  expect_line(smooth.criteria[0], delaunay.angles, least, least);
  EXPECT_TRUE(smooth.criteria[0].optimal);
  EXPECT_NEAR(smoothest.angles, least, kTolerance);

  const OptimizeResult both = run(scene, {Criterion::NormalAngleSum, Criterion::LocalMinima});
  const Values smooth_first = value_of(scene, both.flipped);
  EXPECT_NEAR(smooth_first.angles, least, kTolerance);
  EXPECT_EQ(static_cast<double>(smooth_first.pits), both.criteria[1].result);
  EXPECT_EQ(both.criteria[1].bound, both.criteria[1].result);
  EXPECT_TRUE(both.criteria[1].optimal);
  for (const Values& v : values) {
    EXPECT_TRUE(v.angles > least + kTolerance / 1000 || v.pits >= smooth_first.pits);
  }

  const Values drained = value_of(scene, run(scene, {Criterion::LocalMinima}).flipped);
  EXPECT_EQ(drained.pits, fewest);
  for (const Values& v : values) {
    EXPECT_TRUE(v.pits > fewest || v.flips() >= drained.flips());
  }

  std::erase_if(values, [&](const Values& v) { return v.pits > fewest; });
  const OptimizeResult result = run(scene, {Criterion::LocalMinima, Criterion::NormalAngleSum});
  const Values got = value_of(scene, result.flipped);
  EXPECT_EQ(got.pits, fewest);
  EXPECT_NEAR(got.angles, least_angles(values), kTolerance);
  expect_line(result.criteria[0], static_cast<double>(delaunay.pits), static_cast<double>(fewest),
              static_cast<double>(fewest));
  expect_line(result.criteria[1], delaunay.angles, got.angles, got.angles);
  EXPECT_TRUE(result.criteria[0].optimal && result.criteria[1].optimal);
  expect_fewest_flips(got, values);
}

#ifdef THALWEG_MANY_SCENES
constexpr int kScenes = 20;
constexpr std::size_t kQuadrilaterals = 16;
#else
constexpr int kScenes = 500;
constexpr std::size_t kQuadrilaterals = 8;
#endif

TEST(FirstOrder, IsTheBestOfAll) {
  Random random;
  SCOPED_TRACE(random.trace());
  for (int i = 0; i < kScenes && !HasFailure(); ++i) {
    check_scene(random_scene(random, kQuadrilaterals, random.integer(2, 6)));
  }
}

}  // namespace
}  // namespace thalweg::test
