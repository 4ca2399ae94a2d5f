// Orders above 1 where everything ties: lattices, and points on one circle, whose orders can be told by hand.
#include <thalweg/delaunay/triangulate.hpp>
#include <thalweg/optimize/optimize_faces.hpp>
#include <thalweg/order/useful_triangles.hpp>

#include <gtest/gtest.h>
#include <support/random.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace thalweg {
namespace {

std::set<Triangle> corners_of(const std::vector<OrderTriangle>& triangles,
                              const std::function<bool(const Triangle&)>& wanted) {
  std::set<Triangle> corners;
  for (const OrderTriangle& t : triangles) {
    if (wanted(t.corners)) corners.insert(t.corners);
  }
  return corners;
}

struct Lattice {
  static constexpr std::size_t kSide = 31;  ///< points
  Tin tin;

  Lattice(double cell_width, double cell_height) {
    test::Random random;
    std::vector<Point2> points;
    std::vector<double> heights;
    for (std::size_t i = 0; i < kSide * kSide; ++i) {
      points.push_back(
          {static_cast<double>(i % kSide) * cell_width, static_cast<double>(i / kSide) * cell_height});
      heights.push_back(random.real(0, 10));
    }
    Progress progress;
    tin = triangulate(points, heights, {}, progress);
  }
  [[nodiscard]] FixedFaces faces(std::size_t k) const {
    Progress progress;
    const ConstrainedOrder order(tin);
    return find_fixed_faces(tin, find_useful_triangles(order, {.max_order = k}, progress), {}, progress)
        .value();
  }
  /// Whether all corners are at least so many cells away from the border.
  [[nodiscard]] std::function<bool(const Triangle&)> away(std::size_t cells) const {
    return [cells](const Triangle& corners) {
      return std::all_of(corners.begin(), corners.end(), [&](VertexId v) {
        const std::size_t column = v.index() % kSide, row = v.index() / kSide;
        return std::min({column, row, kSide - 1 - column, kSide - 1 - row}) >= cells;
      });
    };
  }
  [[nodiscard]] std::set<Triangle> chosen(std::size_t k, std::size_t cells_away) const {
    Progress progress;
    return corners_of(
        optimize_faces(tin, faces(k), {.common = {.criteria = {Criterion::NormalAngleSum}}}, progress)
            .triangles,
        away(cells_away));
  }
};

TEST(HigherOrderTies, SquareCellsHaveNoMoreThanTheirDiagonalsAtOrders2And3) {
  const Lattice square(10, 10);
  constexpr std::size_t kMargin = 3, kCells = (Lattice::kSide - 1 - 2 * kMargin);
  const std::set<Triangle> first = corners_of(square.faces(1).triangles, square.away(kMargin));
  EXPECT_EQ(first.size(), kCells * kCells * 4);
  for (const std::size_t k : {2U, 3U}) {
    EXPECT_EQ(corners_of(square.faces(k).triangles, square.away(kMargin)), first) << k;
    // What other triangles at the border change dies out before it has come so far.
    EXPECT_EQ(square.chosen(k, 9), square.chosen(1, 9)) << k;
  }
}

TEST(HigherOrderTies, CellsOfTenByFifteenHaveMoreAtOrder3) {
  const Lattice oblong(10, 15);
  constexpr std::size_t kMargin = 3;
  const std::set<Triangle> first = corners_of(oblong.faces(1).triangles, oblong.away(kMargin));
  EXPECT_EQ(corners_of(oblong.faces(2).triangles, oblong.away(kMargin)), first);
  const std::set<Triangle> third = corners_of(oblong.faces(3).triangles, oblong.away(kMargin));
  EXPECT_TRUE(std::includes(third.begin(), third.end(), first.begin(), first.end()));
  EXPECT_GT(third.size(), first.size());
  // (0, 0), (10, 0), (20, 15), somewhere inside.
  const std::size_t corner = 10 * Lattice::kSide + 10;
  const Triangle slanted{VertexId{corner}, VertexId{corner + 1}, VertexId{corner + Lattice::kSide + 2}};
  const ConstrainedOrder order(oblong.tin);
  OrderWorkspace workspace;
  EXPECT_EQ(order.order(slanted, OrderDefinition::SeesOpp, workspace), 3U);
  EXPECT_NE(oblong.chosen(3, kMargin), oblong.chosen(1, kMargin));
}

/// Points on one circle, counter-clockwise. Their perturbed lifting rises with (x, y), so by hand: a vertex d
/// is in the circle of a triangle exactly if the triangle's last corner by (x, y) comes after d, and d is on
/// that corner's side of the line through the other two.
struct Ring {
  std::vector<Point2> at;

