// The orders of all triangles of TINs, Delaunay and not, against the oracle.
#include <thalweg/base/error.hpp>
#include <thalweg/geometry/predicates.hpp>
#include <thalweg/mesh/change_tin.hpp>
#include <thalweg/order/constrained_order.hpp>
#include <thalweg/order/order_tin.hpp>
#include <thalweg/order/quadrilaterals.hpp>

#include <gtest/gtest.h>
#include <support/oracle/law_testing.hpp>
#include <support/oracle/triangulations.hpp>
#include <support/random.hpp>
#include <support/scene_tin.hpp>

#include <numeric>

namespace thalweg {
namespace {

using oracle::Corners;
using oracle::Oracle;

// Compares the orders of every triangle of a TIN with those of the oracle.
void expect_true_orders(const Oracle& truth, const Tin& tin) {
  Progress progress;
  for (std::size_t d = 0; d < kOrderDefinitions.size(); ++d) {
    const TinOrders found = find_tin_orders(
        tin, {.definition = kOrderDefinitions[d], .mode = test::mode_of(truth.scene())}, progress);
    ASSERT_EQ(found.orders.size(), tin.triangle_count());
    std::uint32_t largest = 0;
    for (std::size_t t = 0; t < tin.triangle_count(); ++t) {
      Corners corners{};
      for (std::size_t i = 0; i < 3; ++i) corners[i] = static_cast<int>(tin.triangles()[t][i].value());
      const auto expected =
          static_cast<std::uint32_t>(truth.order(corners, static_cast<oracle::Definition>(d)));
      ASSERT_EQ(found.orders[t], expected) << oracle::to_text(corners);
      largest = std::max(largest, expected);
    }
    ASSERT_EQ(found.max_order, largest);
    ASSERT_EQ(found.histogram.size(), largest + std::size_t{1});
    ASSERT_EQ(std::accumulate(found.histogram.begin(), found.histogram.end(), std::size_t{0}),
              tin.triangle_count());
  }
}

TEST(TinOrders, OfConstrainedDelaunayTriangulations) {
  oracle::for_each_scene(oracle::kStreams, 40, {}, [](const Oracle& truth) {
    expect_true_orders(truth, test::ground_of(truth.scene()));
  });
}

TEST(TinOrders, OfAnyTriangulation) {
  oracle::for_each_scene(oracle::kStreams, 8, {.most = 9}, [](const Oracle& truth) {
    const oracle::Enumeration all = enumerate(truth);
    const Tin ground = test::ground_of(truth.scene());
    const std::size_t step = all.members.size() / 5 + 1;
    for (std::size_t i = 0; i < all.members.size(); i += step) {
      std::vector<Triangle> triangles;
      for (const int t : all.members[i])
        triangles.push_back(test::triangle(all.triangles[static_cast<std::size_t>(t)]));
      const std::vector<ConstraintEdge> edges = ground.constraint_edges();
      const std::vector<Point2> points(ground.points().begin(), ground.points().end());
      expect_true_orders(truth, Tin(points, std::vector<double>(points.size(), 0.0), triangles, edges));
    }
  });
}

Tin random_ground(test::Random& random, bool lattice) {
  std::vector<Point2> points;
  for (int i = 0; i < 400; ++i) {
    points.push_back(lattice ? Point2{static_cast<double>(i % 20), static_cast<double>(i / 20)}
                             : Point2{random.real(0, 100), random.real(0, 100)});
  }
  Progress progress;
  const std::vector<double> heights(points.size(), 0.0);
  const Tin plain = triangulate(points, heights, {}, progress);
  std::vector<ConstraintEdge> edges;
  for (std::size_t i = 0; i < plain.halfedge_count(); ++i) {
    const HalfedgeId h{i};
    if (plain.represents_edge(h) && random.integer(0, 9) == 0) {
      edges.push_back({plain.origin(h), plain.target(h), EdgeKind::Breakline});
    }
  }
  return triangulate(points, heights, edges, progress);
}

// Flips some edges, no two of a triangle: `share` of 100 of those that can be.
Tin flip_some(const Tin& tin, test::Random& random, int share) {
  std::vector<bool> taken(tin.triangle_count(), false);
  std::vector<HalfedgeId> flips;
  for (std::size_t i = 0; i < tin.halfedge_count(); ++i) {
    const HalfedgeId h{i}, twin = tin.twin(h);
    if (!twin.valid() || tin.constrained(h) || random.integer(0, 99) >= share) continue;
    const std::size_t one = Tin::triangle_of(h).index(), other = Tin::triangle_of(twin).index();
    if (taken[one] || taken[other]) continue;
    if (!cross_properly(tin.point(tin.apex(h)), tin.point(tin.apex(twin)), tin.point(tin.origin(h)),
                        tin.point(tin.target(h)))) {
      continue;
    }
    taken[one] = taken[other] = true;
    flips.push_back(h);
  }
  return flip_edges(tin, flips).tin;
}

void expect_orders_one_by_one(const Tin& ground, const Tin& tin) {
  const ConstrainedOrder order(ground);
  OrderWorkspace workspace;
  Progress progress;
  for (const OrderDefinition definition : kOrderDefinitions) {
    const TinOrders found = find_tin_orders(tin, {.definition = definition}, progress);
    for (std::size_t t = 0; t < tin.triangle_count(); ++t) {
      ASSERT_EQ(found.orders[t], order.order(tin.triangles()[t], definition, workspace))
          << definition_name(definition) << " triangle " << t;
    }
  }
}

TEST(TinOrders, AfterRandomFlips) {
  test::Random random;
  SCOPED_TRACE(random.trace());
  for (const bool lattice : {false, true}) {
    const Tin ground = random_ground(random, lattice);
    for (const int share : {2, 20, 100}) {
      Tin tin = flip_some(ground, random, share);
      expect_orders_one_by_one(ground, tin);
      for (int round = 0; round < 20; ++round) tin = flip_some(tin, random, share);
      expect_orders_one_by_one(ground, tin);
    }
  }
}

TEST(TinOrders, OfFirstOrderTriangulations) {
  test::Random random;
  SCOPED_TRACE(random.trace());
  const Tin ground = random_ground(random, false);
  for (const Quadrilateral& q : find_quadrilaterals(ground, {}, Progress())) {
    if (random.integer(0, 1) == 0) continue;
    const std::array<HalfedgeId, 1> flip{q.diagonal};
    Progress progress;
    EXPECT_EQ(find_tin_orders(flip_edges(ground, flip).tin, {}, progress).histogram[1], 2U);
  }
}

TEST(TinOrders, ReportProgressAndStop) {
  test::Random random;
  SCOPED_TRACE(random.trace());
  const Tin tin = flip_some(random_ground(random, false), random, 50);
  double last = -1;
  Progress progress([&](const std::string&, double fraction) {
    EXPECT_GE(fraction, last);
    last = fraction;
  });
  progress.start_phase("orders");
  find_tin_orders(tin, {}, progress);
  EXPECT_EQ(last, 1);
  Progress stopped;
  stopped.cancel();
  EXPECT_THROW(find_tin_orders(tin, {}, stopped), Error);
}

}  // namespace
}  // namespace thalweg
