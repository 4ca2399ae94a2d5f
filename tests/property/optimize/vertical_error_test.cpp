// Vertical error alone, before and after another criterion, against all first-order triangulations.
#include "support/first_order_scene.hpp"
#include "support/plain_criteria.hpp"
#include "support/plain_vertical_error.hpp"

#include <thalweg/optimize/optimize.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>

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

/// Of one labelling, less is better.
struct Values {
  double error = 0;
  std::map<Criterion, double> other;
};

std::vector<CriterionTraits> other_criteria() {
  std::vector<CriterionTraits> others;
  for (const CriterionTraits& traits : all_criteria()) {
    if (!Objective(traits.criterion).needs_reference()) others.push_back(traits);
  }
  return others;
}

std::vector<Values> enumerate(const Scene& scene, std::span<const Mark> marks) {
  std::vector<Values> all;
  const std::size_t count = scene.quadrilaterals.size();
  for (std::size_t bits = 0; bits < std::size_t{1} << count; ++bits) {
    std::vector<std::uint8_t> flipped;
    for (std::size_t q = 0; q < count; ++q) flipped.push_back(static_cast<std::uint8_t>(bits >> q & 1U));
    const Tin tin = with_diagonals(scene.tin, scene.quadrilaterals, flipped);
    Values& values = all.emplace_back();
    values.error = static_cast<double>(plain_vertical_error(tin, marks, kVertical));
    const PlainCriteria plain(tin, 1, kVertical);
    for (const CriterionTraits& traits : other_criteria()) {
      values.other[traits.criterion] = static_cast<double>(plain.value(std::string(traits.name))) / 0x1p32;
    }
  }
  return all;
}

double value_of(const Values& values, Criterion criterion) {
  return criterion == Criterion::VerticalError ? values.error : values.other.at(criterion);
}

/// The least value of each criterion in turn among labellings with about the least of those before.
std::vector<double> best_of(std::span<const Values> all, std::span<const Criterion> criteria) {
  std::vector<double> best;
  std::vector<Values> left(all.begin(), all.end());
  for (const Criterion criterion : criteria) {
    double least = std::numeric_limits<double>::infinity();
    for (const Values& values : left) least = std::min(least, value_of(values, criterion));
    std::erase_if(left, [&](const Values& values) { return value_of(values, criterion) > least + kNear; });
    best.push_back(least);
  }
  return best;
}

void expect_best(const Scene& scene, const Reference& reference, const std::vector<Criterion>& criteria,
                 std::span<const Values> all) {
  Progress progress;
  const OptimizeResult result = optimize_first_order(scene.tin, scene.quadrilaterals,
                                                     {.criteria = {criteria.begin(), criteria.end()},
                                                      .vertical_metres_per_unit = kVertical,
                                                      .reference = &reference},
                                                     progress);
  std::size_t chosen = 0;
  for (std::size_t q = 0; q < result.flipped.size(); ++q) chosen |= std::size_t{result.flipped[q]} << q;
  const std::vector<double> best = best_of(all, criteria);
  for (std::size_t i = 0; i < criteria.size(); ++i) {
    const CriterionResult& line = result.criteria[i];
    const double sign = line.direction == "max" ? -1 : 1;
    EXPECT_NEAR(sign * line.delaunay, value_of(all.front(), criteria[i]), kNear) << line.name;
    EXPECT_NEAR(sign * line.result, best[i], kNear) << line.name;
    EXPECT_NEAR(sign * line.result, value_of(all[chosen], criteria[i]), kNear) << line.name;
    EXPECT_TRUE(line.optimal) << line.name;
  }
}

#ifdef THALWEG_MANY_SCENES
constexpr int kScenes = 40;
constexpr std::size_t kMostQuadrilaterals = 16;
#else
constexpr int kScenes = 60;
constexpr std::size_t kMostQuadrilaterals = 8;
#endif

TEST(VerticalError, AloneAndInPairsIsTheBestOfAll) {
  Random random;
  SCOPED_TRACE(random.trace());
  for (int i = 0; i < scene_count(kScenes) && !HasFailure(); ++i) {
    const bool lattice = i % 3 == 0;
    const std::size_t limit =
        lattice ? kMostQuadrilaterals : random.integer<std::size_t>(4, kMostQuadrilaterals);
    const Scene scene = random_scene(random, limit, random.integer(2, 6), lattice);
    SCOPED_TRACE("scene " + std::to_string(i));
    const std::vector<Mark> marks = random_marks(random);
    const Reference reference = reference_of(marks);
    const std::vector<Values> all = enumerate(scene, marks);
    expect_best(scene, reference, {Criterion::VerticalError}, all);
    for (const CriterionTraits& other : other_criteria()) {
      SCOPED_TRACE(other.name);
      expect_best(scene, reference, {Criterion::VerticalError, other.criterion}, all);
      expect_best(scene, reference, {other.criterion, Criterion::VerticalError}, all);
    }
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
