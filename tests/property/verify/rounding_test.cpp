// Values where another correct rounding changes much: the verifier knows by how much.
#include "support/random.hpp"
#include "verify/plain_criteria.hpp"

#include <thalweg/delaunay/triangulate.hpp>
#include <thalweg/optimize/optimize.hpp>
#include <thalweg/order/quadrilaterals.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <vector>

namespace thalweg::test {
namespace {

/// A few points on a line but for some of the last bits of their coordinates, and some beside it.
Tin slivers(Random& random) {
  std::set<Point2> places;
  const auto bits = [&random] { return static_cast<double>(random.integer(-8, 8)) * 0x1p-50; };
  const int count = random.integer(3, 7);
  for (int i = 0; i < count; ++i) {
    const double along = random.integer(0, 12) + 1.0 / 3;
    places.insert({along + bits(), 0.7 * along + bits()});
  }
  for (int i = 0; i < 3; ++i) places.insert({random.real(-20, 30), random.real(-20, 30)});
  const std::vector<Point2> points(places.begin(), places.end());
  std::vector<double> heights;
  for (std::size_t i = 0; i < points.size(); ++i) heights.push_back(random.integer(0, 5));
  Progress progress;
  return triangulate(points, heights, {}, progress);
}

verify::PlainMesh plain(const Tin& tin) {
  verify::PlainMesh mesh;
  mesh.xy.assign(tin.points().begin(), tin.points().end());
  mesh.z.assign(tin.heights().begin(), tin.heights().end());
  for (const Triangle& t : tin.triangles()) {
    mesh.triangles.push_back({t[0].value(), t[1].value(), t[2].value()});
  }
  EXPECT_FALSE(verify::link_sides(mesh));
  return mesh;
}

TEST(VerifyRounding, ValuesOfSliversAgreeWithinWhatRoundingMayChange) {
  Random random;
  std::size_t further = 0;  // than 1e-9, so that the test does look at such values
  for (int scene = 0; scene < 400; ++scene) {
    const Tin tin = slivers(random);
    const verify::PlainMesh mesh = plain(tin);
    Progress progress;
    for (const Criterion criterion :
         {Criterion::NormalAngleSum, Criterion::NormalAngleSquares, Criterion::NormalAngleMax,
          Criterion::AreaRatioMax, Criterion::AreaRatioSum}) {
      const std::vector<Objective> criteria{Objective(criterion)};
      const auto quadrilaterals = find_quadrilaterals(tin, {}, progress);
      const CriterionResult line =
          optimize_first_order(tin, quadrilaterals, {.criteria = criteria}, progress).criteria.front();
      const auto found = verify::value_of(mesh, {}, *verify::plain_criterion(line.name, nullptr));
      const auto difference = std::abs(static_cast<long double>(line.delaunay) - found.value);
      EXPECT_LE(difference, found.tolerance) << line.name << ", scene " << scene;
      further += difference > 1e-9L * (1 + std::abs(found.value)) ? 1 : 0;
    }
  }
  EXPECT_GT(further, 20U);
}

TEST(VerifyRounding, ValuesOfPlainTrianglesAreHeldToTheLastSteps) {
  Random random;
  std::vector<Point2> points;
  std::vector<double> heights;
  for (int i = 0; i < 400; ++i) {
    points.push_back({i % 20 + random.real(-0.3, 0.3), i / 20 + random.real(-0.3, 0.3)});
    heights.push_back(random.real(0, 3));
  }
  Progress progress;
  const verify::PlainMesh mesh = plain(triangulate(points, heights, {}, progress));
  const auto sum = verify::value_of(mesh, {}, *verify::plain_criterion("normal-angle-sum", nullptr));
  EXPECT_LT(sum.tolerance, 1e-6L);
  const auto most = verify::value_of(mesh, {}, *verify::plain_criterion("normal-angle-max", nullptr));
  EXPECT_LT(most.tolerance, 1e-8L);
}

}  // namespace
}  // namespace thalweg::test