  explicit Ring(std::size_t count) {
    const std::vector<Point2> all = {{5, 0},  {4, 3},   {3, 4},   {0, 5},  {-3, 4}, {-4, 3},
                                     {-5, 0}, {-4, -3}, {-3, -4}, {0, -5}, {3, -4}, {4, -3}};
    // Not the first ones only: gaps all around.
    for (std::size_t i = 0; i < count; ++i) at.push_back(all[i * all.size() / count]);
  }
  [[nodiscard]] std::size_t order(std::size_t a, std::size_t b, std::size_t c) const {
    while (!(at[a] < at[c] && at[b] < at[c])) {  // turn c to the last one
      const std::size_t first = a;
      a = b, b = c, c = first;
    }
    std::size_t count = 0;
    for (std::size_t d = 0; d < at.size(); ++d) {
      if (d == a || d == b || d == c || at[c] < at[d]) continue;
      // Around the circle, c's side of ab is from b on to a: the corners are counter-clockwise.
      count += a < b ? (d > b || d < a) : (d > b && d < a);
    }
    return count;
  }
  [[nodiscard]] double length(std::size_t a, std::size_t b) const {
    return std::hypot(at[a].x - at[b].x, at[a].y - at[b].y);
  }
};

/// Triangulations of the polygon from corner a to corner b, of triangles up to an order: how many, and the
/// least sum of lengths of their edges, ab and the polygon's own left out.
struct Polygon {
  double count, length;
};
Polygon solve(const Ring& ring, std::size_t k, std::size_t a, std::size_t b) {
  if (b == a + 1) return {1, 0};
  Polygon sum{0, std::numeric_limits<double>::infinity()};
  const auto own = [&](std::size_t c, std::size_t d) { return d == c + 1 ? 0 : ring.length(c, d); };
  for (std::size_t apex = a + 1; apex < b; ++apex) {
    if (ring.order(a, apex, b) > k) continue;
    const Polygon left = solve(ring, k, a, apex), right = solve(ring, k, apex, b);
    sum.count += left.count * right.count;
    sum.length = std::min(sum.length, left.length + right.length + own(a, apex) + own(apex, b));
  }
  return sum;
}

double count_triangulations(const FixedFaces& faces) {
  double count = 1;
  for (std::size_t f = 0; f < faces.faces.size(); ++f) {
    count *= static_cast<double>(list_triangulations(faces, f, {.most = 20'000})->count());
  }
  return count;
}

TEST(HigherOrderTies, PointsOnACircle) {
  const std::map<std::size_t, double> catalan = {{5, 5},   {6, 14},    {7, 42},    {8, 132},
                                                 {9, 429}, {10, 1430}, {11, 4862}, {12, 16796}};
  for (const auto& [count, all] : catalan) {
    const Ring ring(count);
    Progress progress;
    const Tin tin = triangulate(ring.at, std::vector<double>(count, 0), {}, progress);
    const ConstrainedOrder order(tin);
    for (std::size_t k = 0; k + 3 <= count; ++k) {
      SCOPED_TRACE(std::to_string(count) + " points, order " + std::to_string(k));
      const std::vector<OrderTriangle> triangles = find_order_triangles(order, {.max_order = k}, progress);
      std::vector<OrderTriangle> expected;
      for (std::size_t a = 0; a < count; ++a) {
        for (std::size_t b = a + 1; b < count; ++b) {
          for (std::size_t c = b + 1; c < count; ++c) {
            const std::size_t by_hand = ring.order(a, b, c);
            if (by_hand > k) continue;
            expected.push_back(
                {{VertexId{a}, VertexId{b}, VertexId{c}}, static_cast<std::uint32_t>(by_hand)});
          }
        }
      }
      EXPECT_EQ(triangles, expected);
      const auto faces = find_fixed_faces(tin, triangles, {}, progress);
      ASSERT_TRUE(faces);
      const Polygon polygon = solve(ring, k, 0, count - 1);
      EXPECT_EQ(count_triangulations(*faces), polygon.count);
      if (k == 0) {
        EXPECT_EQ(polygon.count, 1);
      }
      if (k + 3 == count) {
        EXPECT_EQ(polygon.count, all);
      }
      const FaceOptimizeResult shortest =
          optimize_faces(tin, *faces, {.common = {.criteria = {Criterion::EdgeLength}}}, progress);
      EXPECT_NEAR(shortest.criteria[0].result, polygon.length, 1e-7);
      EXPECT_TRUE(shortest.criteria[0].optimal);
    }
  }
}

TEST(HigherOrderTies, FivePointsOnACircle) {
  // 0 (5, 0), 1 (3, 4), 2 (-3, 4), 3 (-4, -3), 4 (0, -5); by (x, y): 3, 2, 4, 1, 0. Delaunay: each new point
  // is joined to the edge that it sees: 3 2 4, then 1 to 2 4, then 0 to 1 4.
  const Ring ring(5);
  Progress progress;
  const Tin tin = triangulate(ring.at, {0, 0, 0, 0, 0}, {}, progress);
  const auto triangle = [](std::size_t a, std::size_t b, std::size_t c) {
    return Triangle{VertexId{a}, VertexId{b}, VertexId{c}};
  };
  EXPECT_TRUE(std::ranges::equal(
      tin.triangles(), std::vector<Triangle>{triangle(0, 1, 4), triangle(1, 2, 4), triangle(2, 3, 4)}));
  const ConstrainedOrder order(tin);
  OrderWorkspace workspace;
  const auto of = [&](const Triangle& t) { return order.order(t, OrderDefinition::Std, workspace); };
  EXPECT_EQ(of(triangle(0, 2, 4)), 1U);  // 1 is in its circle: before 0, and on 0's side of 2 4
  EXPECT_EQ(of(triangle(0, 1, 3)), 1U);  // 4 is; 2 is beyond 1 3
  EXPECT_EQ(of(triangle(0, 1, 2)), 2U);  // 3 and 4 are
  EXPECT_EQ(of(triangle(0, 2, 3)), 2U);  // 1 and 4 are
  EXPECT_EQ(of(triangle(1, 2, 3)), 1U);  // 4 is; 0 comes after 1
}

}  // namespace
}  // namespace thalweg
