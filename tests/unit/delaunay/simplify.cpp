// Greedy insertion against a plain one that triangulates anew each time, and the laws of the header.
#include <thalweg/base/error.hpp>
#include <thalweg/delaunay/simplify.hpp>
#include <thalweg/delaunay/triangulate.hpp>
#include <thalweg/delaunay/trim.hpp>
#include <thalweg/geometry/predicates.hpp>
#include <thalweg/mesh/change_tin.hpp>
#include <thalweg/mesh/validate.hpp>

#include <gtest/gtest.h>
#include <support/meshes.hpp>
#include <support/random.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

namespace thalweg {
namespace {

Tin tin_of(std::vector<Point2> points, std::vector<double> heights,
           std::span<const ConstraintEdge> constraints = {}) {
  Progress progress;
  return triangulate(std::move(points), std::move(heights), constraints, progress);
}

Tin lattice(std::size_t columns, std::size_t rows, double (*height)(double, double),
            std::span<const ConstraintEdge> constraints = {}) {
  std::vector<Point2> points;
  std::vector<double> heights;
  for (std::size_t y = 0; y < rows; ++y) {
    for (std::size_t x = 0; x < columns; ++x) {
      points.push_back({static_cast<double>(x), static_cast<double>(y)});
      heights.push_back(height(points.back().x, points.back().y));
    }
  }
  return tin_of(std::move(points), std::move(heights), constraints);
}

double hills(double x, double y) {
  return 3 * std::sin(x / 3) * std::cos(y / 4) + 0.1 * x + std::sin(1.7 * x + y);
}

Simplified run(const Tin& dense, const SimplifyOptions& options) {
  Progress progress;
  Simplified result = simplify(dense, options, progress);
  EXPECT_TRUE(validate(result.tin, {}, IsolatedVertices::Report).empty());
  EXPECT_EQ(result.kept.size() + result.left_out.size(), dense.vertex_count());
  EXPECT_EQ(result.kept.size(), result.tin.vertex_count());
  for (std::size_t v = 0; v < result.kept.size(); ++v) {
    EXPECT_EQ(result.tin.points()[v], dense.point(result.kept[v]));
    EXPECT_EQ(result.tin.heights()[v], dense.height(result.kept[v]));
  }
  return result;
}

long double error_at(const Tin& tin, const Triangle& t, Point2 p, double z) {
  const Point2 a = tin.point(t[0]), b = tin.point(t[1]), c = tin.point(t[2]);
  const auto area = [](Point2 o, Point2 q, Point2 r) {
    return (static_cast<long double>(q.x) - o.x) * (static_cast<long double>(r.y) - o.y) -
           (static_cast<long double>(q.y) - o.y) * (static_cast<long double>(r.x) - o.x);
  };
  const long double height = (tin.height(t[0]) * area(p, b, c) + tin.height(t[1]) * area(a, p, c) +
                              tin.height(t[2]) * area(a, b, p)) /
                             area(a, b, c);
  return std::abs(z - height);
}

bool holds(const Tin& tin, const Triangle& t, Point2 p) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (orientation(tin.point(t[i]), tin.point(t[(i + 1) % 3]), p) < 0) return false;
  }
  return true;
}

// The largest error of all dense vertices, each looked for in every triangle.
long double plain_largest_error(const Tin& dense, const Tin& tin) {
  long double largest = 0;
  for (std::size_t v = 0; v < dense.vertex_count(); ++v) {
    bool found = false;
    for (const Triangle& t : tin.triangles()) {
      if (!holds(tin, t, dense.points()[v])) continue;
      found = true;
      largest = std::max(largest, error_at(tin, t, dense.points()[v], dense.heights()[v]));
      break;
    }
    EXPECT_TRUE(found) << "vertex " << v << " is outside";
  }
  return largest;
}

void expect_left_out_in_their_triangles(const Tin& dense, const Simplified& result) {
  ASSERT_EQ(result.left_out.size(), result.left_out_in.size());
  for (std::size_t i = 0; i < result.left_out.size(); ++i) {
    EXPECT_TRUE(
        holds(result.tin, result.tin.triangle(result.left_out_in[i]), dense.point(result.left_out[i])));
  }
}

std::set<Point2> positions(const Tin& tin) {
  return {tin.points().begin(), tin.points().end()};
}

