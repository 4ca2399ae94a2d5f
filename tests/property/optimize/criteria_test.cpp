// Every criterion, alone and before every other one, against all first-order triangulations.
#include "support/first_order_scene.hpp"
#include "support/plain_criteria.hpp"
#include "support/plain_fill.hpp"

#include <thalweg/optimize/optimize.hpp>

#include <gtest/gtest.h>

#include <map>

namespace thalweg::test {
namespace {

constexpr double kHorizontal = 2, kVertical = 0.5;

using Labels = std::vector<std::uint8_t>;

struct Enumerated {
  std::vector<std::map<std::string, Steps>>
      values;  // of each labelling, bit q of its index for quadrilateral q
};

/// All but those that are measured against heights from elsewhere.
std::vector<CriterionTraits> criteria_of_the_tin() {
  std::vector<CriterionTraits> chosen;
  for (const CriterionTraits& traits : all_criteria()) {
    if (!Objective(traits.criterion).needs_reference()) chosen.push_back(traits);
  }
  return chosen;
}

std::map<std::string, Steps> values_of(const Tin& tin) {
  const PlainCriteria plain(tin, kHorizontal, kVertical);
  std::map<std::string, Steps> values;
  for (const CriterionTraits& traits : criteria_of_the_tin()) {
    const std::string name(traits.name);
    values[name] = plain.value(name);
  }
  return values;
}

Enumerated enumerate(const Scene& scene) {
  Enumerated all;
  const std::size_t count = scene.quadrilaterals.size();
  for (std::size_t bits = 0; bits < std::size_t{1} << count; ++bits) {
    Labels flipped;
    for (std::size_t q = 0; q < count; ++q) flipped.push_back(static_cast<std::uint8_t>(bits >> q & 1U));
    all.values.push_back(values_of(with_diagonals(scene.tin, scene.quadrilaterals, flipped)));
  }
  return all;
}

double in_units(Steps steps, const CriterionTraits& traits) {
  const double value = static_cast<double>(steps) / 0x1p32;
  return traits.direction == Direction::Maximise ? -value : value;
}

void expect_line(const CriterionResult& line, const CriterionTraits& traits, Steps delaunay, Steps best) {
  EXPECT_DOUBLE_EQ(line.delaunay, in_units(delaunay, traits));
  EXPECT_DOUBLE_EQ(line.result, in_units(best, traits));
  EXPECT_DOUBLE_EQ(line.bound, in_units(best, traits));
  EXPECT_TRUE(line.optimal);
}

void check_pair(const Scene& scene, const Enumerated& all, const CriterionTraits& first,
                const CriterionTraits& second) {
  const std::string one(first.name), two(second.name);
  SCOPED_TRACE(one + "," + two);
  Progress progress;
  std::vector<Objective> criteria{first.criterion};
  if (one != two) criteria.emplace_back(second.criterion);
  const OptimizeResult result = optimize_first_order(scene.tin, scene.quadrilaterals,
                                                     {.criteria = criteria,
                                                      .horizontal_metres_per_unit = kHorizontal,
                                                      .vertical_metres_per_unit = kVertical},
                                                     progress);
  std::pair<Steps, Steps> best{all.values.front().at(one), all.values.front().at(two)};
  for (const auto& values : all.values) best = std::min(best, {values.at(one), values.at(two)});
  std::size_t chosen = 0;
  for (std::size_t q = 0; q < result.flipped.size(); ++q) chosen |= std::size_t{result.flipped[q]} << q;
  const auto& got = all.values[chosen];
  expect_line(result.criteria[0], first, all.values.front().at(one), best.first);
  EXPECT_TRUE(got.at(one) == best.first);
  if (criteria.size() < 2) return;
  expect_line(result.criteria[1], second, all.values.front().at(two), best.second);
  EXPECT_TRUE(got.at(two) == best.second);
}

#ifdef THALWEG_MANY_SCENES
constexpr int kScenes = 200, kPairScenes = 40;
constexpr std::size_t kQuadrilaterals = 11, kMostQuadrilaterals = 16;
#else
constexpr int kScenes = 100, kPairScenes = 100;
constexpr std::size_t kQuadrilaterals = 8, kMostQuadrilaterals = 8;
#endif

TEST(Criteria, LeastDepthLeavesTheLeastWaterOnEveryVertex) {
  Random random;
  SCOPED_TRACE(random.trace());
  std::size_t lowered = 0;
  for (int i = 0; i < scene_count(kPairScenes) && !HasFailure(); ++i) {
    const Scene scene = random_scene(random, kQuadrilaterals, random.integer(2, 12), i % 3 == 0);
    SCOPED_TRACE("scene " + std::to_string(i));
    const std::size_t count = scene.quadrilaterals.size();
    const auto levels_of = [&](const Labels& flipped) {
      return fill_levels(with_diagonals(scene.tin, scene.quadrilaterals, flipped));
    };
    const std::vector<double> delaunay = levels_of(Labels(count, 0));
    std::vector<double> least = delaunay;
    for (std::size_t bits = 1; bits < std::size_t{1} << count; ++bits) {
      Labels flipped;
      for (std::size_t q = 0; q < count; ++q) flipped.push_back(static_cast<std::uint8_t>(bits >> q & 1U));
      const std::vector<double> levels = levels_of(flipped);
      for (std::size_t v = 0; v < levels.size(); ++v) least[v] = std::min(least[v], levels[v]);
    }
    lowered += least == delaunay ? 0 : 1;
    for (const Criterion second : {Criterion::NormalAngleSum, Criterion::EdgeLength, Criterion::MinAngle}) {
      Progress progress;
      const OptimizeResult result = optimize_first_order(
          scene.tin, scene.quadrilaterals, {.criteria = {Criterion::PitDepth, second}}, progress);
      EXPECT_EQ(levels_of(result.flipped), least);
    }
  }
  EXPECT_GT(lowered, 0U);
}

TEST(Criteria, AloneAndInPairsAreTheBestOfAll) {
  Random random;
  SCOPED_TRACE(random.trace());
  for (int i = 0; i < scene_count(kPairScenes) && !HasFailure(); ++i) {
    const bool lattice = i % 3 == 0;
    const std::size_t limit =
        lattice ? kMostQuadrilaterals : random.integer<std::size_t>(4, kMostQuadrilaterals);
    const Scene scene = random_scene(random, limit, random.integer(2, 6), lattice);
    SCOPED_TRACE("scene " + std::to_string(i));
    const Enumerated all = enumerate(scene);
    for (const CriterionTraits& first : criteria_of_the_tin()) {
      for (const CriterionTraits& second : criteria_of_the_tin()) check_pair(scene, all, first, second);
    }
  }
}

TEST(Criteria, WeightedSumsAreTheBestOfAll) {
  Random random;
  SCOPED_TRACE(random.trace());
  for (int i = 0; i < kScenes && !HasFailure(); ++i) {
    const Scene scene = random_scene(random, kQuadrilaterals, random.integer(2, 6));
    const Objective objective =
        parse_objective("2*edge-length+0.5*normal-angle-sum-convex-edges+3*mixed-vertices");
    Progress progress;
    const OptimizeResult result = optimize_first_order(scene.tin, scene.quadrilaterals,
                                                       {.criteria = {objective},
                                                        .horizontal_metres_per_unit = kHorizontal,
                                                        .vertical_metres_per_unit = kVertical},
                                                       progress);
    double least = std::numeric_limits<double>::infinity();
    for (const auto& values : enumerate(scene).values) {
      least = std::min(least, (2 * static_cast<double>(values.at("edge-length")) +
                               0.5 * static_cast<double>(values.at("normal-angle-sum")) +
                               static_cast<double>(values.at("convex-edges")) +
                               3 * static_cast<double>(values.at("mixed-vertices"))) /
                                  0x1p32);
    }
    EXPECT_NEAR(result.criteria[0].result, least, 1e-6);
    EXPECT_TRUE(result.criteria[0].optimal);
  }
}

/// With tables too narrow for most scenes, and for most stars: value and bound enclose the optimum, and the
/// value is true; also that of what comes next, whose bound counts where the first is optimal.
TEST(Criteria, OfVerticesAreEnclosed) {
  Random random;
  SCOPED_TRACE(random.trace());
  std::map<std::string, int> improved, optimal;
  for (int i = 0; i < kScenes && !HasFailure(); ++i) {
    const Scene scene = random_scene(random, kQuadrilaterals, 60);
    const Enumerated all = enumerate(scene);
    for (const CriterionTraits& traits : all_criteria()) {
      if (traits.coupling != Coupling::VertexStar) continue;
      const std::string name(traits.name);
      Steps best = all.values.front().at(name);
      for (const auto& values : all.values) best = std::min(best, values.at(name));
      improved[name] += best < all.values.front().at(name) ? 1 : 0;
      Progress progress;
      const OptimizeResult result =
          optimize_first_order(scene.tin, scene.quadrilaterals,
                               {.criteria = {traits.criterion, Criterion::EdgeLength},
                                .horizontal_metres_per_unit = kHorizontal,
                                .vertical_metres_per_unit = kVertical,
                                .width_limit = 1 + static_cast<std::uint32_t>(i % 2)},
                               progress);
      std::size_t chosen = 0;
      for (std::size_t q = 0; q < result.flipped.size(); ++q) chosen |= std::size_t{result.flipped[q]} << q;
      const double sign = traits.direction == Direction::Maximise ? -1 : 1;
      const CriterionResult& line = result.criteria[0];
      EXPECT_DOUBLE_EQ(line.result, in_units(all.values[chosen].at(name), traits)) << name;
      EXPECT_LE(sign * line.bound, sign * in_units(best, traits)) << name;
      EXPECT_GE(sign * line.result, sign * in_units(best, traits)) << name;
      EXPECT_EQ(line.optimal, line.bound == line.result);
      optimal[name] += line.optimal ? 1 : 0;
      Steps next = std::numeric_limits<Steps>::max();
      for (const auto& values : all.values) {
        if (values.at(name) == best) next = std::min(next, values.at("edge-length"));
      }
      const CriterionResult& second = result.criteria[1];
      const CriterionTraits& length = traits_of(Criterion::EdgeLength);
      EXPECT_DOUBLE_EQ(second.result, in_units(all.values[chosen].at("edge-length"), length)) << name;
      if (line.optimal) {
        EXPECT_LE(second.bound, in_units(next, length)) << name;
      }
      EXPECT_EQ(second.optimal, line.optimal && second.bound == second.result);
    }
  }
  for (const auto& [name, count] : improved) EXPECT_GT(count, 0) << name;
  for (const auto& [name, count] : optimal) EXPECT_GT(count, kScenes / 4) << name;
}

TEST(Criteria, AreReadFromText) {
  EXPECT_EQ(parse_objective("local-minima").name(), "local-minima");
  EXPECT_EQ(parse_objective("2*edge-length+0.5*normal-angle-sum-convex-edges").name(),
            "2*edge-length+0.5*normal-angle-sum-1*convex-edges");
  EXPECT_EQ(parse_objective("1e-3*edge-length").parts.front().weight, 1e-3);
  for (const char* bad : {"", "edge", "0*edge-length", "x*edge-length", "2*local-minima", "2*max-area",
                          "edge-length+edge-length", "edge-length+"}) {
    EXPECT_ANY_THROW(parse_objective(bad)) << bad;
  }
}

}  // namespace
}  // namespace thalweg::test
