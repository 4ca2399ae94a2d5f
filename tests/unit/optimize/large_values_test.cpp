// Sums at higher orders that are larger than what the solvers' integers hold.
#include <thalweg/base/error.hpp>
#include <thalweg/delaunay/triangulate.hpp>
#include <thalweg/optimize/optimize_faces.hpp>
#include <thalweg/order/useful_triangles.hpp>

#include <gtest/gtest.h>
#include <support/random.hpp>

#include <vector>

namespace thalweg {
namespace {

TEST(LargeValues, OfEdgesAreBestAsSmallOnesAre) {
  constexpr std::size_t kPoints = 10000, kOrder = 2;
  constexpr double kSide = 1000, kLarge = 0x1p14;  // metres: 3 * 10^9 of edges, more than 2^63 steps
  test::Random random;
  SCOPED_TRACE(random.trace());
  std::vector<Point2> points;
  std::vector<double> heights;
  for (std::size_t i = 0; i < kPoints; ++i) {
    points.push_back({random.real(0, kSide), random.real(0, kSide)});
    heights.push_back(random.real(0, 10));
  }
  Progress progress;
  const Tin tin = triangulate(points, heights, {}, progress);
  const ConstrainedOrder order(tin);
  const auto faces =
      find_fixed_faces(tin, find_useful_triangles(order, {.max_order = kOrder}, progress), {}, progress);
  ASSERT_TRUE(faces);
  for (const std::vector<Objective>& criteria : std::vector<std::vector<Objective>>{
           {Criterion::EdgeLength}, {Criterion::LocalMinima, Criterion::EdgeLength}}) {
    const auto best = [&](double metres_per_unit) {
      return optimize_faces(tin, *faces,
                            {.common = {.criteria = criteria, .horizontal_metres_per_unit = metres_per_unit}},
                            progress);
    };
    const FaceOptimizeResult small = best(1), large = best(kLarge);
    EXPECT_TRUE(small.triangles == large.triangles);
    for (const CriterionResult& line : large.criteria) EXPECT_TRUE(line.optimal) << line.name;
    EXPECT_NEAR(large.criteria.back().result / kLarge, small.criteria.back().result, 1e-3);
  }
}

TEST(LargeValues, ThatOneFaceCannotAddAreRefused) {
  const std::vector<Point2> points = {{0, 0},     {9e8, 1e8}, {1e9, 9e8}, {1e8, 1e9},
                                      {4e8, 3e8}, {7e8, 6e8}, {3e8, 7e8}};
  Progress progress;
  const Tin tin = triangulate(points, std::vector<double>(points.size(), 0.0), {}, progress);
  const auto faces = find_fixed_faces(
      tin, find_useful_triangles(ConstrainedOrder(tin), {.max_order = 3}, progress), {}, progress);
  ASSERT_TRUE(faces);
  try {
    optimize_faces(tin, *faces, {.common = {.criteria = {Criterion::EdgeLength}}}, progress);
    ADD_FAILURE() << "not refused";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::SizeLimit) << error.what();
  }
}

}  // namespace
}  // namespace thalweg