// Starts with the given vertices, triangulates anew after each insertion. Heights are such that no two errors
// are equal.
std::set<Point2> plain_greedy(const Tin& dense, std::vector<VertexId> in,
                              std::span<const ConstraintEdge> constraints, double limit) {
  while (true) {
    std::vector<Point2> points;
    std::vector<double> heights;
    std::vector<std::size_t> number(dense.vertex_count(), dense.vertex_count());
    for (const VertexId v : in) {
      number[v.index()] = points.size();
      points.push_back(dense.point(v));
      heights.push_back(dense.height(v));
    }
    std::vector<ConstraintEdge> edges;
    for (const ConstraintEdge& e : constraints) {
      edges.push_back({VertexId{number[e.a.index()]}, VertexId{number[e.b.index()]}, e.kind});
    }
    const Tin tin = tin_of(points, heights, edges);
    long double worst = limit;
    VertexId next;
    for (std::size_t v = 0; v < dense.vertex_count(); ++v) {
      if (number[v] != dense.vertex_count()) continue;
      for (const Triangle& t : tin.triangles()) {
        if (!holds(tin, t, dense.points()[v])) continue;
        const long double error = error_at(tin, t, dense.points()[v], dense.heights()[v]);
        if (error > worst) {
          worst = error;
          next = VertexId{v};
        }
        break;
      }
    }
    if (!next.valid()) return positions(tin);
    in.push_back(next);
  }
}

TEST(Simplify, AsAPlainGreedyInsertion) {
  test::Random random;
  SCOPED_TRACE(random.trace());
  for (int round = 0; round < 12; ++round) {
    std::vector<Point2> points{{0, 0}, {10, 0}, {10, 10}, {0, 10}};
    std::vector<double> heights;
    while (points.size() < 90) points.push_back({random.real(0.01, 9.99), random.real(0.01, 9.99)});
    for (const Point2 p : points) heights.push_back(hills(p.x, p.y) + random.real(-0.3, 0.3));
    std::vector<ConstraintEdge> edges;
    if (round % 2 == 1) edges.push_back(test::edge(0, 2, EdgeKind::Valley));
    const Tin dense = tin_of(points, heights, edges);
    const double limit = random.real(0.2, 2);
    const Simplified result = run(dense, {.max_error = limit});
    std::vector<VertexId> start{VertexId{0}, VertexId{1}, VertexId{2}, VertexId{3}};
    EXPECT_EQ(positions(result.tin), plain_greedy(dense, start, edges, limit));
    EXPECT_EQ(result.stop, SimplifyStop::MaxError);
    EXPECT_EQ(result.fixed, 4U);
  }
}

// A lattice has its own way to the worst vertex; heights are such that no two errors are equal.
TEST(Simplify, ALatticeAsAPlainGreedyInsertion) {
  test::Random random;
  SCOPED_TRACE(random.trace());
  for (int round = 0; round < 4; ++round) {
    std::vector<Point2> points;
    std::vector<double> heights;
    const std::size_t columns = 17, rows = 14;
    const double step = round % 2 == 0 ? 1 : 0.3;
    for (std::size_t i = 0; i < columns * rows; ++i) {
      points.push_back(
          {100 + step * static_cast<double>(i % columns), step * static_cast<double>(i / columns)});
      heights.push_back(hills(points.back().x, points.back().y) + random.real(-0.3, 0.3));
    }
    std::vector<ConstraintEdge> edges;
    if (round >= 2) edges.push_back(test::edge(35, 36, EdgeKind::Valley));
    const Tin dense = tin_of(points, heights, edges);
    const double limit = random.real(0.5, 1.5);
    const Simplified result = run(dense, {.max_error = limit});
    std::vector<VertexId> start{VertexId{0}, VertexId{columns - 1}, VertexId{columns * (rows - 1)},
                                VertexId{columns * rows - 1}};
    if (round >= 2) start.insert(start.end(), {VertexId{35}, VertexId{36}});
    EXPECT_EQ(positions(result.tin), plain_greedy(dense, start, edges, limit));
    expect_left_out_in_their_triangles(dense, result);
  }
}

