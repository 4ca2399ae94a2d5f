// The heuristics for few pits on small scenes against all triangulations, and on larger ones under other ids.
#include "support/face_scenes.hpp"
#include "support/random.hpp"

#include <thalweg/base/error.hpp>
#include <thalweg/delaunay/triangulate.hpp>
#include <thalweg/optimize/pit_heuristics.hpp>

#include <algorithm>
#include <array>
#include <numeric>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace thalweg {
namespace {

using oracle::Oracle;
using test::Steps;
using test::Terrain;

constexpr std::array kHeuristics = {PitHeuristic::Flip, PitHeuristic::Hull};
const std::vector<Criterion> kPriority = {Criterion::LocalMinima, Criterion::NormalAngleSum};

FaceOptimizeResult run(PitHeuristic heuristic, const Terrain& terrain) {
  Progress progress;
  return optimize_faces_by(heuristic, terrain.tin, terrain.faces,
                           {.common = {.criteria = {kPriority.begin(), kPriority.end()},
                                       .horizontal_metres_per_unit = test::kHorizontal,
                                       .vertical_metres_per_unit = test::kVertical}},
                           progress);
}

/// How many pits more than need be; the laws of remove_pits on the way.
std::size_t check(PitHeuristic heuristic, const Terrain& terrain) {
  const FaceOptimizeResult result = run(heuristic, terrain);
  const Tin tin = test::tin_of(terrain, result);
  const auto is_result = [&](const Tin& other) {
    return std::ranges::equal(other.triangles(), tin.triangles());
  };
  EXPECT_TRUE(std::ranges::any_of(terrain.triangulations, is_result));
  const std::vector<Steps> got = test::value_of(tin, kPriority),
                           delaunay = test::value_of(terrain.tin, kPriority);
  Steps fewest = got[0];
  for (const Tin& other : terrain.triangulations) {
    fewest = std::min(fewest, test::value_of(other, {Criterion::LocalMinima})[0]);
  }
  EXPECT_LE(got[0], delaunay[0]);
  bool proved = true;
  for (std::size_t i = 0; i < kPriority.size(); ++i) {
    const CriterionResult& line = result.criteria[i];
    constexpr double kNear = static_cast<double>(test::kTolerance) / 0x1p32;
    EXPECT_NEAR(line.delaunay, static_cast<double>(delaunay[i]) / 0x1p32, kNear);
    EXPECT_NEAR(line.result, static_cast<double>(got[i]) / 0x1p32, kNear);
    proved = proved && line.result == line.bound;
    EXPECT_EQ(line.optimal, proved);
  }
  EXPECT_EQ(result.criteria[0].bound, static_cast<double>(fewest) / 0x1p32);
  return static_cast<std::size_t>(result.criteria[0].result - result.criteria[0].bound);
}

TEST(PitHeuristics, KeepTheOrderAndMakeNoPit) {
  int number = 0;
  std::size_t removed = 0;
  std::array<std::size_t, 2> more{};
  for_each_scene(oracle::kStreams, 150, test::kSmallFaces, [&](const Oracle& oracle) {
    oracle::Dice dice("pit-heuristics-" + std::to_string(number++));
    const int levels = dice.between(2, 9);
    std::vector<double> heights;
    for (int v = 0; v < oracle.scene().size(); ++v) heights.push_back(dice.between(0, levels - 1));
    const oracle::Enumeration all = enumerate(oracle);
    for (int k = 1; k <= 4; ++k) {
      const auto definition = kOrderDefinitions[static_cast<std::size_t>(dice.between(1, 7))];
      const auto terrain = test::terrain_of(oracle, all, definition, k, heights);
      ASSERT_TRUE(terrain);
      for (std::size_t h = 0; h < kHeuristics.size(); ++h) {
        more[h] += check(kHeuristics[h], *terrain);
        const CriterionResult pits = run(kHeuristics[h], *terrain).criteria[0];
        removed += static_cast<std::size_t>(pits.delaunay - pits.result);
        ASSERT_FALSE(testing::Test::HasFailure()) << definition_name(definition) << " " << k << " " << h;
      }
    }
  });
  EXPECT_GT(removed, 100U);
  EXPECT_GT(more[0], 0U);  // it is a heuristic; hulls find the optimum in all scenes as small as these
}

/// Whole heights, so that plateaus occur.
struct Sample {
  std::vector<Point2> points;
  std::vector<double> heights;
};

Sample random_sample(test::Random& random, int count) {
  Sample sample;
  for (int i = 0; i < count; ++i) {
    sample.points.push_back({random.real(0, 100), random.real(0, 100)});
    sample.heights.push_back(std::floor(random.real(0, 40)));
  }
  return sample;
}

std::optional<FixedFaces> faces_of(const Tin& tin, std::uint32_t order) {
  Progress progress;
  const ConstrainedOrder ground(tin);
  return find_fixed_faces(tin, find_order_triangles(ground, {.max_order = order}, progress), {}, progress);
}

TEST(PitHeuristics, NeedTheDelaunayTriangulationToBeOfTheOrder) {
  Progress progress;
  const Tin tin = triangulate({{0, 0}, {4, -1}, {8, 0}, {4, 1}}, {0, 1, 2, 3}, {}, progress);
  ASSERT_TRUE(tin.find_halfedge(VertexId{1U}, VertexId{3U}).valid());
  const auto other = [](std::size_t a, std::size_t b, std::size_t c) {
    return OrderTriangle{{VertexId{a}, VertexId{b}, VertexId{c}}, 1};
  };
  const auto faces = find_fixed_faces(tin, {other(0, 1, 2), other(0, 2, 3)}, {}, progress);
  ASSERT_TRUE(faces);
  for (const PitHeuristic heuristic : kHeuristics) {
    try {
      static_cast<void>(remove_pits(tin, *faces, heuristic, progress));
      FAIL();
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::Unsupported);
    }
  }
}

