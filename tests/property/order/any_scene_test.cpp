// The whole order module on small scenes of every kind, most of them degenerate, against the oracle.
//
// Sites lie on lattices of a few columns, on circles and lines, or anywhere; constraint edges run between
// them at random. The library gets the scene moved and scaled exactly, which no answer may notice.
#include <thalweg/order/conflicts.hpp>
#include <thalweg/order/greedy_triangulation.hpp>
#include <thalweg/order/order_tin.hpp>
#include <thalweg/order/order_triangles.hpp>
#include <thalweg/order/std_order.hpp>
#include <thalweg/order/useful_edges.hpp>

#include <gtest/gtest.h>
#include <support/oracle/law_testing.hpp>
#include <support/oracle/triangulations.hpp>
#include <support/scene_tin.hpp>

#include <algorithm>
#include <map>
#include <set>

namespace thalweg {
namespace {

using oracle::Corners;
using oracle::Dice;
using oracle::Edge;
using oracle::Enumeration;
using oracle::Oracle;
using oracle::Scene;
using oracle::Stream;

Edge edge(VertexId a, VertexId b) {
  return oracle::edge_of(static_cast<int>(a.value()), static_cast<int>(b.value()));
}

/// A scene of few sites, tight together.
Scene draw(Dice& dice) {
  constexpr std::array<int, 6> kRanges{2, 3, 4, 6, 12, 40};
  const oracle::SceneOptions options{.fewest = 4,
                                     .most = 8,
                                     .range = kRanges[static_cast<std::size_t>(dice.between(0, 5))],
                                     .constraints = dice.between(0, 10)};
  const int kind = dice.between(0, 9);
  if (kind < 5) return draw_scene(dice, Stream::Lattice, options);
  if (kind < 7) return draw_scene(dice, Stream::Circle, options);
  const Stream rest = kind == 7 ? Stream::General : kind == 8 ? Stream::Polygon : Stream::Ground;
  oracle::SceneOptions roomy = options;
  roomy.range = std::max(options.range, 12);
  return draw_scene(dice, rest, roomy);
}

/// The ground of the scene, moved and scaled: its triangles are the same.
Tin moved_ground(Dice& dice, const Scene& scene) {
  const Tin ground = test::ground_of(scene);
  constexpr std::array<double, 4> kScales{1, 0.0078125, 0.5, 1048576};
  const double scale = kScales[static_cast<std::size_t>(dice.between(0, 3))];
  const double x = scale * dice.between(-1, 1) * 4194304, y = scale * dice.between(-1, 1) * 33554432;
  std::vector<Point2> points;
  for (const Point2 p : ground.points()) points.push_back({scale * p.x + x, scale * p.y + y});
  return {std::move(points),
          {ground.heights().begin(), ground.heights().end()},
          {ground.triangles().begin(), ground.triangles().end()},
          ground.constraint_edges()};
}

void expect_same_orders(const Oracle& truth, const ConstrainedOrder& order) {
  OrderWorkspace workspace;
  Progress progress;
  const int n = truth.scene().size();
  std::vector<Corners> valid = truth.valid_triangles();
  for (int a = 0; a < n; ++a) {
    for (int b = a + 1; b < n; ++b) {
      ASSERT_EQ(order.sees(test::vertex(a), test::vertex(b)), truth.sees(a, b)) << a << " sees " << b;
      for (int c = b + 1; c < n; ++c) {
        ASSERT_EQ(order.is_valid(test::triangle({a, b, c}), workspace),
                  truth.validity({a, b, c}) == oracle::Validity::Valid)
            << oracle::to_text(Corners{a, b, c});
      }
    }
  }
  for (const OrderDefinition definition : kOrderDefinitions) {
    const auto d = static_cast<oracle::Definition>(definition);
    std::vector<OrderTriangle> expected;
    for (const Corners& t : valid) {
      oracle::SiteSet counted = 0;
      for (const VertexId v : order.counted(test::triangle(t), definition, workspace)) {
        counted |= oracle::SiteSet{1} << v.index();
      }
      ASSERT_EQ(counted, truth.counted(t, d)) << definition_name(definition) << " " << oracle::to_text(t);
      expected.push_back({test::triangle(t), static_cast<std::uint32_t>(truth.order(t, d))});
    }
    const auto everything = static_cast<std::size_t>(n);
    ASSERT_EQ(find_order_triangles(order, {.definition = definition, .max_order = everything}, progress),
              expected)
        << definition_name(definition);
    const TinOrders orders =
        find_tin_orders(order.ground(), {.definition = definition, .mode = order.mode()}, progress);
    for (std::size_t t = 0; t < orders.orders.size(); ++t) {
      const Triangle& corners = order.ground().triangle(TriangleId{t});
      const Corners sites{static_cast<int>(corners[0].value()), static_cast<int>(corners[1].value()),
                          static_cast<int>(corners[2].value())};
      ASSERT_EQ(static_cast<int>(orders.orders[t]), truth.order(sites, d)) << definition_name(definition);
    }
  }
}

void expect_same_triangulations(const Oracle& truth, const ConstrainedOrder& order) {
  Progress progress;
  const Enumeration all = enumerate(truth);
  const auto everything = static_cast<std::size_t>(truth.scene().size());
  for (const OrderDefinition definition : kOrderDefinitions) {
    const auto d = static_cast<oracle::Definition>(definition);
    std::map<Edge, int> useful;
    for (const UsefulEdge& e :
         find_useful_edges(order, {.definition = definition, .max_order = everything}, progress)) {
      ASSERT_TRUE(e.order.has_value());
      useful.emplace(edge(e.a, e.b), static_cast<int>(*e.order));
    }
    ASSERT_EQ(useful, all.useful_orders(d)) << definition_name(definition);

    // Pairs of edges that exclude each other at order 1.
    std::set<std::pair<Edge, Edge>> together, apart;
    for (const std::size_t i : all.of_order(d, 1)) {
      std::vector<Corners> triangles;
      for (const int t : all.members[i]) triangles.push_back(all.triangles[static_cast<std::size_t>(t)]);
      const std::vector<Edge> edges = oracle::edges_of(triangles);
      for (const Edge& one : edges) {
        for (const Edge& other : edges) together.emplace(one, other);
      }
    }
    for (const auto& [one, one_order] : useful) {
      for (const auto& [other, other_order] : useful) {
        if (one < other && one_order <= 1 && other_order <= 1 && !together.contains({one, other}))
          apart.emplace(one, other);
      }
    }
    const auto faces = find_fixed_faces(
        order.ground(), find_order_triangles(order, {.definition = definition, .max_order = 1}, progress), {},
        progress);
    ASSERT_EQ(faces.has_value(), !all.of_order(d, 1).empty()) << definition_name(definition);
    std::set<std::pair<Edge, Edge>> listed;
    if (faces) {
      for (const EdgeConflict& pair : find_edge_conflicts(*faces, {}, progress).pairs) {
        listed.emplace(edge(pair.a, pair.b), edge(pair.c, pair.d));
      }
    }
    ASSERT_EQ(listed, apart) << definition_name(definition);
  }

  const StdOrderInterval interval = find_std_order_interval(order, progress);
  int smallest = truth.scene().size();
  for (const auto& largest : all.largest) smallest = std::min(smallest, largest[0]);
  ASSERT_LE(static_cast<int>(interval.at_least), smallest);
  ASSERT_GE(static_cast<int>(interval.at_most), smallest);
}

void expect_same_greedy(const Oracle& truth, const ConstrainedOrder& order) {
  for (const Edge& e : oracle::edges_of(truth.valid_triangles())) {
    std::set<Corners> found;
    const Tin greedy = greedy_triangulation(order, test::vertex(e.first), test::vertex(e.second));
    for (Triangle t : greedy.triangles()) {
      std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
      found.insert(
          {static_cast<int>(t[0].value()), static_cast<int>(t[1].value()), static_cast<int>(t[2].value())});
    }
    const std::vector<Corners> expected = greedy_triangles(truth, e);
    ASSERT_EQ(found, std::set<Corners>(expected.begin(), expected.end())) << e.first << "-" << e.second;
  }
}

TEST(AnyScene, OrderModuleAgreesWithTheOracle) {
  Dice dice("AnyScene");
  constexpr int kScenes = 150;
  for (int i = 0; i < kScenes * THALWEG_SCENE_FACTOR && !HasFailure(); ++i) {
    const Scene scene = draw(dice);
    SCOPED_TRACE("scene " + std::to_string(i) + ": " + oracle::to_text(scene));
    const Oracle truth(scene);
    const Tin ground = moved_ground(dice, scene);
    const ConstrainedOrder order(ground, test::mode_of(scene));
    expect_same_orders(truth, order);
    expect_same_triangulations(truth, order);
    expect_same_greedy(truth, order);
  }
}

}  // namespace
}  // namespace thalweg