// The same terrain with and without a vertex that is in no lattice: far off, and of no influence.
TEST(Simplify, ALatticeAsPointsThatAreNone) {
  test::Random random;
  SCOPED_TRACE(random.trace());
  std::vector<Point2> points;
  std::vector<double> heights;
  const std::size_t columns = 60, rows = 50;
  for (std::size_t i = 0; i < columns * rows; ++i) {
    points.push_back({static_cast<double>(i % columns), static_cast<double>(i / columns)});
    heights.push_back(std::floor(hills(points.back().x, points.back().y) * 4));
  }
  const std::size_t last = points.size();
  for (const Point2 p : {Point2{200, 0}, Point2{260, 0}, Point2{200, 40}}) {
    points.push_back(p);
    heights.push_back(0);
  }
  std::vector<ConstraintEdge> edges{test::edge(last, last + 1, EdgeKind::Boundary),
                                    test::edge(last + 1, last + 2, EdgeKind::Boundary),
                                    test::edge(last + 2, last, EdgeKind::Boundary)};
  const Tin dense = tin_of(points, heights, edges);
  points.push_back({220.3, 7.1});
  heights.push_back(0);
  const Tin other = tin_of(points, heights, edges);
  for (const double limit : {0.0, 1.0, 3.0, 8.0}) {
    EXPECT_EQ(positions(run(dense, {.max_error = limit}).tin),
              positions(run(other, {.max_error = limit}).tin));
  }
}

TEST(Simplify, KeepsTheBound) {
  const Tin dense = lattice(23, 19, hills);
  std::size_t before = dense.vertex_count() + 1;
  for (const double limit : {0.0, 0.05, 0.3, 1.0, 3.0}) {
    const Simplified result = run(dense, {.max_error = limit});
    EXPECT_EQ(result.stop, SimplifyStop::MaxError);
    EXPECT_LE(static_cast<double>(plain_largest_error(dense, result.tin)), limit + 1e-12);
    EXPECT_FALSE(result.outlined);
    EXPECT_EQ(result.fixed, 4U);
    EXPECT_LE(result.tin.vertex_count(), before);
    before = result.tin.vertex_count();
    expect_left_out_in_their_triangles(dense, result);
    const Tin again = tin_of({result.tin.points().begin(), result.tin.points().end()},
                             {result.tin.heights().begin(), result.tin.heights().end()});
    EXPECT_TRUE(std::equal(again.triangles().begin(), again.triangles().end(), result.tin.triangles().begin(),
                           result.tin.triangles().end()));
  }
}

// Whole heights and a whole limit: many errors are exactly the limit, and no reason to insert.
TEST(Simplify, AnErrorOfExactlyTheLimitIsNone) {
  const Tin ramp = lattice(3, 2, [](double x, double) { return x == 1 ? 1.0 : 0.0; });
  EXPECT_EQ(run(ramp, {.max_error = 1.0}).tin.vertex_count(), 4U);
  EXPECT_GT(run(ramp, {.max_error = std::nextafter(1.0, 0.0)}).tin.vertex_count(), 4U);
}

TEST(Simplify, APlaneIsItsCorners) {
  const Tin dense = lattice(12, 9, [](double x, double y) { return 0.25 * x - 3 * y; });
  const Simplified bound = run(dense, {.max_error = 0.0});
  EXPECT_EQ(bound.tin.vertex_count(), 4U);
  const Simplified count = run(dense, {.max_vertices = 50});
  EXPECT_EQ(count.tin.vertex_count(), 4U);
  EXPECT_EQ(count.stop, SimplifyStop::Exact);
}

TEST(Simplify, StopsAtTheNumber) {
  const Tin dense = lattice(20, 20, hills);
  const Simplified result = run(dense, {.max_error = 0.01, .max_vertices = 37});
  EXPECT_EQ(result.tin.vertex_count(), 37U);
  EXPECT_EQ(result.stop, SimplifyStop::MaxVertices);
  EXPECT_NEAR(result.max_error, static_cast<double>(plain_largest_error(dense, result.tin)), 1e-12);
}

TEST(Simplify, LinesStayVertexByVertex) {
  std::vector<ConstraintEdge> edges;
  for (std::size_t i = 0; i + 1 < 10; ++i) {
    edges.push_back(test::edge(21 * (2 + i), 21 * (3 + i), EdgeKind::Ridge));  // the diagonal of a 20-lattice
  }
  const Tin dense = lattice(20, 20, hills, edges);
  const Simplified result = run(dense, {.max_error = 5.0});
  EXPECT_EQ(result.fixed, 14U);
  EXPECT_EQ(result.tin.constraint_edges().size(), edges.size());
  for (const ConstraintEdge& e : result.tin.constraint_edges()) EXPECT_EQ(e.kind, EdgeKind::Ridge);
  EXPECT_LE(static_cast<double>(plain_largest_error(dense, result.tin)), 5.0);
}

