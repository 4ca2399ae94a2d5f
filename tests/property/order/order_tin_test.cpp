// The orders of all triangles of TINs, Delaunay and not, against the oracle.
#include <thalweg/order/order_tin.hpp>

#include <gtest/gtest.h>
#include <support/oracle/law_testing.hpp>
#include <support/oracle/triangulations.hpp>
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

}  // namespace
}  // namespace thalweg
