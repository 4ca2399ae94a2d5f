// The smallest order under Std, against all triangulations of the oracle.
#include <thalweg/order/std_order.hpp>

#include <gtest/gtest.h>
#include <support/oracle/law_testing.hpp>
#include <support/oracle/triangulations.hpp>
#include <support/scene_tin.hpp>

#include <algorithm>
#include <limits>
#include <map>

namespace thalweg {
namespace {

using oracle::Corners;
using oracle::Edge;
using oracle::Enumeration;
using oracle::Oracle;

constexpr oracle::SceneOptions kSmall{.fewest = 4, .most = 9, .constraints = 6};
constexpr auto kStd = static_cast<std::size_t>(oracle::Definition::Std);

StdOrderInterval interval_of(const oracle::Scene& scene, const Tin& ground) {
  Progress progress;
  return find_std_order_interval(ConstrainedOrder(ground, test::mode_of(scene)), progress);
}

/// The smallest order of a valid triangle on the left of each directed edge.
std::map<Edge, int> smallest_beside(const Enumeration& all) {
  std::map<Edge, int> smallest;
  for (std::size_t i = 0; i < all.triangles.size(); ++i) {
    for (std::size_t side = 0; side < 3; ++side) {
      const Edge directed{all.triangles[i][side], all.triangles[i][(side + 1) % 3]};
      const auto [at, fresh] = smallest.emplace(directed, all.orders[i][kStd]);
      if (!fresh) at->second = std::min(at->second, all.orders[i][kStd]);
    }
  }
  return smallest;
}

// Laws 1 to 3, and that the demand is what its triangle has.
TEST(StdOrder, LiesInTheInterval) {
  for_each_scene(oracle::kStreams, 60, kSmall, [](const Oracle& oracle) {
    const Enumeration all = enumerate(oracle);
    const Tin ground = test::ground_of(oracle.scene());
    const StdOrderInterval interval = interval_of(oracle.scene(), ground);
    int smallest = std::numeric_limits<int>::max();
    for (const auto& largest : all.largest) smallest = std::min(smallest, largest[kStd]);
    ASSERT_LE(static_cast<int>(interval.at_least), smallest);
    ASSERT_GE(static_cast<int>(interval.at_most), smallest);
    ASSERT_TRUE(interval.at_most > 1 || interval.at_least == interval.at_most);

    int demanded = 0;
    const auto beside = smallest_beside(all);
    for (const auto& [a, b] : oracle.scene().constraints) {
      for (const Edge& directed : {Edge{a, b}, Edge{b, a}}) {
        if (const auto at = beside.find(directed); at != beside.end())
          demanded = std::max(demanded, at->second);
      }
    }
    ASSERT_EQ(interval.demand ? static_cast<int>(interval.demand->order) : 0, demanded);
    if (!interval.demand) return;
    const auto site = [](VertexId v) { return static_cast<int>(v.value()); };
    const auto& [a, b, triangle, order] = *interval.demand;
    ASSERT_EQ(triangle[0], a);
    ASSERT_EQ(triangle[1], b);
    ASSERT_TRUE(oracle.scene().constrained(site(a), site(b)));
    ASSERT_EQ(beside.at({site(a), site(b)}), static_cast<int>(order));
    ASSERT_EQ(oracle.order({site(a), site(b), site(triangle[2])}, oracle::Definition::Std),
              static_cast<int>(order));
  });
}

// Larger scenes: the bounds against the valid triangles alone.
TEST(StdOrder, DemandIsThatOfAllValidTriangles) {
  for_each_scene(oracle::kPlaneStreams, 60, {.fewest = 12, .most = 24, .constraints = 10},
                 [](const Oracle& oracle) {
                   const Tin ground = test::ground_of(oracle.scene());
                   const StdOrderInterval interval = interval_of(oracle.scene(), ground);
                   Enumeration all;
                   all.triangles = oracle.valid_triangles();
                   for (const Corners& t : all.triangles) all.orders.push_back(oracle.orders(t));
                   int demanded = 0, own = 0;
                   for (const auto& [directed, order] : smallest_beside(all)) {
                     if (oracle.scene().constrained(directed.first, directed.second))
                       demanded = std::max(demanded, order);
                   }
                   for (const Corners& t : delaunay_triangles(oracle))
                     own = std::max(own, oracle.order(t, oracle::Definition::Std));
                   ASSERT_EQ(interval.demand ? static_cast<int>(interval.demand->order) : 0, demanded);
                   ASSERT_EQ(static_cast<int>(interval.at_most), own);
                 });
}

TEST(StdOrder, IsZeroWithoutConstraintEdges) {
  for_each_scene(oracle::kPlaneStreams, 30, {.fewest = 4, .most = 16, .constraints = 0},
                 [](const Oracle& oracle) {
                   const Tin ground = test::ground_of(oracle.scene());
                   const StdOrderInterval interval = interval_of(oracle.scene(), ground);
                   ASSERT_EQ(interval.at_least, 0U);
                   ASSERT_EQ(interval.at_most, 0U);
                   ASSERT_FALSE(interval.demand.has_value());
                 });
}

}  // namespace
}  // namespace thalweg
