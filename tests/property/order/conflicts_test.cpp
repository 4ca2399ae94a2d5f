// Conflicts of first-order diagonals, against all triangulations of the oracle.
#include <thalweg/order/conflicts.hpp>

#include <gtest/gtest.h>
#include <support/oracle/law_testing.hpp>
#include <support/oracle/scene_file.hpp>
#include <support/oracle/triangulations.hpp>
#include <support/scene_tin.hpp>

#include <algorithm>
#include <set>
#include <vector>

namespace thalweg {
namespace {

using oracle::Edge;
using oracle::edge_of;
using oracle::Oracle;

constexpr oracle::SceneOptions kSmall{.fewest = 4, .most = 9, .constraints = 6};
using Edges = std::set<Edge>;

Edge edge(VertexId a, VertexId b) {
  return edge_of(static_cast<int>(a.value()), static_cast<int>(b.value()));
}

Edges edges_of(const Tin& tin) {
  Edges edges;
  for (const Triangle& t : tin.triangles()) {
    for (std::size_t i = 0; i < 3; ++i) edges.insert(edge(t[i], t[(i + 1) % 3]));
  }
  return edges;
}

/// The triangulations that flips without conflict make, as sets of edges.
std::set<Edges> by_flips(const Tin& ground, const std::vector<Quadrilateral>& quadrilaterals) {
  const auto conflicts = find_conflicts(ground, quadrilaterals);
  const Edges delaunay = edges_of(ground);
  std::set<Edges> found;
  for (std::size_t flips = 0; flips < std::size_t{1} << quadrilaterals.size(); ++flips) {
    const auto flipped = [flips](std::size_t i) { return (flips >> i & 1U) != 0; };
    if (std::any_of(conflicts.begin(), conflicts.end(),
                    [&](const QuadrilateralConflict& c) { return flipped(c.first) && flipped(c.second); })) {
      continue;
    }
    Edges edges = delaunay;
    for (std::size_t i = 0; i < quadrilaterals.size(); ++i) {
      const Quadrilateral& q = quadrilaterals[i];
      if (!flipped(i)) continue;
      edges.erase(edge(q.u, q.v));
      edges.insert(edge(q.s, q.t));
    }
    found.insert(edges);
  }
  return found;
}

/// All triangulations of order at most k by enumeration, as sets of edges.
std::set<Edges> by_enumeration(const oracle::Enumeration& all, OrderDefinition definition, int k = 1) {
  std::set<Edges> found;
  for (const std::size_t i : all.of_order(static_cast<oracle::Definition>(definition), k)) {
    std::vector<oracle::Corners> triangles;
    for (const int t : all.members[i]) triangles.push_back(all.triangles[static_cast<std::size_t>(t)]);
    const std::vector<Edge> edges = oracle::edges_of(triangles);
    found.emplace(edges.begin(), edges.end());
  }
  return found;
}

std::vector<Quadrilateral> quadrilaterals_of(const Tin& ground, const oracle::Scene& scene,
                                             OrderDefinition definition) {
  return find_quadrilaterals(ground, {.definition = definition, .mode = test::mode_of(scene)}, Progress());
}

// Laws 1 and 2.
TEST(Conflicts, FlipsWithoutConflictAreTheTriangulationsOfDelaunayEdgesAndOtherDiagonals) {
  for_each_scene(oracle::kStreams, 40, kSmall, [](const Oracle& oracle) {
    const oracle::Enumeration all = enumerate(oracle);
    const Tin ground = test::ground_of(oracle.scene());
    for (const OrderDefinition definition : {OrderDefinition::Sees3vtx, OrderDefinition::EmptyQuad}) {
      const auto quadrilaterals = quadrilaterals_of(ground, oracle.scene(), definition);
      Edges allowed = edges_of(ground);
      for (const Quadrilateral& q : quadrilaterals) allowed.insert(edge(q.s, q.t));
      std::set<Edges> expected = by_enumeration(all, definition);
      std::erase_if(expected, [&](const Edges& edges) {
        return !std::includes(allowed.begin(), allowed.end(), edges.begin(), edges.end());
      });
      ASSERT_EQ(by_flips(ground, quadrilaterals), expected) << definition_name(definition);
    }
  });
}

TEST(Conflicts, ThereAreNoneUnderSeesOppAndStronger) {
  for_each_scene(oracle::kStreams, 60, {.fewest = 4, .most = 16, .constraints = 8}, [](const Oracle& oracle) {
    const Tin ground = test::ground_of(oracle.scene());
    for (const OrderDefinition definition : kOrderDefinitions) {
      if (definition == OrderDefinition::Sees3vtx || definition == OrderDefinition::EmptyQuad) continue;
      ASSERT_TRUE(find_conflicts(ground, quadrilaterals_of(ground, oracle.scene(), definition)).empty());
    }
  });
}

// Each conflict is a pair of quadrilaterals with three corners in common, the shared triangle's.
TEST(Conflicts, ShareATriangle) {
  for_each_scene(oracle::kStreams, 60, {.fewest = 4, .most = 16, .constraints = 8}, [](const Oracle& oracle) {
    const Tin ground = test::ground_of(oracle.scene());
    const auto quadrilaterals = quadrilaterals_of(ground, oracle.scene(), OrderDefinition::EmptyQuad);
    const auto corners = [&](std::size_t i) {
      const Quadrilateral& q = quadrilaterals[i];
      return std::set<VertexId>{q.s, q.u, q.t, q.v};
    };
    std::vector<QuadrilateralConflict> expected;
    for (std::size_t i = 0; i < quadrilaterals.size(); ++i) {
      for (std::size_t j = i + 1; j < quadrilaterals.size(); ++j) {
        for (std::size_t t = 0; t < ground.triangle_count(); ++t) {
          const Triangle& triangle = ground.triangle(TriangleId{t});
          const std::set<VertexId> three(triangle.begin(), triangle.end()), one = corners(i),
                                                                            other = corners(j);
          if (std::includes(one.begin(), one.end(), three.begin(), three.end()) &&
              std::includes(other.begin(), other.end(), three.begin(), three.end())) {
            expected.push_back({static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(j), TriangleId{t}});
          }
        }
      }
    }
    ASSERT_EQ(find_conflicts(ground, quadrilaterals), expected);
  });
}

/// Which edges exclude which, by definition; as find_edge_conflicts lists them.
std::vector<EdgeConflict> excluded(const std::set<Edges>& triangulations, const oracle::Scene& scene) {
  Edges useful;
  std::set<std::pair<Edge, Edge>> together;
  for (const Edges& edges : triangulations) {
    useful.insert(edges.begin(), edges.end());
    for (const Edge& one : edges) {
      for (const Edge& other : edges) together.emplace(one, other);
    }
  }
  const auto side = [&](Edge e, int v) {
    return oracle::sign_of(oracle::turn(scene.at(e.first), scene.at(e.second), scene.at(v)));
  };
  std::vector<EdgeConflict> conflicts;
  for (const Edge& one : useful) {
    for (const Edge& other : useful) {
      if (!(one < other) || together.contains({one, other})) continue;
      const bool crossing = side(one, other.first) * side(one, other.second) < 0 &&
                            side(other, one.first) * side(other, one.second) < 0;
      conflicts.push_back({test::vertex(one.first), test::vertex(one.second), test::vertex(other.first),
                           test::vertex(other.second), crossing});
    }
  }
  return conflicts;
}

EdgeConflicts edge_conflicts(const Tin& ground, const oracle::Scene& scene, OrderDefinition definition,
                             std::size_t k) {
  Progress progress;
  const ConstrainedOrder order(ground, test::mode_of(scene));
  const auto faces = find_fixed_faces(
      ground, find_order_triangles(order, {.definition = definition, .max_order = k}, progress), {},
      progress);
  return faces ? find_edge_conflicts(*faces, {}, progress) : EdgeConflicts{};
}

// Law 1, of which law 2 is a part: under every definition, for k = 1 and 2.
TEST(EdgeConflicts, AreThePairsThatNoTriangulationHolds) {
  for_each_scene(oracle::kStreams, 20, kSmall, [](const Oracle& oracle) {
    const oracle::Enumeration all = enumerate(oracle);
    const Tin ground = test::ground_of(oracle.scene());
    for (const OrderDefinition definition : kOrderDefinitions) {
      for (const int k : {1, 2}) {
        const EdgeConflicts found =
            edge_conflicts(ground, oracle.scene(), definition, static_cast<std::size_t>(k));
        ASSERT_EQ(found.undecided_faces, 0U);
        ASSERT_EQ(found.pairs, excluded(by_enumeration(all, definition, k), oracle.scene()))
            << definition_name(definition) << ", k = " << k;
      }
    }
  });
}

// Up to SeesOpp each quadrilateral is one pair, and there are no others.
TEST(EdgeConflicts, AreTheTwoDiagonalsOfQuadrilateralsUpToSeesOpp) {
  for_each_scene(oracle::kStreams, 40, {.fewest = 4, .most = 16, .constraints = 8}, [](const Oracle& oracle) {
    const Tin ground = test::ground_of(oracle.scene());
    for (const OrderDefinition definition : kOrderDefinitions) {
      if (definition == OrderDefinition::Sees3vtx || definition == OrderDefinition::EmptyQuad) continue;
      std::vector<EdgeConflict> expected;
      for (const Quadrilateral& q : quadrilaterals_of(ground, oracle.scene(), definition)) {
        const Edge one = std::min(edge(q.s, q.t), edge(q.u, q.v));
        const Edge other = std::max(edge(q.s, q.t), edge(q.u, q.v));
        expected.push_back({test::vertex(one.first), test::vertex(one.second), test::vertex(other.first),
                            test::vertex(other.second), true});
      }
      std::sort(expected.begin(), expected.end());
      ASSERT_EQ(edge_conflicts(ground, oracle.scene(), definition, 1).pairs, expected)
          << definition_name(definition);
    }
  });
}

// Where a face has too many triangulations, the pairs that cross remain.
TEST(EdgeConflicts, SayWhereTheyStop) {
  const oracle::SceneFile file = oracle::read_scene(THALWEG_SOURCE_DIR "/tests/support/scenes", "figure-17");
  const Tin ground = test::ground_of(file.scene);
  const ConstrainedOrder order(ground, test::mode_of(file.scene));
  Progress progress;
  const auto faces = find_fixed_faces(
      ground,
      find_order_triangles(order, {.definition = OrderDefinition::Sees3vtx, .max_order = 1}, progress), {},
      progress);
  ASSERT_TRUE(faces.has_value());
  const EdgeConflicts cut = find_edge_conflicts(*faces, {.most = 2}, progress);
  EXPECT_GT(cut.undecided_faces, 0U);
  EXPECT_FALSE(cut.pairs.empty());
  for (const EdgeConflict& pair : cut.pairs) EXPECT_TRUE(pair.crossing);
}

// Figure 17: a chain of seven; its flips without conflict, subsets of a path without neighbours, are all
// first-order triangulations.
TEST(Conflicts, Figure17) {
  const oracle::SceneFile file = oracle::read_scene(THALWEG_SOURCE_DIR "/tests/support/scenes", "figure-17");
  const Tin ground = test::ground_of(file.scene);
  const auto quadrilaterals = quadrilaterals_of(ground, file.scene, OrderDefinition::Sees3vtx);
  EXPECT_EQ(quadrilaterals.size(), 7U);
  EXPECT_EQ(find_conflicts(ground, quadrilaterals).size(), 6U);
  const auto flips = by_flips(ground, quadrilaterals);
  EXPECT_EQ(flips.size(), 34U);
  const auto first_order = by_enumeration(enumerate(Oracle(file.scene)), OrderDefinition::Sees3vtx);
  EXPECT_TRUE(std::includes(first_order.begin(), first_order.end(), flips.begin(), flips.end()));
}

}  // namespace
}  // namespace thalweg
