// Vertical error alone, before and after another criterion, against all first-order triangulations.
#include "support/first_order_scene.hpp"
#include "support/plain_criteria.hpp"
#include "support/plain_vertical_error.hpp"

#include <thalweg/optimize/optimize.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace thalweg::test {
namespace {

constexpr double kVertical = 0.5;
constexpr double kNear = 1e-6;  // far above what rounding of terms adds up to, far below what labels change

/// On and around the vertices of scenes, on edges and on the rim too.
std::vector<Mark> random_marks(Random& random) {
  std::vector<Mark> marks;
  for (int i = 0; i < 300; ++i) {
    const double shrink = i % 2 == 0 ? 1 : 6;  // lattices are small
    marks.push_back(
        {{std::floor(random.integer(-2, 62) / shrink), std::floor(random.integer(-2, 62) / shrink)},
         1.0 * random.integer(0, 9)});
  }
  return marks;
}

Reference reference_of(std::span<const Mark> marks) {
  std::vector<Point2> points;
  std::vector<double> heights;
  for (const Mark& mark : marks) {
    points.push_back(mark.at);
    heights.push_back(mark.height);
  }
  return {points, heights};
}

struct Values {
  double error, other;
};

std::vector<Values> enumerate(const Scene& scene, std::span<const Mark> marks, const std::string& other) {
  std::vector<Values> all;
  const std::size_t count = scene.quadrilaterals.size();
  for (std::size_t bits = 0; bits < std::size_t{1} << count; ++bits) {
    std::vector<std::uint8_t> flipped;
    for (std::size_t q = 0; q < count; ++q) flipped.push_back(static_cast<std::uint8_t>(bits >> q & 1U));
    const Tin tin = with_diagonals(scene.tin, scene.quadrilaterals, flipped);
    all.push_back({static_cast<double>(plain_vertical_error(tin, marks, kVertical)),
                   static_cast<double>(PlainCriteria(tin, 1, kVertical).value(other)) / 0x1p32});
  }
  return all;
}

/// The least second value among those with about the least first.
Values best_of(std::span<const Values> all, double Values::*first, double Values::*second) {
  Values best{};
  best.*first = best.*second = std::numeric_limits<double>::infinity();
  for (const Values& values : all) best.*first = std::min(best.*first, values.*first);
  for (const Values& values : all) {
    if (values.*first <= best.*first + kNear) best.*second = std::min(best.*second, values.*second);
  }
  return best;
}

CriterionResult expect_best(const Scene& scene, const Reference& reference, const Values& best,
                            const std::vector<Objective>& criteria, std::span<const Values> all) {
  Progress progress;
  const OptimizeResult result = optimize_first_order(
      scene.tin, scene.quadrilaterals,
      {.criteria = criteria, .vertical_metres_per_unit = kVertical, .reference = &reference}, progress);
  std::size_t chosen = 0;
  for (std::size_t q = 0; q < result.flipped.size(); ++q) chosen |= std::size_t{result.flipped[q]} << q;
  CriterionResult found;
  for (const CriterionResult& line : result.criteria) {
    const bool is_error = line.name == "vertical-error";
    if (is_error) found = line;
    EXPECT_NEAR(line.result, is_error ? best.error : best.other, kNear) << line.name;
    EXPECT_NEAR(line.result, is_error ? all[chosen].error : all[chosen].other, kNear) << line.name;
    EXPECT_TRUE(line.optimal) << line.name;
  }
  return found;
}

TEST(VerticalError, IsTheBestOfAll) {
  Random random;
  SCOPED_TRACE(random.trace());
  for (int i = 0; i < 100 && !HasFailure(); ++i) {
    const Scene scene = random_scene(random, 8, random.integer(2, 6));
    SCOPED_TRACE("scene " + std::to_string(i));
    const std::vector<Mark> marks = random_marks(random);
    const Reference reference = reference_of(marks);
    const std::vector<Values> sums = enumerate(scene, marks, "normal-angle-sum");
    const CriterionResult line = expect_best(scene, reference, best_of(sums, &Values::error, &Values::other),
                                             {Criterion::VerticalError, Criterion::NormalAngleSum}, sums);
    EXPECT_NEAR(line.delaunay, sums.front().error, kNear);
    expect_best(scene, reference, best_of(sums, &Values::error, &Values::other), {Criterion::VerticalError},
                sums);
    const std::vector<Values> pits = enumerate(scene, marks, "local-minima");
    expect_best(scene, reference, best_of(pits, &Values::other, &Values::error),
                {Criterion::LocalMinima, Criterion::VerticalError}, pits);
  }
}

// A law of the header: what triangles own and what is left on the rim is every point once, on any TIN.
TEST(VerticalError, CountsEveryPointOnce) {
  Random random;
  SCOPED_TRACE(random.trace());
  for (int i = 0; i < 100 && !HasFailure(); ++i) {
    const Scene scene = random_scene(random, 8, 2);
    const Tin flat(std::vector<Point2>(scene.tin.points().begin(), scene.tin.points().end()),
                   std::vector<double>(scene.tin.vertex_count(), 1.0),
                   std::vector<Triangle>(scene.tin.triangles().begin(), scene.tin.triangles().end()), {});
    std::vector<Mark> marks = random_marks(random);
    for (Mark& mark : marks) mark.height = 0;
    const Reference reference = reference_of(marks);
    Progress progress;
    double counted = reference.squares_left_on_rim(flat, progress);
    for (const Triangle& t : flat.triangles()) {
      counted += reference.squares({flat.point(t[0]), flat.point(t[1]), flat.point(t[2])}, {1, 1, 1});
    }
    EXPECT_DOUBLE_EQ(counted, static_cast<double>(plain_vertical_error(flat, marks, 1)));
  }
}

TEST(VerticalError, NeedsItsReference) {
  Random random;
  const Scene scene = random_scene(random, 8, 2);
  Progress progress;
  EXPECT_ANY_THROW(optimize_first_order(scene.tin, scene.quadrilaterals,
                                        {.criteria = {Criterion::VerticalError}}, progress));
}

}  // namespace
}  // namespace thalweg::test
