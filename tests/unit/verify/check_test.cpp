// Each claim on a small terrain, true and false.
#include "support/meshes.hpp"

#include <thalweg/verify/verify.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

namespace thalweg::verify {
namespace {

using test::edge;
using test::triangle;
using testing::HasSubstr;

// Two sinks, 2 and 3, on the diagonal of a quadrilateral whose other diagonal is Delaunay.
//      1
//    2   3      rim 4..7 around
//      0
struct Terrain {
  std::vector<Point2> points = {{0, -10},   {0, 10},   {-11, 0}, {11, 0},
                                {-60, -60}, {60, -60}, {60, 60}, {-60, 60}};
  std::vector<double> heights = {5, 6, 1, 2, 9, 9, 9, 9};
  std::vector<Triangle> triangles = {
      triangle(0, 3, 1), triangle(0, 1, 2), triangle(4, 0, 2), triangle(4, 5, 0), triangle(5, 3, 0),
      triangle(5, 6, 3), triangle(6, 1, 3), triangle(6, 7, 1), triangle(7, 2, 1), triangle(7, 4, 2)};
  std::vector<ConstraintEdge> constraints = {edge(4, 0)};
  Claims claims = {.vertices = 8, .triangles = 10, .constraint_edges = 1};
  unsigned order = 1;

  void flip_middle() {
    triangles[0] = triangle(0, 3, 2);
    triangles[1] = triangle(1, 2, 3);
  }