// An outline with a bay and a hole: straight pieces lose vertices, corners stay, nothing outside is covered.
TEST(Simplify, TheOutlineStays) {
  const Tin whole = lattice(16, 12, hills);
  std::vector<bool> keep(whole.triangle_count());
  for (std::size_t t = 0; t < keep.size(); ++t) {
    Point2 centre{};
    for (const VertexId v : whole.triangle(TriangleId{t})) {
      centre.x += whole.point(v).x / 3;
      centre.y += whole.point(v).y / 3;
    }
    const bool bay = centre.x > 6 && centre.x < 10 && centre.y > 7;
    const bool hole = centre.x > 3 && centre.x < 5 && centre.y > 2 && centre.y < 5;
    keep[t] = !bay && !hole;
  }
  const Tin cut = keep_triangles(whole, keep);
  std::vector<bool> used(cut.vertex_count());
  std::vector<VertexId> renamed(cut.vertex_count());
  for (const Triangle& t : cut.triangles()) {
    for (const VertexId v : t) used[v.index()] = true;
  }
  std::vector<Point2> points;
  std::vector<double> heights;
  for (std::size_t v = 0; v < used.size(); ++v) {
    if (!used[v]) continue;
    renamed[v] = VertexId{points.size()};
    points.push_back(cut.points()[v]);
    heights.push_back(cut.heights()[v]);
  }
  std::vector<Triangle> triangles(cut.triangles().begin(), cut.triangles().end());
  for (Triangle& t : triangles) {
    for (VertexId& v : t) v = renamed[v.index()];
  }
  const Tin dense(points, heights, triangles, {});
  const Simplified result = run(dense, {.max_error = 1.0});
  EXPECT_TRUE(result.outlined);
  EXPECT_EQ(result.fixed, 8U + 4U);
  EXPECT_LE(static_cast<double>(plain_largest_error(dense, result.tin)), 1.0 + 1e-12);
  expect_left_out_in_their_triangles(dense, result);
  double area = 0;
  for (const Triangle& t : result.tin.triangles()) {
    const Point2 a = result.tin.point(t[0]), b = result.tin.point(t[1]), c = result.tin.point(t[2]);
    area += ((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)) / 2;
  }
  EXPECT_EQ(area, 15 * 11 - 4 * 4 - 2 * 3);
  for (std::size_t i = 0; i < result.tin.halfedge_count(); ++i) {
    EXPECT_EQ(result.tin.on_rim(HalfedgeId{i}), result.tin.kind(HalfedgeId{i}) == EdgeKind::Boundary);
  }
}

TEST(Simplify, DoesNotDependOnIds) {
  test::Random random;
  SCOPED_TRACE(random.trace());
  const Tin dense = lattice(15, 15, [](double x, double y) { return std::floor(hills(x, y)); });
  std::vector<std::size_t> order(dense.vertex_count());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::shuffle(order.begin(), order.end(), random.engine());
  std::vector<Point2> points;
  std::vector<double> heights;
  for (const std::size_t v : order) {
    points.push_back(dense.points()[v]);
    heights.push_back(dense.heights()[v]);
  }
  const Tin shuffled = tin_of(points, heights);
  for (const double limit : {0.5, 1.0, 2.0}) {
    EXPECT_EQ(positions(run(dense, {.max_error = limit}).tin),
              positions(run(shuffled, {.max_error = limit}).tin));
  }
}

// The written coordinates bend the straight rim inwards, as a parallel bends in a metric plane.
TEST(Simplify, TrianglesStayTurnedRightAsWritten) {
  std::vector<Point2> points;
  std::vector<double> heights;
  std::vector<Point2> written;
  for (int y = 0; y < 8; ++y) {
    for (int x = 0; x < 30; ++x) {
      written.push_back({static_cast<double>(x), static_cast<double>(y)});
      points.push_back({written.back().x, y - 0.001 * (x - 15) * (x - 15)});
      heights.push_back(0.01 * hills(x, y));
    }
  }
  const Tin hull = tin_of(points, heights);
  const Tin dense = keep_triangles(hull, drop_turned_rim_triangles(hull, written));
  const Simplified result = run(dense, {.max_error = 0.02, .written = written});
  std::vector<Point2> kept_written;
  for (const VertexId v : result.kept) kept_written.push_back(written[v.index()]);
  EXPECT_TRUE(validate(result.tin, kept_written).empty());
  EXPECT_LT(result.tin.vertex_count(), dense.vertex_count());
  EXPECT_LE(static_cast<double>(plain_largest_error(dense, result.tin)), 0.02 + 1e-12);
}

TEST(Simplify, RefusesAnErrorThatIsNone) {
  const Tin dense = lattice(4, 4, hills);
  Progress progress;
  for (const double error : {-1.0, std::nan("")}) {
    EXPECT_THROW(simplify(dense, {.max_error = error}, progress), Error);
  }
}

}  // namespace
}  // namespace thalweg
