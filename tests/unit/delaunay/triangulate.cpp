// The plain constrained Delaunay triangulation: laws, lattices, degenerate input, cancel.
#include <thalweg/base/error.hpp>
#include <thalweg/delaunay/triangulate.hpp>
#include <thalweg/geometry/predicates.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

namespace thalweg {
namespace {

ErrorCode code_of(const std::function<void()>& work) {
  try {
    work();
  } catch (const Error& error) {
    return error.code();
  }
  return ErrorCode::Internal;
}

Tin of_points(std::vector<Point2> points, std::span<const ConstraintEdge> constraints = {}) {
  Progress progress;
  std::vector<double> heights(points.size(), 0.0);
  return triangulate(std::move(points), std::move(heights), constraints, progress);
}

// Every unconstrained interior edge is locally Delaunay under the tie rule.
void expect_locally_delaunay(const Tin& tin) {
  for (std::size_t i = 0; i < tin.halfedge_count(); ++i) {
    const HalfedgeId h{i};
    if (tin.on_rim(h) || tin.constrained(h)) continue;
    const Point2 a = tin.point(tin.origin(h));
    const Point2 b = tin.point(tin.target(h));
    EXPECT_FALSE(in_circle_perturbed(a, b, tin.point(tin.apex(h)), tin.point(tin.apex(tin.twin(h)))));
  }
}

// All triangles that no other point lies inside of, straight from the definition.
std::set<std::array<Point2, 3>> brute_force_delaunay(const std::vector<Point2>& points) {
  std::set<std::array<Point2, 3>> triangles;
  for (const Point2 a : points) {
    for (const Point2 b : points) {
      for (const Point2 c : points) {
        if (!(a < b && a < c) || orientation(a, b, c) <= 0) continue;
        const bool empty = std::none_of(points.begin(), points.end(), [&](Point2 d) {
          return d != a && d != b && d != c && in_circle_perturbed(a, b, c, d);
        });
        if (empty) triangles.insert({a, b, c});
      }
    }
  }
  return triangles;
}

std::set<std::array<Point2, 3>> triangles_by_position(const Tin& tin) {
  std::set<std::array<Point2, 3>> triangles;
  for (const Triangle& t : tin.triangles()) {
    std::array<Point2, 3> corners{tin.point(t[0]), tin.point(t[1]), tin.point(t[2])};
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    triangles.insert(corners);
  }
  return triangles;
}

std::vector<Point2> lattice(int columns, int rows, double step = 1) {
  std::vector<Point2> points;
  for (int y = 0; y < rows; ++y) {
    for (int x = 0; x < columns; ++x) points.push_back({x * step, y * step});
  }
  return points;
}

TEST(Triangulate, RefusesFewerThanThreePoints) {
  EXPECT_EQ(code_of([] { of_points({}); }), ErrorCode::TooFewPoints);
  EXPECT_EQ(code_of([] { of_points({{0, 0}, {1, 0}}); }), ErrorCode::TooFewPoints);
}

TEST(Triangulate, RefusesCollinearPoints) {
  EXPECT_EQ(code_of([] { of_points({{0, 0}, {1, 1}, {3, 3}, {2, 2}}); }), ErrorCode::Collinear);
}

TEST(Triangulate, RefusesCrossingConstraints) {
  const std::vector<ConstraintEdge> cross{{VertexId{0}, VertexId{3}}, {VertexId{1}, VertexId{2}}};
  EXPECT_EQ(code_of([&] { of_points(lattice(2, 2), cross); }), ErrorCode::InvalidTin);
  const std::vector<ConstraintEdge> over_vertex{{VertexId{0}, VertexId{2}}};
  EXPECT_EQ(code_of([&] { of_points(lattice(3, 2), over_vertex); }), ErrorCode::InvalidTin);
}

TEST(Triangulate, RefusesConstraintsThatJoinNoTwoVertices) {
  for (const VertexId other : {VertexId{1}, VertexId{4}, VertexId{}}) {
    const std::vector<ConstraintEdge> edge{{VertexId{1}, other}};
    EXPECT_EQ(code_of([&] { of_points(lattice(2, 2), edge); }), ErrorCode::InvalidTin);
  }
}

TEST(Triangulate, KeepsConstraintsGivenTwice) {
  const std::vector<ConstraintEdge> twice{{VertexId{0}, VertexId{3}, EdgeKind::Ridge},
                                          {VertexId{3}, VertexId{0}, EdgeKind::Valley}};
  const Tin tin = of_points(lattice(2, 2), twice);
  ASSERT_EQ(tin.constraint_edges().size(), 1U);
  EXPECT_EQ(tin.constraint_edges()[0].kind, EdgeKind::Ridge | EdgeKind::Valley);
}

TEST(Triangulate, EqualsBruteForceOnLattices) {
  for (const auto& [columns, rows] : {std::pair(3, 3), std::pair(5, 4), std::pair(6, 2)}) {
    const std::vector<Point2> points = lattice(columns, rows, 0.5);
    EXPECT_EQ(triangles_by_position(of_points(points)), brute_force_delaunay(points));
  }
}

TEST(Triangulate, EqualsBruteForceOnRandomLatticeSamples) {
  std::mt19937 random(20240611);
  for (int scene = 0; scene < 50; ++scene) {
    std::vector<Point2> points = lattice(6, 6);
    std::shuffle(points.begin(), points.end(), random);
    points.resize(5 + scene % 12);
    if (code_of([&] { of_points(points); }) == ErrorCode::Collinear) continue;
    EXPECT_EQ(triangles_by_position(of_points(points)), brute_force_delaunay(points)) << "scene " << scene;
  }
}

TEST(Triangulate, IsLocallyDelaunayOnAConstrainedLattice) {
  const std::vector<Point2> points = lattice(20, 20);
  std::vector<ConstraintEdge> constraints;
  const auto id = [](int x, int y) { return VertexId{static_cast<std::size_t>(20 * y + x)}; };
  for (int i = 0; i < 9; ++i) constraints.push_back({id(i, 2 * i), id(i + 1, 2 * i + 2)});
  for (int i = 0; i < 6; ++i) constraints.push_back({id(3 * i + 1, 1 + i), id(3 * i + 4, 2 + i)});
  std::erase_if(constraints, [&](const ConstraintEdge& edge) {
    return std::any_of(constraints.begin(), constraints.end(), [&](const ConstraintEdge& other) {
      return cross_properly(points[edge.a.index()], points[edge.b.index()], points[other.a.index()],
                            points[other.b.index()]) &&
             edge.a < other.a;
    });
  });
  const Tin tin = of_points(points, constraints);
  EXPECT_EQ(tin.constraint_edges().size(), constraints.size());
  expect_locally_delaunay(tin);
}

TEST(Triangulate, DoesNotDependOnInputOrder) {
  std::vector<Point2> points = lattice(30, 20);
  const auto before = triangles_by_position(of_points(points));
  std::mt19937 random(7);
  std::shuffle(points.begin(), points.end(), random);
  EXPECT_EQ(triangles_by_position(of_points(points)), before);
}

TEST(Triangulate, StopsOnRequest) {
  Progress progress;
  progress.cancel();
  EXPECT_EQ(code_of([&] { triangulate(lattice(50, 50), std::vector<double>(2500), {}, progress); }),
            ErrorCode::Cancelled);
}

}  // namespace
}  // namespace thalweg
