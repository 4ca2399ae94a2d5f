// All triangles of order at most k, against all valid triangles of the oracle.
#include <thalweg/base/error.hpp>
#include <thalweg/geometry/predicates.hpp>
#include <thalweg/order/order_triangles.hpp>

#include <gtest/gtest.h>
#include <support/oracle/law_testing.hpp>
#include <support/oracle/triangulations.hpp>
#include <support/random.hpp>
#include <support/scene_tin.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace thalweg {
namespace {

using oracle::Corners;
using oracle::Dice;
using oracle::Oracle;
using oracle::Orders;
using oracle::Scene;
using oracle::SceneOptions;

constexpr std::size_t kLargestOrder = 4;

using MakeScene = Scene (*)(Dice&, const SceneOptions&);

void compare(MakeScene make, const SceneOptions& options, int scenes) {
  Dice dice(testing::UnitTest::GetInstance()->current_test_info()->name());
  Progress progress;
  for (int i = 0; i < scenes * THALWEG_SCENE_FACTOR && !testing::Test::HasFailure(); ++i) {
    const Scene scene = make(dice, options);
    SCOPED_TRACE(oracle::to_text(scene));
    const Oracle truth(scene);
    const Tin ground = test::ground_of(scene);
    const ConstrainedOrder order(ground, test::mode_of(scene));
    const std::vector<Corners> corners = truth.valid_triangles();
    std::vector<Orders> orders;
    for (const Corners& t : corners) orders.push_back(truth.orders(t));
    for (const OrderDefinition definition : kOrderDefinitions) {
      for (std::size_t k = 0; k <= kLargestOrder; ++k) {
        std::vector<OrderTriangle> expected;
        for (std::size_t t = 0; t < corners.size(); ++t) {
          const auto value = static_cast<std::uint32_t>(orders[t][static_cast<std::size_t>(definition)]);
          if (value <= k) expected.push_back({test::triangle(corners[t]), value});
        }
        const auto found = find_order_triangles(order, {.definition = definition, .max_order = k}, progress);
        EXPECT_EQ(found.size(), expected.size());
        EXPECT_TRUE(found == expected) << definition_name(definition) << " up to " << k;
      }
    }
  }
}

TEST(OrderTriangles, AreCompleteInGeneralPosition) {
  compare(oracle::random_scene, {.most = 16, .constraints = 10}, 60);
}
TEST(OrderTriangles, AreCompleteOnLattices) {
  compare(oracle::random_lattice_scene, {.most = 16, .range = 5, .constraints = 8}, 60);
}
TEST(OrderTriangles, AreCompleteOnCirclesAndTheirTangents) {
  compare(oracle::random_circle_scene, {.most = 16, .constraints = 8}, 40);
}
TEST(OrderTriangles, AreCompleteOnLargerScenes) {
  compare(oracle::random_scene, {.fewest = 26, .most = 30, .range = 300, .constraints = 14}, 10);
}
TEST(OrderTriangles, AreCompleteInPolygons) {
  compare(oracle::random_polygon, {.most = 16}, 60);
}
TEST(OrderTriangles, AreCompleteOnGroundsWithHoles) {
  compare(oracle::random_ground, {.most = 16}, 40);
}

// A scene too large for the oracle: constraint edges between vertices at most `reach` apart, where they fit.
Tin larger_ground(test::Random& random, std::size_t vertices, std::size_t edges, double reach) {
  std::vector<Point2> points;
  for (std::size_t i = 0; i < vertices; ++i) {
    const double x = random.real(0, 100);
    points.push_back({x, random.real(0, 100)});
  }
  std::vector<ConstraintEdge> constraints;
  const auto fits = [&](VertexId a, VertexId b) {
    const Point2 p = points[a.index()], q = points[b.index()];
    if (a == b || std::hypot(p.x - q.x, p.y - q.y) > reach) return false;
    return std::none_of(constraints.begin(), constraints.end(), [&](const ConstraintEdge& edge) {
      return std::minmax(edge.a, edge.b) == std::minmax(a, b) ||
             cross_properly(p, q, points[edge.a.index()], points[edge.b.index()]);
    });
  };
  for (std::size_t tries = 0; tries < 10000 && constraints.size() < edges; ++tries) {
    const VertexId a{random.integer<std::size_t>(0, vertices - 1)};
    const VertexId b{random.integer<std::size_t>(0, vertices - 1)};
    if (fits(a, b)) constraints.push_back({a, b, EdgeKind::Breakline});
  }
  Progress progress;
  return triangulate(points, std::vector<double>(vertices, 0.0), constraints, progress);
}

// Every triple of vertices, under the orders of ConstrainedOrder, which other tests compare with the oracle.
void compare_with_all_triples(std::size_t vertices, std::size_t edges, double reach) {
  test::Random random;
  SCOPED_TRACE(random.trace());
  const Tin ground = larger_ground(random, vertices, edges, reach);
  const ConstrainedOrder order(ground);
  OrderWorkspace workspace;
  constexpr std::size_t kMost = 3;
  std::array<std::vector<OrderTriangle>, kOrderDefinitions.size()> expected;
  for (std::size_t a = 0; a < vertices; ++a) {
    for (std::size_t b = a + 1; b < vertices; ++b) {
      for (std::size_t c = b + 1; c < vertices; ++c) {
        Triangle t{VertexId{a}, VertexId{b}, VertexId{c}};
        if (!order.is_valid(t, workspace)) continue;
        if (orientation(ground.point(t[0]), ground.point(t[1]), ground.point(t[2])) < 0)
          std::swap(t[1], t[2]);
        for (std::size_t d = 0; d < expected.size(); ++d) {
          const auto value = order.order_up_to(t, kOrderDefinitions[d], kMost, workspace);
          if (value) expected[d].push_back({t, static_cast<std::uint32_t>(*value)});
        }
      }
    }
  }
  Progress progress;
  for (std::size_t d = 0; d < expected.size(); ++d) {
    std::sort(expected[d].begin(), expected[d].end());
    const auto found =
        find_order_triangles(order, {.definition = kOrderDefinitions[d], .max_order = kMost}, progress);
    EXPECT_EQ(found.size(), expected[d].size());
    EXPECT_TRUE(found == expected[d]) << definition_name(kOrderDefinitions[d]);
  }
}

TEST(OrderTriangles, AreAmongAllTriplesWithoutConstraints) {
  compare_with_all_triples(100, 0, 0);
}
TEST(OrderTriangles, AreAmongAllTriplesWithShortConstraints) {
  compare_with_all_triples(120, 25, 15);
}
TEST(OrderTriangles, AreAmongAllTriplesWithLongConstraints) {
  compare_with_all_triples(120, 20, 70);
}
TEST(OrderTriangles, AreAmongAllTriplesWithManyConstraints) {
  compare_with_all_triples(120, 120, 30);
}

TEST(OrderTriangles, ReportProgressAndStop) {
  test::Random random;
  SCOPED_TRACE(random.trace());
  const Tin ground = larger_ground(random, 2000, 50, 15);
  const ConstrainedOrder order(ground);
  double last = -1;
  Progress progress([&](const std::string&, double fraction) {
    EXPECT_GE(fraction, last);
    last = fraction;
  });
  progress.start_phase("orders");
  find_order_triangles(order, {}, progress);
  EXPECT_EQ(last, 1);
  Progress stopped;
  stopped.cancel();
  EXPECT_THROW(find_order_triangles(order, {}, stopped), Error);
}

}  // namespace
}  // namespace thalweg
