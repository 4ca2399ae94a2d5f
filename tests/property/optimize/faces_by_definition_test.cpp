// Every definition, every order up to 4, five criteria one by one: the optimum over faces is that of all
// triangulations, and the orders of its triangles are those that the oracle counts.
// THALWEG_SCENES: scenes of each of the five streams.
#include "support/face_scenes.hpp"
#include "support/first_order_scene.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <string>
#include <vector>

namespace thalweg {
namespace {

using oracle::Oracle;
using test::Steps;

constexpr std::array kCriteria = {Criterion::LocalMinima, Criterion::NormalAngleSum,
                                  Criterion::NormalAngleMax, Criterion::EdgeLength, Criterion::MaxAngle};
constexpr std::size_t kDefinitions = 6;  // std ... sees-opp
constexpr int kMostOrder = 4;

using Values = std::array<Steps, kCriteria.size()>;

Values values_of(const Tin& tin) {
  const test::PlainCriteria plain(tin, test::kHorizontal, test::kVertical);
  Values values{};
  for (std::size_t c = 0; c < values.size(); ++c) {
    values[c] = plain.value(std::string(traits_of(kCriteria[c]).name));
  }
  return values;
}

/// A scene with heights, and what all its triangulations are worth.
struct ValuedScene {
  const Oracle& oracle;
  oracle::Enumeration all;
  Tin ground;
  std::vector<Values> values;  ///< of each triangulation, of those that have order 4 somewhere

  ValuedScene(const Oracle& of, const std::vector<double>& heights)
      : oracle(of), all(enumerate(of)), ground(test::ground_of(of.scene())) {
    ground = test::with_heights(ground, {ground.triangles().begin(), ground.triangles().end()}, heights);
    values.resize(all.members.size());
    for (const std::size_t i : all.of_order(oracle::Definition::SeesOpp, kMostOrder)) {
      std::vector<Triangle> triangles;
      for (const int t : all.members[i]) {
        triangles.push_back(test::triangle(all.triangles[static_cast<std::size_t>(t)]));
      }
      values[i] = values_of(test::with_heights(ground, std::move(triangles), heights));
    }
  }
};

void expect_orders(const ValuedScene& scene, const FaceOptimizeResult& result, std::size_t definition,
                   int k) {
  for (const OrderTriangle& t : result.triangles) {
    oracle::Corners corners{};
    for (std::size_t i = 0; i < 3; ++i) corners[i] = static_cast<int>(t.corners[i].index());
    std::sort(corners.begin(), corners.end());
    const auto at = std::find_if(scene.all.triangles.begin(), scene.all.triangles.end(), [&](auto other) {
      std::sort(other.begin(), other.end());
      return other == corners;
    });
    ASSERT_NE(at, scene.all.triangles.end());
    const auto index = static_cast<std::size_t>(at - scene.all.triangles.begin());
    ASSERT_EQ(static_cast<int>(t.order), scene.all.orders[index][definition]);
    ASSERT_LE(static_cast<int>(t.order), k);
  }
}

void check(const ValuedScene& scene, std::size_t definition, int k) {
  Progress progress;
  const ConstrainedOrder order(scene.ground, test::mode_of(scene.oracle.scene()));
  const auto faces = find_fixed_faces(
      scene.ground,
      find_order_triangles(
          order, {.definition = kOrderDefinitions[definition], .max_order = static_cast<std::size_t>(k)},
          progress),
      {}, progress);
  const std::vector<std::size_t> members = scene.all.of_order(static_cast<oracle::Definition>(definition), k);
  ASSERT_EQ(faces.has_value(), !members.empty());
  if (!faces) return;
  for (std::size_t c = 0; c < kCriteria.size(); ++c) {
    const FaceOptimizeResult result =
        optimize_faces(scene.ground, *faces,
                       {.common = {.criteria = {kCriteria[c]},
                                   .horizontal_metres_per_unit = test::kHorizontal,
                                   .vertical_metres_per_unit = test::kVertical}},
                       progress);
    ASSERT_NO_FATAL_FAILURE(expect_orders(scene, result, definition, k));
    Steps best = std::numeric_limits<Steps>::max();
    for (const std::size_t i : members) best = std::min(best, scene.values[i][c]);
    test::Terrain terrain{scene.ground, {}, {}, {}};
    const Steps got = values_of(test::tin_of(terrain, result))[c];
    EXPECT_NEAR(static_cast<double>(got), static_cast<double>(best), test::kTolerance);
    test::expect_line(result.criteria[0], values_of(scene.ground)[c], got);
  }
}

TEST(OptimizeFaces, IsTheBestUnderEachDefinition) {
  int number = 0;
  std::size_t problems = 0;
  for_each_scene(oracle::kStreams, test::scene_count(60), test::kSmallFaces, [&](const Oracle& oracle) {
    oracle::Dice dice("optimize-by-definition-" + std::to_string(number++));
    const int levels = dice.between(2, 7);
    std::vector<double> heights;
    for (int v = 0; v < oracle.scene().size(); ++v) heights.push_back(dice.between(0, levels - 1));
    const ValuedScene scene(oracle, heights);
    for (std::size_t definition = 0; definition < kDefinitions; ++definition) {
      for (int k = 0; k <= kMostOrder; ++k) {
        ASSERT_NO_FATAL_FAILURE(check(scene, definition, k))
            << definition_name(kOrderDefinitions[definition]) << " " << k;
        ASSERT_FALSE(testing::Test::HasFailure())
            << definition_name(kOrderDefinitions[definition]) << " " << k;
        problems += kCriteria.size();
      }
    }
  });
  RecordProperty("problems", static_cast<int>(problems));
}

}  // namespace
}  // namespace thalweg