  [[nodiscard]] std::vector<Finding> checked() const {
    Progress progress;
    return check({.points = points,
                  .heights = heights,
                  .triangles = triangles,
                  .constraints = constraints,
                  .order = order},
                 claims, progress);
  }
  [[nodiscard]] Finding line(const std::string& claim) const {
    const std::vector<Finding> findings = checked();
    const auto found = std::find_if(findings.begin(), findings.end(), [&](const Finding& f) {
      return f.claim.find(claim) != std::string::npos;
    });
    return found == findings.end() ? Finding{"no line " + claim, Verdict::NotChecked, {}} : *found;
  }
};

TEST(Check, ASoundTerrainHolds) {
  for (const Finding& f : Terrain().checked()) EXPECT_EQ(f.verdict, Verdict::Holds) << f.claim << f.detail;
}

TEST(Check, AClockwiseTriangleIsNamed) {
  Terrain t;
  std::swap(t.triangles[3][0], t.triangles[3][1]);
  EXPECT_EQ(t.line("triangulation").verdict, Verdict::Broken);
  EXPECT_EQ(t.line("orders, structure").verdict, Verdict::NotChecked);
}

TEST(Check, OverlapIsFoundWhereSidesAreSound) {
  Terrain t;  // vertex 1 moves over 0 and out at the bottom: its fan overlaps
  t.points.push_back({0, 0});
  t.heights.push_back(4);
  t.triangles.push_back(triangle(8, 5, 6));
  const Finding line = t.line("triangulation");
  EXPECT_EQ(line.verdict, Verdict::Broken);
  EXPECT_THAT(line.detail,
              testing::AnyOf(HasSubstr("overlap"), HasSubstr("lies in"), HasSubstr("same side")));
}

TEST(Check, AVertexInATriangleIsFound) {
  Terrain t;
  t.points.push_back({0, 59});
  t.points.push_back({1, 59});
  t.points.push_back({0, 58});
  t.heights.insert(t.heights.end(), {1, 1, 1});
  t.triangles.push_back(triangle(8, 10, 9));
  EXPECT_THAT(t.line("triangulation").detail, HasSubstr("lies in triangle"));
}

TEST(Check, AVertexLeftOutIsNamed) {
  Terrain t;
  t.points.push_back({100, 100});
  t.heights.push_back(0);
  EXPECT_THAT(t.line("triangulation").detail, HasSubstr("vertex 8 is in no triangle"));
}

TEST(Check, TwoVerticesAtOnePositionAreNamed) {
  Terrain t;
  t.points[3] = t.points[1];
  EXPECT_EQ(t.line("triangulation").verdict, Verdict::Broken);
}

TEST(Check, AConstraintThatIsNoEdgeIsNamed) {
  Terrain t;
  t.constraints = {edge(2, 3)};
  EXPECT_THAT(t.line("constraint edge is an edge").detail, HasSubstr("2-3"));
}

TEST(Check, AFlippedDiagonalOfOrderOneIsNoDelaunayTriangulation) {
  Terrain t;
  t.flip_middle();
  EXPECT_EQ(t.line("order at most 1").verdict, Verdict::Holds);
  t.order = 0;
  EXPECT_THAT(t.line("order at most 0").detail, HasSubstr("has order 1"));
  EXPECT_EQ(t.line("is the constrained Delaunay").verdict, Verdict::Broken);
}

TEST(Check, CountsMustBeRight) {
  Terrain t;
  t.claims.triangles = 11;
  EXPECT_EQ(t.line("triangles").detail, "claimed 11, found 10");
}

TEST(Check, PitsAndTheirOptimumAreFoundAgain) {
  Terrain t;
  t.flip_middle();
  t.claims.criteria = {{.name = "local-minima", .delaunay = 2, .result = 1, .bound = 1, .optimal = true}};
  for (const Finding& f : t.checked()) EXPECT_EQ(f.verdict, Verdict::Holds) << f.claim << ": " << f.detail;
}

TEST(Check, AForgedOptimumOfPitsIsRejected) {
  Terrain t;  // the Delaunay diagonal leaves two pits
  t.claims.criteria = {{.name = "local-minima", .delaunay = 2, .result = 2, .bound = 2, .optimal = true}};
  EXPECT_EQ(t.line("local-minima, result").verdict, Verdict::Holds);
  EXPECT_EQ(t.line("local-minima, optimal").verdict, Verdict::Broken);
}

TEST(Check, AForgedOptimumOfASumIsRejected) {
  Terrain t;
  t.flip_middle();  // longer than the other diagonal
  t.claims.criteria = {{.name = "edge-length", .optimal = true}};
  const std::string found = t.line("edge-length, result").detail;
  const double value = std::stod(found.substr(found.find("found ") + 6));
  t.claims.criteria.front().result = t.claims.criteria.front().bound = value;
  EXPECT_EQ(t.line("edge-length, result").verdict, Verdict::Holds);
  const Finding optimal = t.line("edge-length, optimal");
  EXPECT_EQ(optimal.verdict, Verdict::Broken);
  EXPECT_NEAR(std::stod(optimal.detail.substr(optimal.detail.find("is ") + 3)), value - 2, 1e-8);
}

TEST(Check, AForgedOptimumOfALargestValueIsRejected) {
  Terrain t;
  t.claims.criteria = {{.name = "normal-angle-max", .optimal = true}};
  const auto value_of = [&] {
    const std::string found = t.line("normal-angle-max, result").detail;
    return std::stod(found.substr(found.find("found ") + 6));
  };
  const double delaunay = value_of();
  t.flip_middle();
  const double flipped = value_of();
  ASSERT_NE(delaunay, flipped);
  if (flipped < delaunay) t = Terrain();
  t.claims.criteria = {{.name = "normal-angle-max", .delaunay = delaunay, .optimal = true}};
  const double worse = std::max(delaunay, flipped);
  t.claims.criteria.front().result = t.claims.criteria.front().bound = worse;
  EXPECT_EQ(t.line("normal-angle-max, optimal").verdict, Verdict::Broken);
}

TEST(Check, NoInnerEdgeLeavesALargestValueOfNothing) {
  Terrain t;
  t.points = {{0, 0}, {1, 0}, {0, 1}};
  t.heights = {0, 1, 2};
  t.triangles = {triangle(0, 1, 2)};
  t.constraints = {};
  t.claims = {.vertices = 3, .triangles = 1, .constraint_edges = 0};
  for (const char* const name : {"normal-angle-max", "area-ratio-max"}) {
    t.claims.criteria = {{.name = name, .optimal = true}};
    EXPECT_EQ(t.line(std::string(name) + ", result").verdict, Verdict::Holds);
    EXPECT_EQ(t.line(std::string(name) + ", optimal").verdict, Verdict::Holds);
  }
}

TEST(Check, AValueOffInTheSixthDigitIsRejected) {
  Terrain t;
  t.claims.criteria = {{.name = "edge-length"}};
  const std::string found = t.line("edge-length, result").detail;
  const double value = std::stod(found.substr(found.find("found ") + 6));
  t.claims.criteria.front().result = value;
  EXPECT_EQ(t.line("edge-length, result").verdict, Verdict::Holds);
  t.claims.criteria.front().result = value * (1 + 1e-6);
  EXPECT_EQ(t.line("edge-length, result").verdict, Verdict::Broken);
}

TEST(Check, ADigestOfOtherHeightsIsRejected) {
  Terrain t;
  t.claims.digest = "0";
  const std::string detail = t.line("digest").detail;
  t.claims.digest = detail.substr(detail.rfind(' ') + 1);
  EXPECT_EQ(t.line("digest").verdict, Verdict::Holds);
  t.heights[2] += 1e-9;
  EXPECT_EQ(t.line("digest").verdict, Verdict::Broken);
}

TEST(Check, WhatHasNoFormulaIsNotCalledTrue) {
  Terrain t;
  t.claims.criteria = {{.name = "vertical-error", .optimal = true}};
  EXPECT_EQ(t.line("vertical-error").verdict, Verdict::NotChecked);
}

}  // namespace
}  // namespace thalweg::verify
