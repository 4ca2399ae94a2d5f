// One minimal broken mesh for each law of `validate`, and the sound ones next to it.
#include "support/meshes.hpp"

#include <thalweg/mesh/validate.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace thalweg {
namespace {

using test::edge;
using test::triangle;
using testing::AllOf;
using testing::Contains;
using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

// A square of two triangles as arrays that a test may break.
struct Mesh {
  std::vector<Point2> points{{0, 0}, {2, 0}, {2, 2}, {0, 2}};
  std::vector<double> heights{1, 2, 3, 4};
  std::vector<Triangle> triangles{triangle(0, 1, 2), triangle(0, 2, 3)};
  std::vector<ConstraintEdge> constraints{edge(0, 2)};
  std::vector<Point2> written;
  std::vector<HalfedgeId> twins;
  std::vector<EdgeKind> kinds;
  IsolatedVertices isolated = IsolatedVertices::Allow;

  // Takes what a Tin derives from the triangles.
  void derive() {
    const Tin tin(points, heights, triangles, constraints);
    const TinArrays arrays = tin.arrays();
    twins.assign(arrays.twins.begin(), arrays.twins.end());
    kinds.assign(arrays.kinds.begin(), arrays.kinds.end());
  }
  void add(Point2 p) {
    points.push_back(p);
    heights.push_back(0);
  }
  [[nodiscard]] std::vector<Violation> violations() const {
    return validate({points, heights, triangles, constraints, twins, kinds}, written, isolated);
  }
  [[nodiscard]] std::vector<int> codes() const {
    std::vector<int> codes;
    for (const Violation& v : violations()) codes.push_back(v.code);
    return codes;
  }
};

TEST(Validate, ASoundMeshBreaksNothing) {
  Mesh mesh;
  EXPECT_THAT(mesh.codes(), IsEmpty());
  mesh.derive();
  mesh.written = mesh.points;
  EXPECT_THAT(mesh.codes(), IsEmpty());
}

TEST(Validate, Law101NumbersAreFinite) {
  for (const double bad : {double{NAN}, double{INFINITY}, -1e100}) {
    Mesh mesh;
    mesh.points[3].y = bad;
    EXPECT_THAT(mesh.codes(), ElementsAre(101)) << bad;
    mesh = Mesh();
    mesh.heights[1] = bad;
    EXPECT_THAT(mesh.codes(), ElementsAre(101)) << bad;
    mesh = Mesh();
    mesh.written = mesh.points;
    mesh.written[0].x = bad;
    EXPECT_THAT(mesh.codes(), ElementsAre(101)) << bad;
  }
}

TEST(Validate, Law102PositionsDiffer) {
  Mesh mesh;  // a second square, joined by position only
  mesh.add({2, 0});
  mesh.add({4, 0});
  mesh.add({2, 2});
  mesh.triangles.push_back(triangle(4, 5, 6));
  EXPECT_THAT(mesh.codes(), ElementsAre(102, 102));
  EXPECT_EQ(mesh.violations()[0].what, "vertices 1 and 4 share a position");

  Mesh isolated;
  isolated.add({0, 2});
  EXPECT_THAT(isolated.codes(), ElementsAre(102));

  Mesh flat;  // also where other laws are broken
  flat.points[3] = flat.points[2];
  EXPECT_THAT(flat.codes(), ElementsAre(102, 105));
}

TEST(Validate, Law103TrianglesNameThreeVerticesThatExist) {
  Mesh mesh;
  mesh.triangles[1] = triangle(0, 2, 2);
  EXPECT_THAT(mesh.codes(), ElementsAre(103));
  mesh.triangles[1] = triangle(0, 2, 4);
  EXPECT_THAT(mesh.codes(), ElementsAre(103));
}

TEST(Validate, Law104TrianglesAreCanonical) {
  Mesh mesh;
  mesh.triangles[1] = triangle(2, 3, 0);
  EXPECT_THAT(mesh.codes(), ElementsAre(104));
  mesh.triangles = {triangle(0, 2, 3), triangle(0, 1, 2)};
  EXPECT_THAT(mesh.codes(), ElementsAre(104));
}

TEST(Validate, Law105TrianglesAreCounterClockwise) {
  Mesh mesh;
  mesh.triangles = {triangle(0, 1, 2), triangle(0, 3, 2)};
  EXPECT_THAT(mesh.codes(), Contains(105));
  EXPECT_EQ(mesh.violations()[0].what, "triangle 1 (0, 3, 2) is clockwise in the plane");
  mesh = Mesh();
  mesh.points[3] = {1, 1};
  EXPECT_THAT(mesh.codes(), ElementsAre(105));
  EXPECT_EQ(mesh.violations()[0].what, "triangle 1 (0, 2, 3) is flat in the plane");
}

TEST(Validate, Law106TrianglesAreCounterClockwiseAsWritten) {
  Mesh mesh;
  mesh.written = mesh.points;
  mesh.written[3] = {2, 2};
  EXPECT_THAT(mesh.codes(), ElementsAre(106));
}

TEST(Validate, Law107OneTriangleLiesOnASide) {
  Mesh mesh;
  mesh.add({1, 3});
  mesh.triangles = {triangle(0, 1, 2), triangle(0, 1, 4), triangle(0, 2, 3)};
  EXPECT_THAT(mesh.codes(), ElementsAre(107));
}

TEST(Validate, Law108VerticesLieOnTheirOwnTrianglesOnly) {
  Mesh rim;  // a triangle that stands with its tip on the middle of edge 1-2
  rim.add({2, 1});
  rim.add({3, 0});
  rim.add({3, 2});
  rim.triangles.push_back(triangle(4, 5, 6));
  EXPECT_THAT(rim.codes(), ElementsAre(108));
  EXPECT_EQ(rim.violations()[0].what, "vertex 4 lies within rim edge 1, 2");

  for (const Point2 p : {Point2{1, 1}, {1.5, 1}, {0.5, 1}, {1, 0}, {1, 2}, {2, 1.5}}) {
    Mesh isolated;
    isolated.add(p);
    EXPECT_THAT(isolated.codes(), ElementsAre(108)) << p.x << ' ' << p.y;
  }
}

TEST(Validate, Law109TrianglesDoNotOverlap) {
  Mesh crossing;
  crossing.add({1, -1});
  crossing.add({3, 1});
  crossing.add({3, 3});
  crossing.triangles.push_back(triangle(4, 5, 6));
  EXPECT_THAT(crossing.codes(), Contains(109));

  Mesh inside;  // no rim edges cross
  inside.add({0.5, 0.25});
  inside.add({1.5, 0.25});
  inside.add({1.5, 1});
  inside.triangles.push_back(triangle(4, 5, 6));
  EXPECT_THAT(inside.codes(), ElementsAre(109));

  Mesh twice;  // six triangles that wind twice around their common vertex
  twice.points = {{0, 0}};
  twice.triangles.clear();
  twice.constraints.clear();
  for (int i = 0; i < 6; ++i)
    twice.points.push_back({std::cos(2.0944 * i) * (1 + i), std::sin(2.0944 * i) * (1 + i)});
  for (std::size_t i = 1; i < 6; ++i) twice.triangles.push_back(triangle(0, i, i + 1));
  twice.triangles.insert(twice.triangles.begin() + 1, triangle(0, 6, 1));
  std::sort(twice.triangles.begin(), twice.triangles.end());
  twice.heights.assign(7, 0);
  EXPECT_THAT(twice.codes(), Contains(109));
}

TEST(Validate, Law110TrianglesDoNotOverlapAsWritten) {
  Mesh mesh;
  mesh.points = {{0, 0}, {4, 0}, {4, 1}, {0, 4}, {5, 0}, {9, 0}, {5, 1}};
  mesh.heights.assign(7, 0);
  mesh.triangles = {triangle(0, 1, 2), triangle(0, 2, 3), triangle(4, 5, 6)};
  mesh.written = mesh.points;
  EXPECT_THAT(mesh.codes(), IsEmpty());
  mesh.written[4].x = 3;
  EXPECT_THAT(mesh.codes(), Contains(110));
}

TEST(Validate, Law111ConstraintEdgesAreEdges) {
  Mesh mesh;
  mesh.constraints = {edge(1, 3)};
  EXPECT_THAT(mesh.codes(), ElementsAre(111));
  mesh.constraints = {edge(0, 9)};
  EXPECT_THAT(mesh.codes(), ElementsAre(111));
}

TEST(Validate, Law112TwinsAreTheOtherSides) {
  Mesh mesh;
  mesh.derive();
  mesh.twins[2] = HalfedgeId{};
  EXPECT_THAT(mesh.codes(), ElementsAre(112));
  mesh.derive();
  mesh.twins[0] = HalfedgeId{5};
  EXPECT_THAT(mesh.codes(), ElementsAre(112));
}

TEST(Validate, ASurfaceThatWindsTwiceAboutAVertexOverlaps) {
  constexpr std::size_t kSteps = 7;
  Mesh mesh;
  mesh.points.assign(1, {0, 0});
  mesh.triangles.clear();
  mesh.constraints.clear();
  for (std::size_t i = 0; i < kSteps; ++i) {
    const double angle = 4 * std::numbers::pi * static_cast<double>(i) / kSteps;
    mesh.points.push_back({std::cos(angle), std::sin(angle)});
    mesh.triangles.push_back(triangle(0, 1 + i, 1 + (i + 1) % kSteps));
  }
  mesh.heights.assign(mesh.points.size(), 0);
  const auto overlap = AllOf(Not(IsEmpty()), Each(violation::kOverlap));
  EXPECT_THAT(mesh.codes(), overlap);
  mesh.derive();
  EXPECT_THAT(mesh.codes(), overlap);
}

TEST(Validate, Law107TwoTrianglesOnOneSideAreFoundWhereTwinsAgree) {
  Mesh mesh;
  mesh.points = {{0, 0}, {4, 0}, {0, 4}, {1, 1}, {2, 1}};
  mesh.heights.assign(5, 0);
  mesh.constraints.clear();
  mesh.triangles = {triangle(0, 1, 3), triangle(0, 1, 4)};
  mesh.twins.assign(6, HalfedgeId{});
  EXPECT_THAT(mesh.codes(), ElementsAre(violation::kSameSide));
}

TEST(Validate, Law113BothSidesHaveOneKind) {
  Mesh mesh;
  mesh.derive();
  mesh.kinds[2] = EdgeKind::Ridge;
  EXPECT_THAT(mesh.codes(), ElementsAre(113));
  EXPECT_THAT(mesh.violations()[0].what, HasSubstr("0, 2"));
}

TEST(Validate, Law115VerticesAreInATriangleIfAsked) {
  Mesh mesh;
  mesh.add({9, 9});
  EXPECT_THAT(mesh.codes(), IsEmpty());
  mesh.isolated = IsolatedVertices::Report;
  EXPECT_THAT(mesh.codes(), ElementsAre(115));
}

TEST(Validate, Law116ArraysAreEquallyLong) {
  Mesh mesh;
  mesh.heights.pop_back();
  EXPECT_THAT(mesh.codes(), ElementsAre(116));
  mesh = Mesh();
  mesh.written = {{0, 0}};
  EXPECT_THAT(mesh.codes(), ElementsAre(116));
  mesh = Mesh();
  mesh.derive();
  mesh.twins.pop_back();
  mesh.kinds.pop_back();
  EXPECT_THAT(mesh.codes(), ElementsAre(116, 116));
}

TEST(Validate, ManyViolationsAreCountedNotListed) {
  Mesh mesh;
  mesh.isolated = IsolatedVertices::Report;
  for (int i = 0; i < 100; ++i) mesh.add({10.0 + i, 5});
  const std::vector<Violation> violations = mesh.violations();
  ASSERT_EQ(violations.size(), 21U);
  EXPECT_EQ(violations.back().what, "and 80 more");
}

}  // namespace
}  // namespace thalweg
