// Which triangles stay when ground is lost from the rim.
#include <thalweg/base/error.hpp>
#include <thalweg/delaunay/triangulate.hpp>
#include <thalweg/delaunay/trim.hpp>
#include <thalweg/mesh/change_tin.hpp>

#include <gtest/gtest.h>
#include <support/random.hpp>

#include <algorithm>
#include <numeric>
#include <set>

namespace thalweg {
namespace {

Tin tin_of(std::vector<Point2> points, std::span<const ConstraintEdge> constraints = {}) {
  Progress progress;
  std::vector<double> heights(points.size(), 0.0);
  return triangulate(std::move(points), std::move(heights), constraints, progress);
}

std::size_t kept(const std::vector<bool>& keep) {
  return static_cast<std::size_t>(std::count(keep.begin(), keep.end(), true));
}

std::set<std::set<Point2>> kept_by_position(const Tin& tin, const std::vector<bool>& keep) {
  std::set<std::set<Point2>> triangles;
  for (std::size_t t = 0; t < keep.size(); ++t) {
    if (!keep[t]) continue;
    const Triangle& corners = tin.triangle(TriangleId{t});
    triangles.insert({tin.point(corners[0]), tin.point(corners[1]), tin.point(corners[2])});
  }
  return triangles;
}

// A fan of triangles from a far apex down to a row of near points.
std::vector<Point2> far_apex() {
  return {{0, 0}, {1, 0}, {2, 0}, {3, 0}, {1.5, 100}};
}

TEST(Trim, LongRimTrianglesGoFromTheRimInwards) {
  const Tin tin = tin_of(far_apex());
  EXPECT_EQ(kept(drop_long_rim_triangles(tin, 50)), 0U);
  EXPECT_EQ(kept(drop_long_rim_triangles(tin, 200)), 3U);
}

TEST(Trim, ALongEdgeInsideStays) {
  std::vector<Point2> points{{0, 0}, {10, 0}, {5, 1}, {5, -1}};
  const Tin tin = tin_of(points, std::vector<ConstraintEdge>{{VertexId{0}, VertexId{1}}});
  EXPECT_EQ(kept(drop_long_rim_triangles(tin, 6)), 2U);
}

TEST(Trim, AConstraintEdgeKeepsATriangle) {
  const std::vector<ConstraintEdge> rim{{VertexId{0}, VertexId{4}}};
  const Tin tin = tin_of(far_apex(), rim);
  const std::vector<bool> keep = drop_long_rim_triangles(tin, 50);
  EXPECT_EQ(kept(keep), 1U);
  EXPECT_EQ(keep_triangles(tin, keep).constraint_edges().size(), 1U);
  const std::vector<ConstraintEdge> inner{{VertexId{1}, VertexId{4}}};
  const Tin split = tin_of(far_apex(), inner);
  const std::vector<bool> one_side = drop_long_rim_triangles(split, 50);
  EXPECT_EQ(kept(one_side), 1U);
  EXPECT_EQ(keep_triangles(split, one_side).constraint_edges().size(), 1U);
}

TEST(Trim, DoesNotDependOnOrder) {
  test::Random random;
  SCOPED_TRACE(random.trace());
  for (int scene = 0; scene < 20; ++scene) {
    std::vector<Point2> points;
    for (int i = 0; i < 60; ++i) points.push_back({random.real(0, 10), random.real(0, 10)});
    std::vector<std::size_t> order(points.size());
    std::iota(order.begin(), order.end(), 0U);
    std::shuffle(order.begin(), order.end(), random.engine());
    std::vector<Point2> shuffled(points.size());
    for (std::size_t i = 0; i < order.size(); ++i) shuffled[order[i]] = points[i];
    // Some edges of the triangulation become constraint edges.
    const Tin plain = tin_of(points);
    std::vector<ConstraintEdge> constraints;
    std::vector<ConstraintEdge> moved;
    for (int i = 0; i < 12; ++i) {
      const HalfedgeId h{random.integer<std::size_t>(0, plain.halfedge_count() - 1)};
      const VertexId a = plain.origin(h), b = plain.target(h);
      constraints.push_back({a, b});
      moved.push_back({VertexId{order[a.index()]}, VertexId{order[b.index()]}});
    }
    const Tin one = tin_of(points, constraints);
    const Tin other = tin_of(shuffled, moved);
    const std::vector<bool> keep = drop_long_rim_triangles(one, 1.2);
    EXPECT_EQ(kept_by_position(one, keep), kept_by_position(other, drop_long_rim_triangles(other, 1.2)));
    EXPECT_EQ(keep_triangles(one, keep).constraint_edges().size(), one.constraint_edges().size());
  }
}

TEST(Trim, DropsRimTrianglesThatTurnOver) {
  // The middle point of the lower side bulges out in the plane and lies on it as written.
  const std::vector<Point2> points{{0, 0}, {2, 0}, {1, -0.1}, {1, 1}};
  const std::vector<Point2> flat{{0, 0}, {2, 0}, {1, 0}, {1, 1}};
  const std::vector<Point2> turned{{0, 0}, {2, 0}, {1, 0.1}, {1, 1}};
  const std::vector<ConstraintEdge> middle{{VertexId{0}, VertexId{1}}};
  const Tin tin = tin_of(points, middle);
  ASSERT_EQ(tin.triangle_count(), 2U);
  for (const auto& written : {flat, turned}) {
    const std::vector<bool> keep = drop_turned_rim_triangles(tin, written);
    EXPECT_EQ(kept_by_position(tin, keep), (std::set<std::set<Point2>>{{{0, 0}, {2, 0}, {1, 1}}}));
  }
  EXPECT_EQ(kept(drop_turned_rim_triangles(tin, points)), 2U);
}

TEST(Trim, RefusesAnInteriorTriangleThatTurnsOver) {
  const std::vector<Point2> points{{0, 0}, {4, 0}, {0, 4}, {1, 1}, {1.5, 1}, {1, 1.5}};
  std::vector<Point2> written = points;
  std::swap(written[4], written[5]);
  const Tin tin = tin_of(points);
  try {
    drop_turned_rim_triangles(tin, written);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::BadCrs);
    EXPECT_NE(std::string(error.what()).find("--t-crs"), std::string::npos);
  }
}

TEST(Trim, OutsideTrianglesGoWhereverTheyAre) {
  const Tin tin = tin_of({{0, 0}, {4, 0}, {0, 4}, {1, 1}, {1.5, 1}, {1, 1.5}});
  const auto inner = [&](TriangleId t) {
    const Triangle& corners = tin.triangle(t);
    return std::all_of(corners.begin(), corners.end(), [](VertexId v) { return v.index() >= 3; });
  };
  EXPECT_EQ(kept(drop_outside_triangles(tin, inner)), tin.triangle_count() - 1);
}

}  // namespace
}  // namespace thalweg
