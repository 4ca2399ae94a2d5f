// Simple polygons of up to ten vertices, every definition, every order up to 4: what the program over edges
// finds is the least that any triangulation of the order has, by enumeration and the orders of the oracle.
// THALWEG_SCENES: polygons.
#include "support/face_scenes.hpp"
#include "support/first_order_scene.hpp"

#include <thalweg/base/error.hpp>
#include <thalweg/delaunay/triangulate.hpp>
#include <thalweg/optimize/optimize_polygon.hpp>
#include <thalweg/order/constrained_order.hpp>

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace thalweg {
namespace {

using oracle::Oracle;
using Combine = PolygonMeasure::Combine;

constexpr int kMostOrder = 4;
constexpr std::size_t kDefinitions = 8;
constexpr std::array kObjectives = {
    Criterion::EdgeLength, Criterion::NormalAngleSum, Criterion::NormalAngleMax, Criterion::MaxAngle,
    Criterion::MinAngle,   Criterion::FlatTriangles,  Criterion::MaxArea};

/// Sixteenths, of which doubles add any number exactly: what is drawn for a triangle, or two in any order.
double drawn(std::vector<std::size_t> ids, std::uint64_t salt) {
  std::sort(ids.begin(), ids.end());
  std::uint64_t hash = salt;
  for (const std::size_t id : ids) hash = (hash ^ id) * 0x100000001b3U + 0x9e3779b9U;
  return static_cast<double>(hash >> 20U & 0xffU) / 16 - 8;
}

std::vector<std::size_t> ids_of(const Triangle& t) {
  return {t[0].index(), t[1].index(), t[2].index()};
}

PolygonMeasure drawn_measure(Combine combine, bool triangles, bool neighbours, std::uint64_t salt) {
  PolygonMeasure measure;
  measure.combine = combine;
  if (triangles) measure.of_triangle = [salt](const Triangle& t) { return drawn(ids_of(t), salt); };
  if (neighbours) {
    measure.of_neighbours = [salt](const Triangle& a, const Triangle& b) {
      std::vector<std::size_t> both = ids_of(a);
      for (const std::size_t id : ids_of(b)) both.push_back(id);
      return drawn(both, salt + 1);
    };
  }
  return measure;
}

/// The value by its definition; none of an empty largest.
double plain_value(const PolygonMeasure& measure, const std::vector<Triangle>& triangles) {
  double value = measure.combine == Combine::Sum ? 0 : std::numeric_limits<double>::lowest();
  const auto take = [&](double term) {
    value = measure.combine == Combine::Sum ? value + term : std::max(value, term);
  };
  std::map<std::pair<VertexId, VertexId>, const Triangle*> left;
  for (const Triangle& t : triangles) {
    if (measure.of_triangle) take(measure.of_triangle(t));
    for (std::size_t i = 0; i < 3; ++i) left[{t[i], t[(i + 1) % 3]}] = &t;
  }
  for (const auto& [side, t] : left) {
    const auto across = left.find({side.second, side.first});
    if (side.first < side.second && across != left.end() && measure.of_neighbours)
      take(measure.of_neighbours(*t, *across->second));
  }
  return value;
}

std::vector<Triangle> triangles_of(const oracle::Enumeration& all, std::size_t member) {
  std::vector<Triangle> triangles;
  for (const int t : all.members[member])
    triangles.push_back(test::triangle(all.triangles[static_cast<std::size_t>(t)]));
  return triangles;
}

std::vector<Triangle> triangles_of(const PolygonTriangulation& found) {
  std::vector<Triangle> triangles;
  for (const OrderTriangle& t : found.triangles) triangles.push_back(t.corners);
  return triangles;
}

/// The polygon, its triangulations, and one measure to be tried.
struct Trial {
  const Tin& ground;
  const oracle::Enumeration& all;
  PolygonMeasure measure;
  double tolerance = 0;
};

void check(const Trial& trial, std::size_t definition, int k) {
  Progress progress;
  const auto found = optimize_polygon(trial.ground,
                                      {.definition = kOrderDefinitions[definition],
                                       .max_order = static_cast<std::size_t>(k),
                                       .measure = trial.measure},
                                      progress);
  const auto members = trial.all.of_order(static_cast<oracle::Definition>(definition), k);
  ASSERT_EQ(found.has_value(), !members.empty());
  if (!found) return;
  double best = std::numeric_limits<double>::max();
  std::vector<Triangle> triangles = triangles_of(*found);
  std::sort(triangles.begin(), triangles.end());
  bool is_one_of_them = false;
  for (const std::size_t member : members) {
    std::vector<Triangle> other = triangles_of(trial.all, member);
    best = std::min(best, plain_value(trial.measure, other));
    for (Triangle& t : other) std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    std::sort(other.begin(), other.end());
    is_one_of_them = is_one_of_them || other == triangles;
  }
  EXPECT_TRUE(is_one_of_them);
  EXPECT_NEAR(found->value, best, trial.tolerance);
  EXPECT_NEAR(plain_value(trial.measure, triangles), best, trial.tolerance);
}

TEST(OptimizePolygon, NoTriangulationOfTheOrderHasLess) {
  constexpr std::array kPolygons = {oracle::Stream::Polygon};
  int number = 0;
  for_each_scene(kPolygons, test::scene_count(40), test::kSmallFaces, [&](const Oracle& oracle) {
    oracle::Dice dice("optimize-polygon-" + std::to_string(number++));
    std::vector<double> heights;
    for (int v = 0; v < oracle.scene().size(); ++v) heights.push_back(dice.between(0, 4));
    const oracle::Enumeration all = enumerate(oracle);
    Tin ground = test::ground_of(oracle.scene());
    ground = test::with_heights(ground, {ground.triangles().begin(), ground.triangles().end()}, heights);
    std::vector<Trial> trials;
    for (const Combine combine : {Combine::Sum, Combine::Largest}) {
      for (const auto& [triangles, neighbours] : {std::pair(true, false), {false, true}, {true, true}}) {
        trials.push_back({ground, all,
                          drawn_measure(combine, triangles, neighbours, static_cast<std::uint64_t>(number)),
                          0});
      }
    }
    for (const Criterion criterion : kObjectives) {
      trials.push_back(
          {ground, all, measure_of(ground, criterion, {test::kHorizontal, test::kVertical}), 1e-7});
    }
    for (const Trial& trial : trials) {
      for (std::size_t definition = 0; definition < kDefinitions; ++definition) {
        for (int k = 0; k <= kMostOrder; ++k) {
          SCOPED_TRACE(std::string(definition_name(kOrderDefinitions[definition])) + " " + std::to_string(k));
          ASSERT_NO_FATAL_FAILURE(check(trial, definition, k));
          ASSERT_FALSE(testing::Test::HasFailure());
        }
      }
    }
  });
}

/// The criteria as the optimiser over faces reports them: plain values of both results agree.
TEST(OptimizePolygon, AgreesWithTheOptimiserOverFaces) {
  constexpr std::array kPolygons = {oracle::Stream::Polygon};
  constexpr oracle::SceneOptions kLarger{.fewest = 12, .most = 30, .constraints = 3};
  int number = 0;
  for_each_scene(kPolygons, test::scene_count(30), kLarger, [&](const Oracle& oracle) {
    oracle::Dice dice("optimize-polygon-faces-" + std::to_string(number++));
    std::vector<double> heights;
    for (int v = 0; v < oracle.scene().size(); ++v) heights.push_back(dice.between(0, 9));
    Tin ground = test::ground_of(oracle.scene());
    ground = test::with_heights(ground, {ground.triangles().begin(), ground.triangles().end()}, heights);
    const std::size_t k = static_cast<std::size_t>(dice.between(1, 5));
    Progress progress;
    const ConstrainedOrder order(ground, GroundMode::Polygon);
    const auto faces =
        find_fixed_faces(ground, find_order_triangles(order, {.max_order = k}, progress), {}, progress);
    ASSERT_TRUE(faces);
    for (const Criterion criterion :
         {Criterion::EdgeLength, Criterion::NormalAngleSum, Criterion::MaxAngle}) {
      const auto found =
          optimize_polygon(ground, {.max_order = k, .measure = measure_of(ground, criterion, {})}, progress);
      const auto other = optimize_faces(ground, *faces, {.common = {.criteria = {criterion}}}, progress);
      ASSERT_TRUE(found);
      const auto tin_of = [&](const std::vector<OrderTriangle>& list) {
        std::vector<Triangle> triangles;
        for (const OrderTriangle& t : list) triangles.push_back(t.corners);
        return test::with_heights(ground, std::move(triangles), heights);
      };
      const std::string name(traits_of(criterion).name);
      const auto one = test::PlainCriteria(tin_of(found->triangles), 1, 1).value(name);
      const auto two = test::PlainCriteria(tin_of(other.triangles), 1, 1).value(name);
      EXPECT_NEAR(static_cast<double>(one), static_cast<double>(two), test::kTolerance) << name << " " << k;
    }
  });
}

TEST(OptimizePolygon, RefusesWhatIsNoSimplePolygonAndWhatIsNoSumOfItsParts) {
  const auto refused = [](const Tin& tin, const auto& call) {
    try {
      call(tin);
    } catch (const Error& error) {
      return error.code() == ErrorCode::Unsupported;
    }
    return false;
  };
  Progress progress;
  const auto optimize = [&](const Tin& tin) { (void)optimize_polygon(tin, {}, progress); };
  const std::vector<Point2> inside = {{0, 0}, {9, 0}, {9, 9}, {0, 9}, {4, 5}};
  const Tin with_vertex = triangulate(inside, std::vector<double>(5, 0.0), {}, progress);
  EXPECT_TRUE(refused(with_vertex, optimize));
  const std::vector<Point2> square = {{0, 0}, {9, 0}, {9, 9}, {0, 9}};
  const Tin simple = triangulate(square, std::vector<double>(4, 0.0), {}, progress);
  EXPECT_FALSE(refused(simple, optimize));
  for (const Criterion criterion : {Criterion::LocalMinima, Criterion::MaxDegree, Criterion::VerticalError}) {
    EXPECT_TRUE(refused(simple, [&](const Tin& tin) { (void)measure_of(tin, criterion, {}); }));
  }
}

}  // namespace
}  // namespace thalweg
