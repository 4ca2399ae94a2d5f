// Pits of two lattices that differ in a diagonal.
#include "support/meshes.hpp"

#include <thalweg/terrain/pit_changes.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

namespace thalweg {
namespace {

using test::make_tin;
using test::triangle;
using testing::ElementsAre;
using testing::IsEmpty;

// 4 x 4 vertices, row by row. The cell of vertices 5, 6, 9, 10 has the diagonal 5-10 or 6-9.
Tin lattice(const std::vector<double>& heights, bool rising) {
  std::vector<Point2> points;
  std::vector<Triangle> triangles;
  for (std::size_t i = 0; i < 16; ++i)
    points.push_back({static_cast<double>(i % 4), static_cast<double>(i / 4)});
  for (std::size_t a : {0, 1, 2, 4, 5, 6, 8, 9, 10}) {
    const bool up = a == 5 && rising;
    triangles.push_back(up ? triangle(a, a + 1, a + 5) : triangle(a, a + 1, a + 4));
    triangles.push_back(up ? triangle(a, a + 5, a + 4) : triangle(a + 1, a + 5, a + 4));
  }
  return make_tin(std::move(points), std::move(triangles), {}, heights);
}

const std::vector<double> kTwoSinks = {9, 9, 9, 9,  //
                                       9, 1, 5, 9,  //
                                       9, 5, 2, 9,  //
                                       9, 9, 9, 9};

TEST(ComparePits, ADiagonalThatDrainsASinkRemovesIt) {
  const PitChanges changes = compare_pits(lattice(kTwoSinks, false), lattice(kTwoSinks, true));
  EXPECT_THAT(changes.removed, ElementsAre(VertexId{10}));
  EXPECT_THAT(changes.left, ElementsAre(VertexId{5}));
  EXPECT_THAT(changes.added, IsEmpty());
}

TEST(ComparePits, TheOtherWayRoundItIsNew) {
  const PitChanges changes = compare_pits(lattice(kTwoSinks, true), lattice(kTwoSinks, false));
  EXPECT_THAT(changes.removed, IsEmpty());
  EXPECT_THAT(changes.left, ElementsAre(VertexId{5}));
  EXPECT_THAT(changes.added, ElementsAre(VertexId{10}));
}

TEST(ComparePits, APlateauThatFallsApartIsLeft) {
  std::vector<double> level = kTwoSinks;
  level[10] = 1;
  const PitChanges changes = compare_pits(lattice(level, true), lattice(level, false));
  EXPECT_THAT(changes.removed, IsEmpty());
  EXPECT_THAT(changes.left, ElementsAre(VertexId{5}, VertexId{10}));
  EXPECT_THAT(changes.added, IsEmpty());
}

}  // namespace
}  // namespace thalweg
