// Our triangulation against CGAL's: the same triangles, whatever the points and constraint edges.
#include "noded.hpp"

#include <thalweg/base/error.hpp>
#include <thalweg/delaunay/triangulate.hpp>

#include <support/random.hpp>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <functional>
#include <numbers>

namespace thalweg {
namespace {

using test::Random;
using Place = std::function<Point2(Random&)>;

struct Scene {
  std::vector<Point2> points;
  std::vector<ConstraintEdge> constraints;
};

// Distinct points, and the links of a noding of random segments among them and of a few long ones.
Scene make_scene(Random& random, std::size_t points, std::size_t segments, const Place& place) {
  std::set<Point2> distinct;
  for (std::size_t i = 0; i < points; ++i) distinct.insert(place(random));
  Scene scene;
  scene.points.assign(distinct.begin(), distinct.end());
  std::shuffle(scene.points.begin(), scene.points.end(), random.engine());
  std::vector<SegmentEnds> ends;
  const auto any = [&] {
    return random.integer<std::uint32_t>(0, static_cast<std::uint32_t>(scene.points.size()) - 1);
  };
  for (std::size_t i = 0; i < segments; ++i) {
    const std::uint32_t a = any(), b = any();
    if (a != b) ends.push_back({a, b});
  }
  Progress progress;
  const Noding noding = node_segments(scene.points, ends, progress);
  EXPECT_FALSE(noding.failure.has_value());
  scene.points.insert(scene.points.end(), noding.crossings.begin(), noding.crossings.end());
  for (const auto& [a, b] : test::all_links(noding)) {
    scene.constraints.push_back({VertexId{a}, VertexId{b}, EdgeKind::Breakline});
  }
  return scene;
}

void expect_same(const Scene& scene) {
  Progress progress;
  const std::vector<double> heights(scene.points.size(), 0.0);
  const Tin ours = triangulate(scene.points, heights, scene.constraints, progress, TriangulationEngine::Flat);
  const Tin theirs =
      triangulate(scene.points, heights, scene.constraints, progress, TriangulationEngine::Cgal);
  ASSERT_EQ(ours.triangle_count(), theirs.triangle_count());
  EXPECT_TRUE(std::equal(ours.triangles().begin(), ours.triangles().end(), theirs.triangles().begin()));
}

void expect_same_scenes(std::size_t scenes, std::size_t points, std::size_t segments, const Place& place) {
  Random random;
  SCOPED_TRACE(random.trace());
  for (std::size_t i = 0; i < scenes; ++i) {
    SCOPED_TRACE("scene " + std::to_string(i));
    expect_same(make_scene(random, points, segments, place));
    if (testing::Test::HasFailure()) return;
  }
}

Point2 anywhere(Random& random) {
  return {random.real(0, 1000), random.real(0, 1000)};
}

Point2 on_lattice(Random& random) {
  return {500000.3 + random.integer(0, 30), 4000000.7 + 2 * random.integer(0, 30)};
}

// Points of Pythagoras: exactly cocircular.
Point2 on_circle(Random& random) {
  static constexpr std::array<Point2, 5> kTriples{{{65, 0}, {63, 16}, {60, 25}, {56, 33}, {52, 39}}};
  Point2 p = kTriples[random.integer<std::size_t>(0, kTriples.size() - 1)];
  if (random.integer(0, 1) == 1) std::swap(p.x, p.y);
  if (random.integer(0, 1) == 1) p.x = -p.x;
  if (random.integer(0, 1) == 1) p.y = -p.y;
  return p;
}

Point2 near_circle(Random& random) {
  const double angle = random.real(0, 2 * std::numbers::pi);
  return {1000 * std::cos(angle), 1000 * std::sin(angle)};
}

Point2 near_line(Random& random) {
  const double t = random.real(0, 1000);
  return {t, 0.3 * t + std::ldexp(random.integer(-3, 3), -40)};
}

Point2 clustered(Random& random) {
  const double scale = std::ldexp(1.0, -random.integer(0, 30));
  return {500000 + scale * random.real(0, 1000), 4000000 + scale * random.real(0, 1000)};
}

TEST(Engines, AgreeOnFewPoints) {
  expect_same_scenes(300, 12, 3, anywhere);
}
TEST(Engines, AgreeOnRandomPoints) {
  expect_same_scenes(10, 3000, 60, anywhere);
}
TEST(Engines, AgreeOnLattices) {
  expect_same_scenes(60, 500, 12, on_lattice);
}
TEST(Engines, AgreeOnCocircularPoints) {
  expect_same_scenes(100, 60, 6, on_circle);
}
TEST(Engines, AgreeOnNearlyCocircularPoints) {
  expect_same_scenes(20, 500, 20, near_circle);
}
TEST(Engines, AgreeOnNearlyCollinearPoints) {
  expect_same_scenes(30, 300, 10, near_line);
}
TEST(Engines, AgreeOnClusters) {
  expect_same_scenes(20, 1000, 20, clustered);
}

// Enough points for strips on several threads.
TEST(Engines, AgreeAcrossStrips) {
  const tbb::global_control threads(tbb::global_control::max_allowed_parallelism, 3);
  expect_same_scenes(1, 150000, 0, anywhere);
  Scene lattice;
  for (int y = 0; y < 300; ++y) {
    for (int x = 0; x < 400; ++x) lattice.points.push_back({377813.655 + 30 * x, 3792917.828 + 30 * y});
  }
  expect_same(lattice);
  Random random;
  Scene circle;
  std::set<Point2> distinct;
  for (int i = 0; i < 100000; ++i) distinct.insert(near_circle(random));
  circle.points.assign(distinct.begin(), distinct.end());
  expect_same(circle);
}

// Points near a lattice, and in many of its squares a diagonal.
Scene make_diagonals(Random& random, int columns, int rows) {
  Scene scene;
  for (int y = 0; y < rows; ++y) {
    for (int x = 0; x < columns; ++x) {
      scene.points.push_back({x + random.real(-0.2, 0.2), y + random.real(-0.2, 0.2)});
    }
  }
  const auto at = [columns](int x, int y) { return VertexId{static_cast<std::size_t>(y * columns + x)}; };
  for (int y = 0; y + 1 < rows; ++y) {
    for (int x = 0; x + 1 < columns; ++x) {
      if (random.integer(0, 2) > 0) continue;
      const bool rises = random.integer(0, 1) == 1;
      scene.constraints.push_back(
          {at(x, rises ? y : y + 1), at(x + 1, rises ? y + 1 : y), EdgeKind::Breakline});
    }
  }
  return scene;
}

// Enough edges for several threads; some lead from one thread's vertices to another's, one past all of them.
TEST(Engines, AgreeWhereThreadsShareTheEdges) {
  Random random;
  SCOPED_TRACE(random.trace());
  Scene scene = make_diagonals(random, 500, 300);
  scene.points.push_back({-300, 320});
  scene.points.push_back({800, 320});
  scene.constraints.push_back(
      {VertexId{scene.points.size() - 2}, VertexId{scene.points.size() - 1}, EdgeKind::Breakline});
  tbb::task_arena(4).execute([&] { expect_same(scene); });
}

TEST(Engines, NameTheSameCrossingWhateverTheThreads) {
  Random random;
  SCOPED_TRACE(random.trace());
  Scene scene = make_diagonals(random, 500, 300);
  for (std::size_t i = 0; i < 20; ++i) {  // the other diagonals of some squares
    const ConstraintEdge edge = scene.constraints[i * scene.constraints.size() / 20];
    scene.constraints.push_back({VertexId{edge.a.value() + 1}, VertexId{edge.b.value() - 1}});
  }
  const auto message = [&] {
    try {
      Progress progress;
      triangulate(scene.points, std::vector<double>(scene.points.size(), 0.0), scene.constraints, progress);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const std::string by_one = tbb::task_arena(1).execute(message);
  EXPECT_NE(by_one, "");
  EXPECT_EQ(tbb::task_arena(4).execute(message), by_one);
}

// A fan of edges that hang into the cavity of one long edge.
TEST(Engines, AgreeOnHangingEdges) {
  Scene comb;
  const auto add = [&](double x, double y) {
    comb.points.push_back({x, y});
    return VertexId{comb.points.size() - 1};
  };
  const VertexId left = add(-10, 0.5), right = add(1010, 0.25);
  for (int i = 0; i < 100; ++i) {
    const VertexId top = add(10.0 * i, 50 + i % 7), tip = add(10.0 * i + 3, 2 + i % 5);
    comb.constraints.push_back({top, tip, EdgeKind::Breakline});
    const VertexId bottom = add(10.0 * i + 1, -50 - i % 5), low_tip = add(10.0 * i + 4, -1 - i % 3);
    comb.constraints.push_back({bottom, low_tip, EdgeKind::Breakline});
  }
  comb.constraints.push_back({left, right, EdgeKind::Valley});
  expect_same(comb);
}

}  // namespace
}  // namespace thalweg
