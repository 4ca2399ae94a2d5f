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
  compare(oracle::random_scene, {.most = 16, .constraints = 10}, 250);
}
TEST(OrderTriangles, AreCompleteOnLattices) {
  compare(oracle::random_lattice_scene, {.most = 16, .range = 5, .constraints = 8}, 63);
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

// Of a lattice of 12 x 12 vertices, those triangles whose discs lie well within it.
std::vector<OrderTriangle> inner_triangles(double width, double height, std::size_t k) {
  constexpr std::size_t kSide = 12;
  std::vector<Point2> points;
  for (std::size_t i = 0; i < kSide * kSide; ++i) {
    points.push_back({width * static_cast<double>(i % kSide), height * static_cast<double>(i / kSide)});
  }
  Progress progress;
  const Tin ground = triangulate(points, std::vector<double>(points.size(), 0.0), {}, progress);
  std::vector<OrderTriangle> inner;
  for (const OrderTriangle& t : find_order_triangles(ConstrainedOrder(ground), {.max_order = k}, progress)) {
    const bool deep = std::ranges::all_of(t.corners, [](VertexId v) {
      const std::size_t x = v.index() % kSide, y = v.index() / kSide;
      return x >= 4 && x < kSide - 4 && y >= 4 && y < kSide - 4;
    });
    if (deep) inner.push_back(t);
  }
  return inner;
}

TEST(OrderTriangles, OfSquareCellsAreFirstOrderUpToThree) {
  const auto first = inner_triangles(10, 10, 1);
  EXPECT_EQ(first.size(), 4 * 9U);  // four in each cell
  EXPECT_TRUE(inner_triangles(10, 10, 2) == first);
  EXPECT_TRUE(inner_triangles(10, 10, 3) == first);
}

TEST(OrderTriangles, OfLongCellsAreMoreAtOrderThree) {
  const auto found = inner_triangles(10, 15, 3);
  const Triangle slanting{VertexId{5 * 12 + 4}, VertexId{5 * 12 + 5}, VertexId{6 * 12 + 6}};
  EXPECT_TRUE(std::ranges::any_of(found, [&](const OrderTriangle& t) { return t.corners == slanting; }));
  EXPECT_GT(found.size(), inner_triangles(10, 15, 1).size());
}

// By the tie rule, of vertices on one circle, in the order of (x, y), those count that come before the last
// corner, and lie on its side of the line through the other two.
TEST(OrderTriangles, OfVerticesOnOneCircleFollowTheTieRule) {
  const std::array<Point2, 12> circle = {{{1, 18},
                                          {6, 17},
                                          {10, 15},
                                          {15, 10},
                                          {17, 6},
                                          {18, 1},
                                          {18, -1},
                                          {15, -10},
                                          {6, -17},
                                          {-1, -18},
                                          {-15, -10},
                                          {-17, 6}}};
  for (std::size_t n = 5; n <= circle.size(); ++n) {
    std::vector<Point2> points(circle.begin(), circle.begin() + static_cast<std::ptrdiff_t>(n));
    std::ranges::sort(points, [](Point2 a, Point2 b) { return std::pair(a.x, a.y) < std::pair(b.x, b.y); });
    Progress progress;
    const Tin ground = triangulate(points, std::vector<double>(n, 0.0), {}, progress);
    for (std::size_t k = 0; k <= 4; ++k) {
      std::vector<OrderTriangle> expected;
      for (std::size_t c = 2; c < n; ++c) {
        for (std::size_t b = 1; b < c; ++b) {
          for (std::size_t a = 0; a < b; ++a) {
            const int side = orientation(points[a], points[b], points[c]);
            std::uint32_t order = 0;
            for (std::size_t d = 0; d < c; ++d) {
              order += orientation(points[a], points[b], points[d]) == side ? 1 : 0;
            }
            Triangle corners{VertexId{a}, VertexId{b}, VertexId{c}};
            if (side < 0) std::swap(corners[1], corners[2]);
            if (order <= k) expected.push_back({corners, order});
          }
        }
      }
      std::ranges::sort(expected);
      EXPECT_TRUE(find_order_triangles(ConstrainedOrder(ground), {.max_order = k}, progress) == expected)
          << n << " vertices, up to " << k;
    }
  }
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
