// The scenes kept as data: expected values against the oracle and against the library, and what each is there
// for.
#include <thalweg/order/constrained_order.hpp>
#include <thalweg/order/greedy_triangulation.hpp>

#include <gtest/gtest.h>
#include <support/oracle/path_by_slabs.hpp>
#include <support/oracle/scene_file.hpp>
#include <support/oracle/triangulations.hpp>
#include <support/scene_tin.hpp>

#include <algorithm>
#include <bit>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>

namespace thalweg::oracle {
namespace {

const std::string kFolder = THALWEG_SOURCE_DIR "/tests/support/scenes";

SceneFile scene(const std::string& name) {
  return read_scene(kFolder, name);
}

int order(const ExpectedTriangle& t, Definition d) {
  return std::popcount(t.counted[static_cast<std::size_t>(d)]);
}

class Scenes : public testing::TestWithParam<std::string> {};

// Each as its sorted corners, sorted.
std::vector<Corners> as_set(std::vector<Corners> triangles) {
  for (Corners& t : triangles) std::sort(t.begin(), t.end());
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

std::vector<Corners> difference(const std::vector<Corners>& from, const std::vector<Corners>& without) {
  const std::vector<Corners> a = as_set(from), b = as_set(without);
  std::vector<Corners> rest;
  std::set_difference(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(rest));
  return rest;
}

TEST_P(Scenes, OracleGivesTheExpectedAnswers) {
  const SceneFile file = scene(GetParam());
  const Oracle oracle(file.scene);
  for (const ExpectedTriangle& expected : file.triangles) {
    SCOPED_TRACE(expected.why);
    ASSERT_EQ(oracle.validity(expected.corners), expected.validity);
    if (expected.validity != Validity::Valid) continue;
    EXPECT_EQ(oracle.counted(expected.corners), expected.counted);
    const Corners t = file.scene.counter_clockwise(expected.corners);
    for (int p = 0; p < file.scene.size(); ++p) {
      if ((expected.counted[0] >> p & 1U) == 0) continue;
      const bool reached = (expected.counted[static_cast<std::size_t>(Definition::Pathcon)] >> p & 1U) != 0;
      EXPECT_EQ(path_joins_by_slabs(file.scene, t, p), reached) << file.labels[static_cast<std::size_t>(p)];
    }
  }
  if (file.edges.empty()) return;
  const Enumeration all = enumerate(oracle);
  for (const ExpectedEdge& expected : file.edges) {
    for (const auto& [definition, k] : expected.useful) {
      EXPECT_EQ(all.useful_orders(definition).at(expected.edge), k)
          << name_of(definition) << ": " << expected.why;
    }
    if (expected.greedy.empty()) continue;
    const std::vector<Corners> greedy = greedy_triangles(oracle, expected.edge);
    EXPECT_EQ(difference(greedy, delaunay_triangles(oracle)), as_set(expected.greedy));
  }
}

TEST_P(Scenes, LibraryGivesTheExpectedAnswers) {
  const SceneFile file = scene(GetParam());
  const Tin ground = test::ground_of(file.scene);
  const ConstrainedOrder orders(ground, test::mode_of(file.scene));
  OrderWorkspace workspace;
  for (const ExpectedTriangle& expected : file.triangles) {
    SCOPED_TRACE(expected.why);
    const Triangle t = test::triangle(expected.corners);
    const bool valid = expected.validity == Validity::Valid;
    ASSERT_EQ(orders.validity(t, workspace).fault == TriangleFault::None, valid);
    if (!valid) continue;
    for (const Definition d : kDefinitions) {
      SiteSet counted = 0;
      for (const VertexId v : orders.counted(t, kOrderDefinitions[static_cast<std::size_t>(d)], workspace)) {
        counted |= SiteSet{1} << v.index();
      }
      EXPECT_EQ(counted, expected.counted[static_cast<std::size_t>(d)]) << name_of(d);
    }
  }
  for (const ExpectedEdge& expected : file.edges) {
    if (expected.greedy.empty()) continue;
    std::vector<Corners> patch;
    for (const Triangle& t :
         greedy_patch(ground, test::vertex(expected.edge.first), test::vertex(expected.edge.second))
             .triangles) {
      Corners& corners = patch.emplace_back();
      for (std::size_t i = 0; i < 3; ++i) corners[i] = static_cast<int>(t[i].value());
    }
    EXPECT_EQ(as_set(patch), as_set(expected.greedy));
  }
}

TEST_P(Scenes, PictureIsUpToDate) {
  std::stringstream picture;
  picture << std::ifstream(kFolder + "/pictures/" + GetParam() + ".svg").rdbuf();
  EXPECT_EQ(picture.str(), picture_of(scene(GetParam()))) << "draw_scenes tests/support/scenes draws it anew";
}

INSTANTIATE_TEST_SUITE_P(All, Scenes, testing::ValuesIn(scene_names(kFolder)), [](const auto& scene_info) {
  std::string name = scene_info.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

// Each pair of neighbours in Lemma 1 is told apart; the five of Figure 15 at k = 1.
TEST(SceneLaws, NeighboursDiffer) {
  using enum Definition;
  struct Pair {
    const char* name;
    Definition strong, weak;
  };
  for (const Pair& pair : {Pair{"figure-15-std-pathcon", Std, Pathcon},
                           {"figure-15-pathcon-sees-triang", Pathcon, SeesTriang},
                           {"figure-15-sees-vtx-sees-opp", SeesVtx, SeesOpp},
                           {"figure-15-sees-vtx-sees-opp", SeesTriang, ConfEdge},
                           {"figure-15-sees-opp-sees-3vtx", SeesOpp, Sees3Vtx},
                           {"figure-15-sees-3vtx-empty-quad", Sees3Vtx, EmptyQuad}}) {
    const ExpectedTriangle t = scene(pair.name).triangles.at(0);
    EXPECT_LE(order(t, pair.weak), 1) << pair.name;
    EXPECT_GT(order(t, pair.strong), 1) << pair.name;
  }
  const ExpectedTriangle gap = scene("pair-sees-triang-sees-vtx").triangles.at(0);
  EXPECT_GT(order(gap, SeesTriang), order(gap, SeesVtx));
  const ExpectedTriangle through = scene("figure-4-right").triangles.at(0);
  EXPECT_GT(order(through, ConfEdge), order(through, SeesOpp));
  const SceneFile both = scene("incomparable-sees-vtx-conf-edge");
  EXPECT_GT(order(both.triangles.at(0), SeesVtx), order(both.triangles.at(0), ConfEdge));
  EXPECT_LT(order(both.triangles.at(1), SeesVtx), order(both.triangles.at(1), ConfEdge));
}

TEST(SceneLaws, Figure1ForcesATriangleOfTheLargestOrder) {
  const SceneFile file = scene("figure-1");
  const Enumeration all = enumerate(Oracle(file.scene));
  const auto at = std::find(all.triangles.begin(), all.triangles.end(), Corners{0, 2, 1});
  ASSERT_NE(at, all.triangles.end());
  EXPECT_EQ(all.orders[static_cast<std::size_t>(at - all.triangles.begin())][0], file.scene.size() - 3);
  for (const auto& members : all.members) {
    ASSERT_NE(std::find(members.begin(), members.end(), static_cast<int>(at - all.triangles.begin())),
              members.end());
  }
}

TEST(SceneLaws, Figure2HasEightOrders) {
  const ExpectedTriangle t = scene("figure-2").triangles.at(0);
  std::set<int> orders;
  for (const Definition d : kDefinitions) orders.insert(order(t, d));
  EXPECT_EQ(orders.size(), kDefinitionCount);
}

bool counts(const SceneFile& file, const char* label, std::size_t triangle, Definition d) {
  const auto at = std::find(file.labels.begin(), file.labels.end(), label) - file.labels.begin();
  return (file.triangles.at(triangle).counted[static_cast<std::size_t>(d)] >> at & 1U) != 0;
}

// Section 4: along the sweep p is in the circle of all three triangles, of which the second is listed first.
TEST(SceneLaws, Section4SweepMissesSitesThatCountAgain) {
  using enum Definition;
  for (const auto& [name, definitions] : {std::pair("sweep-sees-opp", std::vector{SeesOpp, Sees3Vtx}),
                                          std::pair("sweep-sees-vtx", std::vector{SeesVtx, SeesOpp})}) {
    const SceneFile file = scene(name);
    for (const std::size_t triangle : {0U, 1U, 2U}) EXPECT_TRUE(counts(file, "p", triangle, Std));
    for (const Definition d : definitions) {
      EXPECT_TRUE(counts(file, "p", 1, d)) << name << " " << name_of(d);
      EXPECT_FALSE(counts(file, "p", 0, d)) << name << " " << name_of(d);
      EXPECT_TRUE(counts(file, "p", 2, d)) << name << " " << name_of(d);
    }
  }
}

// Section 6 says that the order under empty-quad can be much larger than under std. It is never larger.
TEST(SceneLaws, Section6EmptyQuadIsNeverLargerThanStd) {
  for (const std::string& name : scene_names(kFolder)) {
    for (const ExpectedTriangle& t : scene(name).triangles) {
      EXPECT_LE(order(t, Definition::EmptyQuad), order(t, Definition::Std)) << name;
    }
  }
  const ExpectedTriangle smaller = scene("figure-3-right").triangles.at(0);
  EXPECT_EQ(order(smaller, Definition::EmptyQuad), 1);
  EXPECT_EQ(order(smaller, Definition::Std), 5);
}

// How far the order jumps when one site passes one criticality. Property 4 allows 1.
int jump(const std::string& name, Definition d) {
  const SceneFile before = scene(name + "-before"), after = scene(name + "-after");
  EXPECT_EQ(before.triangles.at(0).corners, after.triangles.at(0).corners);
  return std::abs(order(after.triangles[0], d) - order(before.triangles[0], d));
}

TEST(SceneLaws, Property4FailsForPathcon) {
  for (const Definition d : kDefinitions) {
    EXPECT_EQ(jump("figure-3-left", d), d == Definition::Pathcon ? 5 : 1) << name_of(d);
  }
}

TEST(SceneLaws, Property4FailsForConfEdgeToo) {
  for (const Definition d : kDefinitions) {
    EXPECT_EQ(jump("property-4-conf-edge", d), d == Definition::ConfEdge ? 2 : 1) << name_of(d);
  }
}

TEST(SceneLaws, Property2FailsForEmptyQuad) {
  const SceneFile file = scene("figure-3-right");
  EXPECT_TRUE(file.scene.constraints.empty());
  EXPECT_EQ(order(file.triangles.at(0), Definition::Std), 5);
  EXPECT_EQ(order(file.triangles.at(0), Definition::EmptyQuad), 1);
}

// Lemma 2, sees-3vtx is empty-quad, takes a simple polygon, and sights that stay in it.
TEST(SceneLaws, Lemma2FailsOutsideSimplePolygons) {
  for (const auto& [name, holds] :
       {std::pair("sight-through-the-outside", true), std::pair("sight-through-the-outside-plane", false),
        std::pair("lemma-2-hole", false)}) {
    const ExpectedTriangle t = scene(name).triangles.at(0);
    EXPECT_EQ(order(t, Definition::Sees3Vtx) == order(t, Definition::EmptyQuad), holds) << name;
  }
}

// The largest order of the greedy triangles at the edge, which Lemma 3 bounds and Corollary 1 asks for.
int corollary(const SceneFile& file, Edge e, Definition d) {
  const Oracle oracle(file.scene);
  int largest = 0;
  for (const Corners& t : greedy_triangles(oracle, e)) {
    const auto has = [&t](int v) { return std::find(t.begin(), t.end(), v) != t.end(); };
    if (has(e.first) && has(e.second)) largest = std::max(largest, oracle.order(t, d));
  }
  return largest;
}

TEST(SceneLaws, Lemma3AndCorollary1WithTheirFailures) {
  struct Case {
    const char* name;
    Definition definition;
    int corollary, useful;
  };
  for (const Case& c : {Case{"corollary-1-sees-triang", Definition::SeesTriang, 3, 2},
                        {"corollary-1-sees-triang", Definition::SeesVtx, 3, 2},
                        {"corollary-1-sees-triang", Definition::Pathcon, 3, 3},
                        {"corollary-1-sees-vtx", Definition::SeesVtx, 2, 3},
                        {"corollary-1-sees-vtx-plane", Definition::SeesVtx, 4, 5},
                        {"lemma-3-std", Definition::Std, 4, 3},
                        {"figure-6", Definition::SeesOpp, 4, 5}}) {
    const SceneFile file = scene(c.name);
    const ExpectedEdge& expected = file.edges.at(0);
    EXPECT_EQ(corollary(file, expected.edge, c.definition), c.corollary) << c.name;
    EXPECT_EQ(expected.useful.at(c.definition), c.useful) << c.name;
  }
}

// Figure 6: the first step's triangle is at the edge, each other one on a side of one before, which the hull
// does not have; the second has a larger order than those at the edge.
TEST(SceneLaws, Figure6GoesStepByStep) {
  const SceneFile file = scene("figure-6");
  const Oracle oracle(file.scene);
  const ExpectedEdge& edge = file.edges.at(0);
  ASSERT_EQ(edge.greedy.size(), 4U);
  std::set<Edge> sides{edge.edge};
  std::vector<int> orders;
  for (const Corners& t : edge.greedy) {
    const std::vector<Edge> own = edges_of({t});
    EXPECT_TRUE(std::any_of(own.begin(), own.end(), [&](const Edge& e) { return sides.contains(e); }));
    sides.insert(own.begin(), own.end());
    orders.push_back(oracle.order(file.scene.counter_clockwise(t), Definition::SeesOpp));
  }
  EXPECT_EQ(orders.at(0), 4);
  EXPECT_EQ(orders.at(1), 5);
  EXPECT_LE(orders.at(2), 4) << "the other triangle at the edge";
  const std::string picture = picture_of(file);
  for (const char* title : {"order 0", "hull of u v", "1: u v s1", "2: u s1 s2", "3: u v e", "4: u e d"}) {
    EXPECT_NE(picture.find(">" + std::string(title) + "<"), std::string::npos) << title;
  }
}

// Figure 17: consecutive quadrilaterals share a triangle, and every set of flips of which no two share a
// triangle gives a triangulation of order 1.
TEST(SceneLaws, Figure17IsAChain) {
  const Oracle oracle(scene("figure-17").scene);
  const auto chain = first_order_quadrilaterals(oracle, Definition::Sees3Vtx);
  ASSERT_EQ(chain.size(), 7U);
  const auto overlap = [](const Quadrilateral& a, const Quadrilateral& b) {
    std::set<int> common(a.corners.begin(), a.corners.end());
    return std::count_if(b.corners.begin(), b.corners.end(), [&](int v) { return common.contains(v); }) == 3;
  };
  std::size_t overlaps = 0;
  for (std::size_t i = 0; i < chain.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) overlaps += overlap(chain[i], chain[j]) ? 1 : 0;
  }
  EXPECT_EQ(overlaps, 6U);
  const Enumeration all = enumerate(oracle);
  std::set<std::vector<Edge>> first_order;
  for (const std::size_t i : all.of_order(Definition::Sees3Vtx, 1)) {
    std::vector<Corners> triangles;
    for (const int t : all.members[i]) triangles.push_back(all.triangles[static_cast<std::size_t>(t)]);
    first_order.insert(edges_of(triangles));
  }
  const std::vector<Edge> delaunay = edges_of(delaunay_triangles(oracle));
  std::size_t choices = 0;
  for (unsigned flips = 0; flips < 1U << chain.size(); ++flips) {
    std::set<Edge> edges(delaunay.begin(), delaunay.end());
    bool apart = true;
    for (std::size_t i = 0; i < chain.size(); ++i) {
      if ((flips >> i & 1U) == 0) continue;
      for (std::size_t j = 0; j < i; ++j)
        apart = apart && ((flips >> j & 1U) == 0 || !overlap(chain[i], chain[j]));
      const auto& q = chain[i].corners;
      const Edge one = edge_of(q[0], q[2]), other = edge_of(q[1], q[3]);
      edges.erase(chain[i].delaunay);
      edges.insert(one == chain[i].delaunay ? other : one);
    }
    if (!apart) continue;
    ++choices;
    EXPECT_TRUE(first_order.contains({edges.begin(), edges.end()})) << flips;
  }
  EXPECT_EQ(choices, 34U) << "subsets of a path of seven without neighbours: a Fibonacci number";
}

}  // namespace
}  // namespace thalweg::oracle
