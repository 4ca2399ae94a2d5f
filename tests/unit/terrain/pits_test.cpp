// Pits on TINs that can be drawn.
#include "support/meshes.hpp"

#include <thalweg/mesh/change_tin.hpp>
#include <thalweg/terrain/pits.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

namespace thalweg {
namespace {

using test::edge;
using test::make_tin;
using test::triangle;
using testing::Each;
using testing::ElementsAre;

// A lattice of whole coordinates, row by row; diagonals run from lower right to upper left.
Tin lattice(std::size_t columns, const std::vector<double>& heights,
            std::initializer_list<ConstraintEdge> constraints = {}) {
  const std::size_t rows = heights.size() / columns;
  std::vector<Point2> points;
  std::vector<Triangle> triangles;
  for (std::size_t i = 0; i < heights.size(); ++i) {
    points.push_back({static_cast<double>(i % columns), static_cast<double>(i / columns)});
  }
  for (std::size_t y = 0; y + 1 < rows; ++y) {
    for (std::size_t x = 0; x + 1 < columns; ++x) {
      const std::size_t a = y * columns + x;
      triangles.push_back(triangle(a, a + 1, a + columns));
      triangles.push_back(triangle(a + 1, a + columns + 1, a + columns));
    }
  }
  return make_tin(std::move(points), std::move(triangles), constraints, heights);
}

TEST(FindPits, ASinkIsAPit) {
  const PitSummary pits = find_pits(lattice(3, {5, 5, 5,  //
                                                5, 1, 5,  //
                                                5, 5, 5}));
  EXPECT_EQ(pits.interior, 1U);
  EXPECT_EQ(pits.boundary, 0U);
  EXPECT_EQ(pits.lake, 0U);
  EXPECT_THAT(pits.is_pit, ElementsAre(0, 0, 0, 0, 1, 0, 0, 0, 0));
}

TEST(FindPits, ALowVertexOnTheRimIsAnOutlet) {
  const PitSummary pits = find_pits(lattice(3, {5, 1, 5,  //
                                                5, 3, 5,  //
                                                5, 5, 5}));
  EXPECT_EQ(pits.interior, 0U);
  EXPECT_EQ(pits.boundary, 1U);
  EXPECT_THAT(pits.is_pit, ElementsAre(0, 2, 0, 0, 0, 0, 0, 0, 0));
}

TEST(FindPits, APlateauIsOnePit) {
  const PitSummary pits = find_pits(lattice(5, {9, 9, 9, 9, 9,  //
                                                9, 2, 2, 2, 9,  //
                                                9, 9, 9, 9, 9}));
  EXPECT_EQ(pits.interior, 1U);
  EXPECT_THAT(std::vector<int>(pits.is_pit.begin() + 5, pits.is_pit.begin() + 10),
              ElementsAre(0, 1, 1, 1, 0));
}

TEST(FindPits, APlateauWithALowerNeighbourAnywhereIsNone) {
  const PitSummary pits = find_pits(lattice(6, {9, 9, 9, 9, 9, 9,  //
                                                9, 2, 2, 2, 1, 9,  //
                                                9, 9, 9, 9, 9, 9}));
  EXPECT_EQ(pits.interior, 1U);
  EXPECT_EQ(pits.is_pit[7], 0);
  EXPECT_EQ(pits.is_pit[10], 1);
}

TEST(FindPits, OnlyEdgesConnectAPlateau) {
  // The two low vertices face each other across a diagonal of the other direction.
  const PitSummary pits = find_pits(lattice(4, {9, 9, 9, 9,  //
                                                9, 2, 9, 9,  //
                                                9, 9, 2, 9,  //
                                                9, 9, 9, 9}));
  EXPECT_EQ(pits.interior, 2U);
  const PitSummary joined = find_pits(lattice(4, {9, 9, 9, 9,  //
                                                  9, 9, 2, 9,  //
                                                  9, 2, 9, 9,  //
                                                  9, 9, 9, 9}));
  EXPECT_EQ(joined.interior, 1U);
}

TEST(FindPits, APlateauThatReachesTheRimIsAnOutlet) {
  const PitSummary pits = find_pits(lattice(4, {9, 9, 9, 9,  //
                                                9, 2, 2, 2,  //
                                                9, 9, 9, 9}));
  EXPECT_EQ(pits.interior, 0U);
  EXPECT_EQ(pits.boundary, 1U);
  const PitSummary level = find_pits(lattice(3, std::vector<double>(9, 4)));
  EXPECT_EQ(level.boundary, 1U);
  EXPECT_THAT(level.is_pit, Each(2));
}

TEST(FindPits, ALakeIsCountedApart) {
  const std::vector<double> heights{9, 9, 9, 9,  //
                                    9, 2, 2, 9,  //
                                    9, 9, 9, 9};
  const PitSummary lake = find_pits(lattice(4, heights, {edge(5, 6, EdgeKind::Lake)}));
  EXPECT_EQ(lake.lake, 1U);
  EXPECT_EQ(lake.interior, 0U);
  EXPECT_EQ(lake.is_pit[5], 3);
  const PitSummary valley = find_pits(lattice(4, heights, {edge(5, 6, EdgeKind::Valley)}));
  EXPECT_EQ(valley.interior, 1U);
  const PitSummary beside = find_pits(lattice(4, heights, {edge(6, 7, EdgeKind::Lake)}));
  EXPECT_EQ(beside.interior, 1U) << "an edge that leaves the plateau is not of it";
}

TEST(FindPits, HoleRimsAreBoundary) {
  const Tin whole = lattice(4, {9, 9, 9, 9,  //
                                9, 2, 5, 9,  //
                                9, 5, 5, 9,  //
                                9, 9, 9, 9});
  std::vector<bool> keep(whole.triangle_count(), true);
  keep[Tin::triangle_of(whole.find_halfedge(VertexId{5}, VertexId{6})).index()] = false;
  EXPECT_EQ(find_pits(whole).interior, 1U);
  EXPECT_EQ(find_pits(keep_triangles(whole, keep)).interior, 0U);
  EXPECT_EQ(find_pits(keep_triangles(whole, keep)).boundary, 1U);
}

TEST(FindPits, AnUlpMakesAFalsePitAndNoneIsHidden) {
  const double z = 0.1 + 0.2;
  EXPECT_EQ(find_pits(lattice(4, {9, 9, 9, 9, 9, z, 0.3, 9, 9, 9, 9, 9})).interior, 1U);
  EXPECT_EQ(find_pits(lattice(4, {9, 9, 9, 9, 9, z, 0.3, 9, 9, 9, 9, 9})).is_pit[5], 0);
}

TEST(FindPits, WithoutTrianglesThereAreNone) {
  EXPECT_EQ(find_pits(Tin()).interior, 0U);
  const PitSummary pits = find_pits(make_tin({{0, 0}, {1, 0}, {2, 1}}, {}));
  EXPECT_EQ(pits.interior + pits.boundary + pits.lake, 0U);
  EXPECT_THAT(pits.is_pit, Each(0));
}

}  // namespace
}  // namespace thalweg
