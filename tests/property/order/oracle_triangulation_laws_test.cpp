// Laws about whole triangulations, by enumerating all of them.
#include <support/oracle/law_testing.hpp>
#include <support/oracle/triangulations.hpp>

#include <set>

namespace thalweg::oracle {
namespace {

constexpr auto index(Definition d) {
  return static_cast<std::size_t>(d);
}
constexpr SceneOptions kSmall{.fewest = 4, .most = 9, .constraints = 6};

std::vector<Corners> triangles_of(const Enumeration& all, std::size_t triangulation) {
  std::vector<Corners> found;
  for (const int t : all.members[triangulation]) found.push_back(all.triangles[static_cast<std::size_t>(t)]);
  return found;
}

Scene with_constraint(Scene scene, Edge edge) {
  if (!scene.constrained(edge.first, edge.second)) scene.constraints.push_back(edge);
  std::sort(scene.constraints.begin(), scene.constraints.end());
  return scene;
}

// Property 1: at k = 0 there is one triangulation, the constrained Delaunay triangulation.
TEST(OracleTriangulationLaws, Property1) {
  for_each_scene(kStreams, 60, kSmall, [](const Oracle& oracle) {
    const Enumeration all = enumerate(oracle);
    for (const Definition d : kDefinitions) {
      if (d == Definition::Std) continue;
      const auto first = all.of_order(d, 0);
      ASSERT_EQ(first.size(), 1U) << name_of(d);
      ASSERT_EQ(triangles_of(all, first[0]), delaunay_triangles(oracle)) << name_of(d);
    }
  });
}

// Section 2: the recursion of the paper's greedy triangulation gives the Delaunay triangulation with the edge
// as one more constraint.
TEST(OracleTriangulationLaws, GreedyIsDelaunayWithTheEdgeConstrained) {
  for_each_scene(kStreams, 60, kSmall, [](const Oracle& oracle) {
    for (const Edge& e : edges_of(oracle.valid_triangles())) {
      ASSERT_EQ(greedy_triangles(oracle, e), delaunay_triangles(Oracle(with_constraint(oracle.scene(), e))))
          << e.first << "-" << e.second;
    }
  });
}

int largest_order(const Oracle& oracle, const std::vector<Corners>& triangles, Definition d) {
  int largest = 0;
  for (const Corners& t : triangles) largest = std::max(largest, oracle.order(t, d));
  return largest;
}

// Of the triangles at the edge alone, as Lemma 3 and Corollary 1 ask.
int largest_order_at(const Oracle& oracle, std::vector<Corners> triangles, Edge e, Definition d) {
  std::erase_if(triangles, [e](const Corners& t) {
    return std::find(t.begin(), t.end(), e.first) == t.end() ||
           std::find(t.begin(), t.end(), e.second) == t.end();
  });
  return largest_order(oracle, triangles, d);
}

template <class Law>
void for_each_useful_edge(std::initializer_list<Definition> definitions, const Law& law) {
  for_each_scene(kStreams, 60, kSmall, [&](const Oracle& oracle) {
    const Enumeration all = enumerate(oracle);
    for (const Definition d : definitions) {
      for (const auto& [edge, k] : all.useful_orders(d)) {
        law(oracle, edge, d, k);
        ASSERT_FALSE(testing::Test::HasFailure())
            << name_of(d) << " edge " << edge.first << "-" << edge.second;
      }
    }
  });
}

// Lemma 3: a useful edge's two greedy triangles are of order at most k.
TEST(OracleTriangulationLaws, Lemma3) {
  for_each_useful_edge({Definition::SeesOpp, Definition::ConfEdge, Definition::Pathcon},
                       [](const Oracle& oracle, Edge e, Definition d, int k) {
                         EXPECT_GE(k, largest_order_at(oracle, greedy_triangles(oracle, e), e, d));
                       });
}

// Lemma 4: the greedy triangulation is of the order at which the edge is useful.
TEST(OracleTriangulationLaws, Lemma4) {
  for_each_useful_edge({Definition::SeesOpp, Definition::ConfEdge},
                       [](const Oracle& oracle, Edge e, Definition d, int k) {
                         EXPECT_EQ(k, largest_order(oracle, greedy_triangles(oracle, e), d));
                       });
}

// Corollary 1: for pathcon the two triangles decide.
TEST(OracleTriangulationLaws, Corollary1) {
  for_each_useful_edge({Definition::Pathcon}, [](const Oracle& oracle, Edge e, Definition d, int k) {
    EXPECT_EQ(k, largest_order_at(oracle, greedy_triangles(oracle, e), e, d));
  });
}

// Corollary 1, the half of it that is true for sees-triang and sees-vtx: two triangles of order k are
// sufficient.
TEST(OracleTriangulationLaws, Corollary1IsSufficientForSights) {
  for_each_useful_edge({Definition::SeesTriang}, [](const Oracle& oracle, Edge e, Definition d, int k) {
    EXPECT_LE(k, largest_order_at(oracle, greedy_triangles(oracle, e), e, d));
  });
}

// Lemma 7 and the fast rule of section 6: the first-order triangulations are the fixed edges and a free
// choice of diagonal in each quadrilateral.
TEST(OracleTriangulationLaws, Lemma7) {
  for_each_scene(kStreams, 60, kSmall, [](const Oracle& oracle) {
    const Enumeration all = enumerate(oracle);
    for (const Definition d : {Definition::Std, Definition::Pathcon, Definition::SeesTriang,
                               Definition::SeesVtx, Definition::ConfEdge, Definition::SeesOpp}) {
      const auto first = all.of_order(d, 1);
      const auto quadrilaterals = first_order_quadrilaterals(oracle, d);
      if (d == Definition::Std && largest_order(oracle, delaunay_triangles(oracle), d) > 1) {
        ASSERT_TRUE(first.empty());
        continue;
      }
      std::set<Edge> expected_free;
      for (const Quadrilateral& q : quadrilaterals) {
        expected_free.insert({edge_of(q.corners[0], q.corners[2]), edge_of(q.corners[1], q.corners[3])});
      }
      ASSERT_EQ(expected_free.size(), 2 * quadrilaterals.size());
      std::map<Edge, std::size_t> uses;
      for (const std::size_t i : first) {
        for (const Edge& e : edges_of(triangles_of(all, i))) ++uses[e];
      }
      std::set<Edge> free;
      for (const auto& [e, count] : uses) {
        if (count < first.size()) free.insert(e);
      }
      ASSERT_EQ(free, expected_free) << name_of(d);
      ASSERT_EQ(first.size(), std::size_t{1} << quadrilaterals.size()) << name_of(d);
    }
  });
}

// Corollary 2: the chain of inclusions of first-order triangulations, with its two equalities.
TEST(OracleTriangulationLaws, Corollary2) {
  for_each_scene(kStreams, 60, kSmall, [](const Oracle& oracle) {
    const Enumeration all = enumerate(oracle);
    const auto first = [&](Definition d) { return all.of_order(d, 1); };
    using enum Definition;
    constexpr std::array kChain{Std, Pathcon, SeesTriang, ConfEdge, Sees3Vtx, EmptyQuad};
    for (std::size_t i = 1; i < kChain.size(); ++i) {
      const auto strong = first(kChain[i - 1]), weak = first(kChain[i]);
      ASSERT_TRUE(std::includes(weak.begin(), weak.end(), strong.begin(), strong.end()))
          << name_of(kChain[i]);
    }
    ASSERT_EQ(first(SeesTriang), first(SeesVtx));
    ASSERT_EQ(first(ConfEdge), first(SeesOpp));
  });
}

// With constraints the standard order may admit no triangulation at all; at k <= 1 one exists if and only if
// the Delaunay triangulation's own order is at most k.
TEST(OracleTriangulationLaws, StandardOrderAtMostOne) {
  for_each_scene(kStreams, 60, kSmall, [](const Oracle& oracle) {
    const Enumeration all = enumerate(oracle);
    const int own = largest_order(oracle, delaunay_triangles(oracle), Definition::Std);
    for (const int k : {0, 1}) ASSERT_EQ(!all.of_order(Definition::Std, k).empty(), own <= k) << k;
  });
}

}  // namespace
}  // namespace thalweg::oracle
