// The optimiser of higher orders on small scenes against all their triangulations, valued by plain code.
#include "support/face_scenes.hpp"

#include <thalweg/order/quadrilaterals.hpp>

#include <algorithm>
#include <array>
#include <set>
#include <string>

namespace thalweg {
namespace {

using oracle::Oracle;
using test::better;
using test::expect_line;
using test::kHorizontal;
using test::kSmallFaces;
using test::kTolerance;
using test::kVertical;
using test::Steps;
using test::Terrain;
using test::terrain_of;
using test::tin_of;
using test::value_of;

void check(const Terrain& terrain, const std::vector<Criterion>& criteria) {
  Progress progress;
  const FaceOptimizeResult result = optimize_faces(terrain.tin, terrain.faces,
                                                   {.common = {.criteria = {criteria.begin(), criteria.end()},
                                                               .horizontal_metres_per_unit = kHorizontal,
                                                               .vertical_metres_per_unit = kVertical}},
                                                   progress);
  const Tin tin = tin_of(terrain, result);
  const auto got = value_of(tin, criteria);
  bool is_one_of_all = false;
  for (const Tin& other : terrain.triangulations) {
    ASSERT_FALSE(better(value_of(other, criteria), got));
    is_one_of_all = is_one_of_all || std::ranges::equal(other.triangles(), tin.triangles());
  }
  ASSERT_TRUE(is_one_of_all);
  const auto delaunay = value_of(terrain.tin, criteria);
  for (std::size_t i = 0; i < criteria.size(); ++i) expect_line(result.criteria[i], delaunay[i], got[i]);
}

/// Fewest pits, then the least sum of orders, then the least sum of angles.
void check_least_orders(const Terrain& terrain) {
  Progress progress;
  const FaceOptimizeResult result =
      optimize_faces(terrain.tin, terrain.faces,
                     {.common = {.criteria = {Criterion::LocalMinima, Criterion::NormalAngleSum},
                                 .horizontal_metres_per_unit = kHorizontal,
                                 .vertical_metres_per_unit = kVertical},
                      .order_sum_after = 1},
                     progress);
  const Tin tin = tin_of(terrain, result);
  Steps order_sum = 0;
  for (const OrderTriangle& t : result.triangles) order_sum += t.order;
  const auto with_orders = [&](const Tin& of, Steps sum) {
    auto value = value_of(of, {Criterion::LocalMinima, Criterion::NormalAngleSum});
    value.insert(value.begin() + 1, sum << 32U);
    return value;
  };
  const auto got = with_orders(tin, order_sum);
  for (std::size_t i = 0; i < terrain.triangulations.size(); ++i) {
    ASSERT_FALSE(better(with_orders(terrain.triangulations[i], terrain.order_sums[i]), got));
  }
  ASSERT_EQ(result.criteria.size(), 3U);
  EXPECT_EQ(result.criteria[1].name, "order-sum");
  expect_line(result.criteria[1], 0, got[1]);
}

/// With so little work allowed that not all triangulations of a face are chosen from.
void check_partial(const Terrain& terrain, const std::vector<Criterion>& criteria,
                   std::size_t most_comparisons, std::size_t& partial_faces) {
  Progress progress;
  const FaceOptimizeResult result = optimize_faces(terrain.tin, terrain.faces,
                                                   {.common = {.criteria = {criteria.begin(), criteria.end()},
                                                               .horizontal_metres_per_unit = kHorizontal,
                                                               .vertical_metres_per_unit = kVertical},
                                                    .most_comparisons = most_comparisons,
                                                    .few_labels = 1},
                                                   progress);
  partial_faces += result.partial_faces;
  const Tin tin = tin_of(terrain, result);
  const auto is_result = [&](const Tin& other) {
    return std::ranges::equal(other.triangles(), tin.triangles());
  };
  ASSERT_TRUE(std::ranges::any_of(terrain.triangulations, is_result));
  const auto got = value_of(tin, criteria);
  const CriterionResult& first = result.criteria[0];
  const double sign = first.direction == "max" ? -1 : 1;
  for (const Tin& other : terrain.triangulations) {
    const auto value = value_of(other, criteria);
    ASSERT_LE(sign * first.bound * 0x1p32, static_cast<double>(value[0] + kTolerance)) << first.name;
    ASSERT_FALSE(result.criteria.back().optimal && better(value, got)) << first.name;
  }
}

const std::vector<std::vector<Criterion>> kPriorities = {
    {Criterion::LocalMinima},
    {Criterion::NormalAngleSum},
    {Criterion::NormalAngleMax},
    {Criterion::EdgeLength},
    {Criterion::MaxAngle},
    {Criterion::LocalMinima, Criterion::NormalAngleSum},
    {Criterion::NormalAngleSum, Criterion::LocalMinima},
    {Criterion::LocalMinima, Criterion::NormalAngleMax, Criterion::EdgeLength},
    {Criterion::ConvexEdges, Criterion::MinAngle, Criterion::LocalMinima},
    {Criterion::ValleyTriangles, Criterion::DrainingValleys},
    {Criterion::LocalMinima, Criterion::DrainingValleys, Criterion::ValleyTriangles},
};

TEST(OptimizeFaces, IsTheBestOfAll) {
  int number = 0;
  std::array<std::size_t, 2> partial_faces{};
  for_each_scene(oracle::kStreams, 60, kSmallFaces, [&](const Oracle& oracle) {
    oracle::Dice dice("optimize-faces-" + std::to_string(number++));
    const int levels = dice.between(2, 7);
    std::vector<double> heights;
    for (int v = 0; v < oracle.scene().size(); ++v) heights.push_back(dice.between(0, levels - 1));
    const oracle::Enumeration all = enumerate(oracle);
    for (int k = 0; k <= 4; ++k) {
      const auto definition = kOrderDefinitions[static_cast<std::size_t>(dice.between(0, 7))];
      const auto terrain = terrain_of(oracle, all, definition, k, heights);
      if (!terrain) continue;
      for (const auto& criteria : kPriorities) {
        if (definition != OrderDefinition::Std) {
          ASSERT_NO_FATAL_FAILURE(check_least_orders(*terrain)) << definition_name(definition) << " " << k;
          for (const std::size_t most : {0U, 20U}) {  // nothing; enough for most faces, at second sight
            ASSERT_NO_FATAL_FAILURE(check_partial(*terrain, criteria, most, partial_faces[most == 0 ? 0 : 1]))
                << definition_name(definition) << " " << k;
          }
        }
        ASSERT_NO_FATAL_FAILURE(check(*terrain, criteria)) << definition_name(definition) << " " << k;
        ASSERT_FALSE(testing::Test::HasFailure()) << definition_name(definition) << " " << k;
      }
    }
  });
  EXPECT_GT(partial_faces[0], 2 * partial_faces[1]);
  EXPECT_GT(partial_faces[1], 100U);
}

/// Without triangles that are neither of the ground nor of a first-order quadrilateral's other diagonal.
std::optional<Terrain> flips_of(Terrain&& all, OrderDefinition definition, GroundMode mode) {
  Progress progress;
  std::set<Triangle> flips;
  std::vector<OrderTriangle> triangles;
  const auto add = [&](Triangle corners, std::uint32_t order) {
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    if (flips.insert(corners).second) triangles.push_back({corners, order});
  };
  for (const Triangle& corners : all.tin.triangles()) add(corners, 0);
  for (const Quadrilateral& q :
       find_quadrilaterals(all.tin, {.definition = definition, .mode = mode}, progress)) {
    add({q.s, q.u, q.t}, 1);
    add({q.t, q.v, q.s}, 1);
  }
  std::sort(triangles.begin(), triangles.end());
  auto faces = find_fixed_faces(all.tin, std::move(triangles), {}, progress);
  if (!faces) return std::nullopt;
  std::erase_if(all.triangulations, [&](const Tin& tin) {
    return std::ranges::any_of(tin.triangles(), [&](Triangle corners) {
      std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
      return !flips.contains(corners);
    });
  });
  all.faces = std::move(*faces);
  return std::move(all);
}

TEST(OptimizeFaces, IsTheBestOfFlipsThatOverlap) {
  int number = 0;
  std::size_t fewer = 0;
  for_each_scene(oracle::kStreams, 30, kSmallFaces, [&](const Oracle& oracle) {
    oracle::Dice dice("optimize-flips-" + std::to_string(number++));
    std::vector<double> heights;
    for (int v = 0; v < oracle.scene().size(); ++v) heights.push_back(dice.between(0, 4));
    const oracle::Enumeration all = enumerate(oracle);
    for (const OrderDefinition definition : {OrderDefinition::Sees3vtx, OrderDefinition::EmptyQuad}) {
      auto terrain = terrain_of(oracle, all, definition, 1, heights);
      if (!terrain) continue;
      const std::size_t count = terrain->triangulations.size();
      terrain = flips_of(std::move(*terrain), definition, test::mode_of(oracle.scene()));
      ASSERT_TRUE(terrain);
      fewer += terrain->triangulations.size() < count ? 1 : 0;
      for (const auto& criteria : kPriorities) {
        ASSERT_NO_FATAL_FAILURE(check(*terrain, criteria)) << definition_name(definition);
        ASSERT_FALSE(testing::Test::HasFailure()) << definition_name(definition);
      }
    }
  });
  EXPECT_GT(fewer, 0U);
}

}  // namespace
}  // namespace thalweg
