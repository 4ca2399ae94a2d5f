// The oracle on examples whose answers are known by hand.
#include <gtest/gtest.h>
#include <support/oracle/orders.hpp>
#include <support/oracle/triangulations.hpp>

#include <algorithm>

namespace thalweg::oracle {
namespace {

Scene scene_of(std::vector<Site> sites, std::vector<Edge> constraints, std::vector<Edge> boundary = {}) {
  Scene scene{std::move(sites), {}, {}};
  for (const auto& [a, b] : constraints) scene.constraints.push_back(edge_of(a, b));
  for (const auto& [a, b] : boundary) scene.boundary.push_back(edge_of(a, b));
  EXPECT_EQ(defect(scene), "");
  return scene;
}

TEST(OracleExact, TieRuleAgreesWithItsFourCases) {
  // The corners of a square in lexicographic order: (0,0) (0,2) (2,0) (2,2).
  const Site a{0, 0}, b{2, 0}, c{2, 2}, d{0, 2};
  EXPECT_FALSE(member_of_circle(d, a, b, c)) << "the largest of four cocircular sites is outside";
  EXPECT_TRUE(member_of_circle(c, d, a, b)) << "so the diagonal from it is Delaunay, and the other is not";
  EXPECT_FALSE(member_of_circle(b, c, d, a));
  EXPECT_TRUE(member_of_circle(a, b, c, d));
}

TEST(OracleExact, TangencyIsNoEntry) {
  const Site u{-5, 0}, v{5, 0}, w{0, 5};  // circle of radius 5 about the origin
  EXPECT_FALSE(enters_open_disc(u, v, w, {-4, -5}, {4, -5})) << "tangent";
  EXPECT_TRUE(enters_open_disc(u, v, w, {-20, -4}, {20, -4})) << "chord, both ends outside";
  EXPECT_TRUE(enters_open_disc(u, v, w, {3, 4}, {-3, 4})) << "chord, both ends on the circle";
  EXPECT_FALSE(enters_open_disc(u, v, w, {3, 4}, {6, 8})) << "radial, from the circle outward";
  EXPECT_TRUE(enters_open_disc(u, v, w, {3, 4}, {-40, 0})) << "from the circle inward and through";
  EXPECT_FALSE(enters_open_disc(u, v, w, {7, 0}, {40, 1})) << "points towards the disc, ends before";
}

TEST(OracleSight, EndsOfConstraintsBlockOtherVerticesDoNot) {
  const Scene scene = scene_of({{0, 0}, {10, 0}, {5, 0}, {5, 5}, {0, 10}, {10, 10}, {5, 10}}, {{2, 3}});
  EXPECT_FALSE(sees(scene, 0, 1)) << "through 2, an end of 2-3";
  EXPECT_TRUE(sees(scene, 4, 5)) << "through 6, an end of nothing";
  EXPECT_TRUE(sees(scene, 2, 3)) << "a constraint edge";
  EXPECT_FALSE(sees(scene, 2, 6)) << "overlaps 2-3, whose end 3 lies between";
  EXPECT_TRUE(sees(scene, 3, 6));
  EXPECT_FALSE(sees(scene, 0, 5)) << "through 3";
}

TEST(OracleValidity, TellsTheReason) {
  const Oracle plane(
      scene_of({{0, 0}, {10, 0}, {5, 8}, {5, 2}, {20, 0}, {5, 0}, {-2, 6}, {12, 6}}, {{6, 7}}));
  EXPECT_EQ(plane.validity({0, 1, 4}), Validity::Flat);
  EXPECT_EQ(plane.validity({0, 1, 2}), Validity::Occupied);
  EXPECT_EQ(plane.validity({0, 1, 3}), Validity::Occupied) << "5 lies on a side";
  EXPECT_EQ(plane.validity({3, 1, 2}), Validity::Crossed);
  EXPECT_EQ(plane.validity({0, 5, 3}), Validity::Valid);
  const Oracle ground(scene_of({{0, 0}, {10, 0}, {10, 10}, {5, 2}}, {{0, 1}, {1, 2}, {2, 3}, {0, 3}},
                               {{0, 1}, {1, 2}, {2, 3}, {0, 3}}));
  EXPECT_EQ(ground.validity({0, 2, 3}), Validity::OffGround);
  EXPECT_EQ(ground.validity({0, 1, 3}), Validity::Valid);
}

// Theory, section 3: the flood outside the hull passes round a hull vertex only inside the disc.
TEST(OracleOrders, PathsOutsideTheHull) {
  const Oracle oracle(scene_of({{0, 23}, {11, 9}, {0, 15}, {29, 16}, {20, 4}, {26, 5}}, {{3, 5}, {0, 5}}));
  EXPECT_EQ(oracle.order({0, 2, 5}, Definition::Pathcon), 2);
  EXPECT_EQ(oracle.order({0, 2, 5}, Definition::Std), 3);
}

// Theory, section 3: a sight that leaves the ground which paths from the triangle reach.
TEST(OracleOrders, SightThroughUnreachedGround) {
  // u v w p c d a b
  const Oracle oracle(
      scene_of({{0, 0}, {100, 0}, {50, -50}, {50, 40}, {30, 10}, {51, 80}, {27, 16}, {15, 31}},
               {{3, 4}, {0, 4}, {3, 5}, {6, 7}}));
  EXPECT_EQ(oracle.order({0, 1, 2}, Definition::Sees3Vtx), 1);
}

// Theory, section 1: in polygon mode a sight may not leave the ground, which Lemma 2 needs.
TEST(OracleOrders, SightThroughTheOutside) {
  // w v p q u
  const std::vector<Edge> ring{{0, 1}, {1, 2}, {2, 3}, {3, 4}, {0, 4}};
  const std::vector<Site> sites{{20, -20}, {40, 0}, {20, 10}, {10, 3}, {0, 0}};
  const Oracle polygon(scene_of(sites, ring, ring));
  EXPECT_FALSE(polygon.sees(2, 4));
  EXPECT_EQ(polygon.order({4, 1, 0}, Definition::Sees3Vtx), polygon.order({4, 1, 0}, Definition::EmptyQuad));
  const Oracle plane(scene_of(sites, ring));
  EXPECT_TRUE(plane.sees(2, 4));
  EXPECT_EQ(plane.counted({4, 1, 0}, Definition::Sees3Vtx), SiteSet{1} << 2 | SiteSet{1} << 3);
  EXPECT_EQ(plane.counted({4, 1, 0}, Definition::EmptyQuad), SiteSet{1} << 3) << "q lies in triangle u v p";
}

// Theory, section 2: the paper's Corollary 1 and Lemma 3 fail for sees-triang and sees-vtx at k = 2.
TEST(OracleUseful, Corollary1FailsForSeesTriangAndSeesVtx) {
  const Oracle oracle(
      scene_of({{15, 36}, {6, 21}, {40, 39}, {3, 9}, {33, 33}, {43, 33}, {18, 37}}, {{0, 4}}));
  const Enumeration all = enumerate(oracle);
  for (const Definition definition : {Definition::SeesTriang, Definition::SeesVtx}) {
    EXPECT_EQ(oracle.order({0, 5, 6}, definition), 3) << name_of(definition);
    EXPECT_EQ(all.useful_orders(definition).at({0, 5}), 2) << name_of(definition);
  }
  const std::vector<Corners> greedy = greedy_triangles(oracle, {0, 5});
  EXPECT_NE(std::find_if(greedy.begin(), greedy.end(),
                         [](Corners t) {
                           std::sort(t.begin(), t.end());
                           return t == Corners{0, 5, 6};
                         }),
            greedy.end())
      << "0, 5, 6 is the triangle that the corollary tests";
}

}  // namespace
}  // namespace thalweg::oracle
