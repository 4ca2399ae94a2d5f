// What a Tin promises: canonical triangles, halfedges, errors; flips, cuts and outlines.
#include "support/meshes.hpp"

#include <thalweg/base/error.hpp>
#include <thalweg/mesh/change_tin.hpp>
#include <thalweg/mesh/rim.hpp>
#include <thalweg/mesh/tin.hpp>
#include <thalweg/mesh/validate.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <set>
#include <vector>

namespace thalweg {
namespace {

using test::edge;
using test::make_tin;
using test::triangle;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::UnorderedElementsAre;

// 3---2
// | / |    diagonal 0-2
// 0---1
const std::vector<Point2> kSquare{{0, 0}, {1, 0}, {1, 1}, {0, 1}};

Tin square() {
  return make_tin(kSquare, {triangle(2, 3, 0), triangle(1, 2, 0)}, {edge(3, 0, EdgeKind::Valley)});
}

template <class Action>
void expect_invalid(const Action& action, const char* message) {
  try {
    action();
    ADD_FAILURE() << "nothing was thrown, not: " << message;
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::InvalidTin);
    EXPECT_THAT(error.what(), HasSubstr(message));
  }
}

std::vector<VertexId> ids(std::initializer_list<std::size_t> values) {
  std::vector<VertexId> result;
  for (const std::size_t v : values) result.push_back(VertexId{v});
  return result;
}

TEST(Tin, TrianglesStartAtTheirSmallestVertexAndAreSorted) {
  const Tin tin = square();
  EXPECT_THAT(tin.triangles(), ElementsAre(triangle(0, 1, 2), triangle(0, 2, 3)));
  EXPECT_EQ(tin.vertex_count(), 4U);
  EXPECT_EQ(tin.edge_count(), 5U);
  EXPECT_TRUE(validate(tin).empty());
}

TEST(Tin, HalfedgesKnowTheirSurroundings) {
  const Tin tin = square();
  const HalfedgeId diagonal = tin.find_halfedge(VertexId{0}, VertexId{2});
  ASSERT_TRUE(diagonal.valid());
  EXPECT_EQ(tin.apex(diagonal), VertexId{3});
  EXPECT_EQ(tin.apex(tin.twin(diagonal)), VertexId{1});
  EXPECT_EQ(tin.twin(tin.twin(diagonal)), diagonal);
  EXPECT_EQ(Tin::next(Tin::next(Tin::next(diagonal))), diagonal);
  EXPECT_EQ(Tin::previous(Tin::next(diagonal)), diagonal);
  EXPECT_FALSE(tin.find_halfedge(VertexId{1}, VertexId{3}).valid());
  EXPECT_FALSE(tin.find_halfedge(VertexId{0}, VertexId{3}).valid()) << "the rim has one side only";
  std::size_t represented = 0;
  for (std::size_t h = 0; h < tin.halfedge_count(); ++h)
    represented += tin.represents_edge(HalfedgeId{h}) ? 1 : 0;
  EXPECT_EQ(represented, tin.edge_count());
}

TEST(Tin, EachVertexListsItsHalfedges) {
  test::Random random;
  SCOPED_TRACE(random.trace());
  const Tin tin = test::random_lattice(7, 5, 3, random);
  std::size_t total = 0;
  for (std::size_t v = 0; v < tin.vertex_count(); ++v) {
    for (const HalfedgeId h : tin.outgoing(VertexId{v})) {
      EXPECT_EQ(tin.origin(h), VertexId{v});
      EXPECT_EQ(tin.find_halfedge(VertexId{v}, tin.target(h)), h);
      ++total;
    }
  }
  EXPECT_EQ(total, tin.halfedge_count());
  EXPECT_TRUE(validate(tin, {}, IsolatedVertices::Report).empty());
}

TEST(Tin, AHubOfManyTrianglesIsBuiltInReasonableTime) {
  constexpr std::size_t kSpokes = 100'000;
  std::vector<Point2> points{{0, 0}};
  for (std::size_t i = 0; i < kSpokes; ++i) {  // on a parabola's convex arc and back along a line above it
    const double x = static_cast<double>(i) - kSpokes / 2.0;
    points.push_back({x, x * x / kSpokes - kSpokes});
  }
  std::vector<Triangle> triangles;
  for (std::size_t i = 1; i < kSpokes; ++i) triangles.push_back(triangle(0, i, i + 1));
  const Tin tin = make_tin(std::move(points), std::move(triangles));
  EXPECT_EQ(tin.edge_count(), 2 * kSpokes - 1);
  EXPECT_TRUE(validate(tin).empty());
}

TEST(Tin, ConstraintsMarkBothSides) {
  const Tin tin = make_tin(kSquare, {triangle(0, 1, 2), triangle(0, 2, 3)},
                           {edge(2, 0), edge(0, 2, EdgeKind::Ridge), edge(0, 1, EdgeKind::Boundary)});
  const HalfedgeId diagonal = tin.find_halfedge(VertexId{0}, VertexId{2});
  EXPECT_EQ(tin.kind(diagonal), EdgeKind::Breakline | EdgeKind::Ridge);
  EXPECT_EQ(tin.kind(tin.twin(diagonal)), tin.kind(diagonal));
  const std::vector<ConstraintEdge> constraints = tin.constraint_edges();
  ASSERT_EQ(constraints.size(), 2U);
  EXPECT_EQ(constraints[0].b, VertexId{1});
  EXPECT_EQ(constraints[1].b, VertexId{2});
}

TEST(Tin, WhatIsNoTinIsRefused) {
  expect_invalid([] { make_tin(kSquare, {triangle(0, 1, 4)}); }, "does not exist");
  expect_invalid([] { make_tin(kSquare, {triangle(0, 1, 1)}); }, "repeats a vertex");
  expect_invalid([] { make_tin(kSquare, {triangle(0, 1, 2), triangle(0, 1, 3)}); }, "same side of edge 0, 1");
  expect_invalid([] { make_tin(kSquare, {triangle(0, 1, 2)}, {edge(0, 3)}); }, "constraint edge 0, 3");
  expect_invalid([] { make_tin(kSquare, {triangle(0, 1, 2)}, {edge(0, 7)}); }, "constraint edge 0, 7");
  expect_invalid([] { return Tin(kSquare, {1, 2}, {triangle(0, 1, 2)}, {}); }, "as many heights");
}

TEST(Tin, EmptyTinsAreTins) {
  EXPECT_EQ(Tin().edge_count(), 0U);
  EXPECT_TRUE(validate(Tin()).empty());
  const Tin points_only = make_tin(kSquare, {});
  EXPECT_EQ(points_only.edge_count(), 0U);
  EXPECT_TRUE(points_only.outgoing(VertexId{3}).empty());
  EXPECT_THAT(points_only.rim_vertices(), ElementsAre(true, true, true, true));
  EXPECT_THAT(points_only.vertices_in_triangles(), ElementsAre(0, 0, 0, 0));
  EXPECT_TRUE(rim_loops(points_only).empty());
}

TEST(FlipEdges, ReplacesADiagonalAndKeepsConstraints) {
  const Tin tin = square();
  const std::vector<HalfedgeId> diagonal{tin.find_halfedge(VertexId{2}, VertexId{0})};
  const auto [flipped, diagonals] = flip_edges(tin, diagonal);
  EXPECT_THAT(flipped.triangles(), ElementsAre(triangle(0, 1, 3), triangle(1, 2, 3)));
  ASSERT_EQ(diagonals.size(), 1U);
  EXPECT_THAT((std::array{flipped.origin(diagonals[0]), flipped.target(diagonals[0])}),
              UnorderedElementsAre(VertexId{1}, VertexId{3}));
  EXPECT_EQ(flipped.kind(flipped.find_halfedge(VertexId{3}, VertexId{0})), EdgeKind::Valley);
  EXPECT_TRUE(validate(flipped).empty());
  const std::vector<HalfedgeId> back{flipped.find_halfedge(VertexId{1}, VertexId{3})};
  EXPECT_TRUE(std::ranges::equal(flip_edges(flipped, back).tin.triangles(), tin.triangles()));
  EXPECT_TRUE(std::ranges::equal(flip_edges(tin, {}).tin.triangles(), tin.triangles()));
}

TEST(Tin, FansAreListedOnceWhicheverThreadsAsk) {
  test::Random random;
  SCOPED_TRACE(random.trace());
  const Tin tin = test::random_lattice(40, 30, 5, random);
  const Tin copy = tin;
  std::atomic<std::size_t> spokes{0};
  tbb::parallel_for(std::size_t{0}, tin.vertex_count(), [&](std::size_t v) {
    for (const HalfedgeId h : tin.outgoing(VertexId{v})) spokes += tin.origin(h) == VertexId{v} ? 1 : 0;
  });
  EXPECT_EQ(spokes, tin.halfedge_count());
  EXPECT_EQ(copy.outgoing(VertexId{0}).data(), tin.outgoing(VertexId{0}).data());
}

TEST(FlipEdges, RimAndConstraintEdgesStay) {
  const Tin tin = make_tin(kSquare, {triangle(0, 1, 2), triangle(0, 2, 3)}, {edge(0, 2)});
  const std::vector<HalfedgeId> rim{tin.find_halfedge(VertexId{0}, VertexId{1})};
  const std::vector<HalfedgeId> constraint{tin.find_halfedge(VertexId{0}, VertexId{2})};
  expect_invalid([&] { flip_edges(tin, rim); }, "edge 0, 1 cannot be flipped");
  expect_invalid([&] { flip_edges(tin, constraint); }, "edge 0, 2 cannot be flipped");
}

TEST(KeepTriangles, KeepsVerticesAndTheConstraintsThatAreLeft) {
  const Tin tin = make_tin(kSquare, {triangle(0, 1, 2), triangle(0, 2, 3)}, {edge(0, 2), edge(2, 3)});
  const Tin lower = keep_triangles(tin, {true, false});
  EXPECT_EQ(lower.vertex_count(), 4U);
  EXPECT_THAT(lower.triangles(), ElementsAre(triangle(0, 1, 2)));
  ASSERT_EQ(lower.constraint_edges().size(), 1U);
  EXPECT_EQ(lower.constraint_edges()[0].b, VertexId{2});
  EXPECT_THAT(lower.rim_vertices(), ElementsAre(true, true, true, true));
}

TEST(RimLoops, OuterLoopsAreCounterClockwiseAndHolesClockwise) {
  test::Random random;
  SCOPED_TRACE(random.trace());
  const Tin lattice = test::random_lattice(5, 5, 1, random);
  std::vector<bool> keep(lattice.triangle_count());
  for (std::size_t t = 0; t < keep.size(); ++t) {  // cut the cell from (2, 2) to (3, 3)
    double x = 0, y = 0;
    for (const VertexId v : lattice.triangle(TriangleId{t})) {
      x += lattice.point(v).x / 3;
      y += lattice.point(v).y / 3;
    }
    keep[t] = !(x > 2 && x < 3 && y > 2 && y < 3);
  }
  const auto loops = rim_loops(keep_triangles(lattice, keep));
  EXPECT_THAT(loops, ElementsAre(ids({0, 1, 2, 3, 4, 9, 14, 19, 24, 23, 22, 21, 20, 15, 10, 5}),
                                 ids({12, 17, 18, 13})));
}

TEST(RimLoops, FansThatMeetAtAVertexHaveTheirOwnLoops) {
  const Tin tin =
      make_tin({{0, 0}, {1, -1}, {1, 1}, {-1, 1}, {-1, -1}}, {triangle(0, 1, 2), triangle(0, 3, 4)});
  EXPECT_TRUE(validate(tin).empty());
  EXPECT_THAT(rim_loops(tin), ElementsAre(ids({0, 1, 2}), ids({0, 3, 4})));
}

// A lattice with a hole, a constraint edge, and a hub of many triangles, under permuted ids.
TEST(Tin, RenumberedIsTheTinBuiltUnderThoseIds) {
  std::vector<Point2> points{{0, 0}};
  std::vector<Triangle> triangles;
  constexpr std::size_t kSpokes = 60;
  for (std::size_t i = 0; i <= kSpokes; ++i) {
    const double x = static_cast<double>(i) - 30;
    points.push_back({x, 100 - x * x / 100});
    if (i > 0 && i != 20) triangles.push_back(triangle(0, i + 1, i));
  }
  const Tin tin = make_tin(points, triangles, {edge(0, 7, EdgeKind::Valley), edge(1, 2, EdgeKind::Ridge)});
  std::vector<VertexId> number;
  for (std::size_t v = 0; v < points.size(); ++v) number.emplace_back((v * 23 + 5) % points.size());
  const Tin moved = renumber(tin, number, Progress()).tin;

  std::vector<Point2> new_points(points.size());
  std::vector<double> new_heights(points.size());
  for (std::size_t v = 0; v < points.size(); ++v) {
    new_points[number[v].index()] = points[v];
    new_heights[number[v].index()] = tin.heights()[v];
  }
  for (Triangle& t : triangles) {
    for (VertexId& v : t) v = number[v.index()];
  }
  const Tin expected(new_points, new_heights, triangles,
                     std::vector<ConstraintEdge>{{number[0], number[7], EdgeKind::Valley},
                                                 {number[1], number[2], EdgeKind::Ridge}});
  EXPECT_TRUE(validate(moved).empty());
  EXPECT_TRUE(std::ranges::equal(moved.points(), expected.points()));
  EXPECT_TRUE(std::ranges::equal(moved.heights(), expected.heights()));
  EXPECT_TRUE(std::ranges::equal(moved.triangles(), expected.triangles()));
  EXPECT_TRUE(std::ranges::equal(moved.arrays().twins, expected.arrays().twins));
  EXPECT_TRUE(std::ranges::equal(moved.arrays().kinds, expected.arrays().kinds));
  EXPECT_EQ(moved.edge_count(), expected.edge_count());
  for (std::size_t v = 1; v < points.size(); ++v) {
    EXPECT_EQ(moved.find_halfedge(number[0], number[v]), expected.find_halfedge(number[0], number[v]));
  }
}

TEST(Tin, RenumberedRefusesWhatIsNoPermutation) {
  expect_invalid([] { (void)renumber(square(), ids({0, 1, 2, 2}), Progress()); }, "permutation");
  expect_invalid([] { (void)renumber(square(), ids({0, 1, 2, 4}), Progress()); }, "permutation");
  expect_invalid([] { (void)renumber(square(), ids({0, 1, 2}), Progress()); }, "permutation");
}

}  // namespace
}  // namespace thalweg