TEST(PitHeuristics, AreLabelsOfFacesThatAreNotSearchedWhole) {
  test::Random random;
  const auto [points, heights] = random_sample(random, 500);
  Progress progress;
  const Tin tin = triangulate(points, heights, {}, progress);
  const auto faces = faces_of(tin, 3);
  ASSERT_TRUE(faces);
  FaceOptimizeOptions options{.common = {.criteria = {Criterion::LocalMinima}}, .work_limit = 1};
  const FaceOptimizeResult result = optimize_faces(tin, *faces, options, progress);
  const CriterionResult& pits = result.criteria[0];
  EXPECT_EQ(result.partial_faces, result.faces);
  EXPECT_LT(pits.result, pits.delaunay);
  options.work_limit = FaceOptimizeOptions{}.work_limit;
  EXPECT_LE(optimize_faces(tin, *faces, options, progress).criteria[0].result, pits.result);
  for (const PitHeuristic heuristic : kHeuristics) {
    EXPECT_LE(pits.result, optimize_faces_by(heuristic, tin, *faces, options, progress).criteria[0].result);
  }
}

using Places = std::set<std::array<Point2, 3>>;

Places places_of(const std::vector<Point2>& points, const std::vector<OrderTriangle>& triangles) {
  Places places;
  for (const OrderTriangle& t : triangles) {
    std::array<Point2, 3> at{};
    for (std::size_t i = 0; i < 3; ++i) at[i] = points[t.corners[i].index()];
    std::sort(at.begin(), at.end());
    places.insert(at);
  }
  return places;
}

TEST(PitHeuristics, DoNotDependOnIds) {
  test::Random random;
  auto [points, heights] = random_sample(random, 1500);
  std::array<Places, 2> before;
  for (int turn = 0; turn < 3; ++turn) {
    Progress progress;
    const Tin tin = triangulate(points, heights, {}, progress);
    const auto faces = faces_of(tin, 3);
    ASSERT_TRUE(faces);
    for (std::size_t h = 0; h < kHeuristics.size(); ++h) {
      const Places places = places_of(points, remove_pits(tin, *faces, kHeuristics[h], progress));
      if (turn > 0) {
        EXPECT_EQ(places, before[h]);
      }
      before[h] = places;
    }
    std::vector<std::size_t> shuffled(points.size());
    std::iota(shuffled.begin(), shuffled.end(), std::size_t{0});
    for (std::size_t i = shuffled.size() - 1; i > 0; --i) {
      std::swap(shuffled[i], shuffled[random.integer<std::size_t>(0, i)]);
    }
    const auto old_points = points;
    const auto old_heights = heights;
    for (std::size_t i = 0; i < shuffled.size(); ++i) {
      points[i] = old_points[shuffled[i]];
      heights[i] = old_heights[shuffled[i]];
    }
  }
}

TEST(PitHeuristics, AreForPitsAtAGivenOrder) {
  Progress progress;
  const Tin tin = triangulate({{0, 0}, {4, 0}, {4, 3}, {0, 3}}, {0, 1, 2, 3}, {}, progress);
  const auto faces = faces_of(tin, 1);
  ASSERT_TRUE(faces);
  const auto code = [&](const FaceOptimizeOptions& options) {
    try {
      static_cast<void>(optimize_faces_by(PitHeuristic::Flip, tin, *faces, options, progress));
    } catch (const Error& error) {
      return error.code();
    }
    return ErrorCode::Cancelled;
  };
  EXPECT_EQ(code({.common = {.criteria = {Criterion::EdgeLength}}}), ErrorCode::Usage);
  EXPECT_EQ(code({.common = {.criteria = {}}}), ErrorCode::Usage);
  EXPECT_EQ(code({.common = {.criteria = {Criterion::LocalMinima}}, .order_sum_after = 1}), ErrorCode::Usage);
}

}  // namespace
}  // namespace thalweg
