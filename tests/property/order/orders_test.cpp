// Orders, validity, sight and quadrilaterals of the library against the brute-force oracle, on random scenes.
#include <thalweg/order/constrained_order.hpp>
#include <thalweg/order/quadrilaterals.hpp>

#include <gtest/gtest.h>
#include <support/oracle/law_testing.hpp>
#include <support/oracle/triangulations.hpp>
#include <support/scene_tin.hpp>

#include <algorithm>

namespace thalweg {
namespace {

using oracle::Corners;
using oracle::Definition;
using oracle::Dice;
using oracle::Oracle;
using oracle::Scene;
using oracle::SceneOptions;

constexpr OrderDefinition library(Definition definition) {
  return kOrderDefinitions[static_cast<std::size_t>(definition)];
}

std::vector<VertexId> listed(oracle::SiteSet set) {
  std::vector<VertexId> vertices;
  for (int v = 0; v < oracle::kMaxSites; ++v) {
    if ((set >> v & 1U) != 0) vertices.push_back(test::vertex(v));
  }
  return vertices;
}

// The oracle looks where the centroid lies before it looks for crossings; the library names a crossing if one
// exists.
bool same_fault(TriangleFault fault, oracle::Validity truth) {
  switch (truth) {
    case oracle::Validity::Valid:
      return fault == TriangleFault::None;
    case oracle::Validity::Flat:
      return fault == TriangleFault::Flat;
    case oracle::Validity::Occupied:
      return fault == TriangleFault::Occupied;
    case oracle::Validity::Crossed:
      return fault == TriangleFault::Crossed;
    case oracle::Validity::OffGround:
      return fault == TriangleFault::Crossed || fault == TriangleFault::Outside;
  }
  return false;
}

void expect_same_validity(const Oracle& truth, const ConstrainedOrder& order, OrderWorkspace& workspace) {
  const int n = truth.scene().size();
  for (int a = 0; a < n; ++a) {
    for (int b = 0; b < n; ++b) {
      if (a == b) continue;
      EXPECT_EQ(order.sees(test::vertex(a), test::vertex(b)), truth.sees(a, b)) << a << " sees " << b;
      for (int c = a + 1; c < n; ++c) {
        if (b < a || c <= b) continue;
        const auto fault = order.validity(test::triangle({a, b, c}), workspace).fault;
        EXPECT_TRUE(same_fault(fault, truth.validity({a, b, c}))) << a << ' ' << b << ' ' << c;
        EXPECT_EQ(order.is_valid(test::triangle({c, b, a}), workspace), fault == TriangleFault::None);
      }
    }
  }
}

void expect_same_orders(const Oracle& truth, const ConstrainedOrder& order, OrderWorkspace& workspace) {
  for (const Corners& corners : truth.valid_triangles()) {
    const Triangle t = test::triangle(corners);
    const auto expected = truth.counted(corners);
    for (const Definition definition : oracle::kDefinitions) {
      const auto vertices = listed(expected[static_cast<std::size_t>(definition)]);
      EXPECT_EQ(order.counted(t, library(definition), workspace), vertices)
          << oracle::name_of(definition) << " of " << corners[0] << ' ' << corners[1] << ' ' << corners[2];
      for (std::size_t k = 0; k < 4; ++k) {
        EXPECT_EQ(order.at_most(t, library(definition), k, workspace), vertices.size() <= k);
      }
    }
  }
}

void expect_same_quadrilaterals(const Oracle& truth, const Tin& ground) {
  for (const Definition definition : oracle::kDefinitions) {
    if (definition >= Definition::Sees3Vtx) continue;
    const QuadrilateralOptions options{.definition = library(definition),
                                       .mode = test::mode_of(truth.scene())};
    std::vector<oracle::Quadrilateral> found;
    for (const Quadrilateral& q : find_quadrilaterals(ground, options, Progress())) {
      std::array<int, 4> corners{static_cast<int>(q.s.value()), static_cast<int>(q.u.value()),
                                 static_cast<int>(q.t.value()), static_cast<int>(q.v.value())};
      const oracle::Edge diagonal = oracle::edge_of(corners[1], corners[3]);
      std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
      found.push_back({corners, diagonal});
    }
    std::sort(found.begin(), found.end());
    EXPECT_EQ(found, oracle::first_order_quadrilaterals(truth, definition)) << oracle::name_of(definition);
  }
}

using MakeScene = Scene (*)(Dice&, const SceneOptions&);

void compare(MakeScene make, const SceneOptions& options, int scenes) {
  Dice dice(testing::UnitTest::GetInstance()->current_test_info()->name());
  OrderWorkspace workspace;
  for (int i = 0; i < scenes * THALWEG_SCENE_FACTOR && !testing::Test::HasFailure(); ++i) {
    const Scene scene = make(dice, options);
    SCOPED_TRACE(oracle::to_text(scene));
    const Oracle truth(scene);
    const Tin ground = test::ground_of(scene);
    const ConstrainedOrder order(ground, test::mode_of(scene));
    expect_same_validity(truth, order, workspace);
    expect_same_orders(truth, order, workspace);
    expect_same_quadrilaterals(truth, ground);
  }
}

TEST(Orders, AgreeInGeneralPosition) {
  compare(oracle::random_scene, {.most = 16, .constraints = 10}, 120);
}
TEST(Orders, AgreeOnLattices) {
  compare(oracle::random_lattice_scene, {.most = 16, .range = 5, .constraints = 8}, 120);
}
TEST(Orders, AgreeOnCirclesAndTheirTangents) {
  compare(oracle::random_circle_scene, {.most = 16, .constraints = 8}, 100);
}
TEST(Orders, AgreeInPolygons) {
  compare(oracle::random_polygon, {.most = 14}, 100);
}
TEST(Orders, AgreeOnGroundsWithHoles) {
  compare(oracle::random_ground, {.most = 16}, 80);
}

}  // namespace
}  // namespace thalweg
