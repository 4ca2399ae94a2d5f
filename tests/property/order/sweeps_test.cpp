// Angular sweeps, and looks through sides, against the oracle on small scenes, and against tests of pairs on
// large ones.
#include "order/occupancy.hpp"
#include "order/side_count.hpp"
#include "order/sweep_count.hpp"

#include <thalweg/mesh/change_tin.hpp>
#include <thalweg/order/constrained_order.hpp>

#include <gtest/gtest.h>
#include <support/oracle/law_testing.hpp>
#include <support/random.hpp>
#include <support/scene_tin.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

namespace thalweg {
namespace {

using detail::Ground;
using oracle::Oracle;

constexpr std::array<OrderDefinition, 6> kSwept = {OrderDefinition::SeesTriang, OrderDefinition::SeesVtx,
                                                   OrderDefinition::ConfEdge,   OrderDefinition::SeesOpp,
                                                   OrderDefinition::Sees3vtx,   OrderDefinition::EmptyQuad};

Triangle counter_clockwise(const Tin& tin, Triangle t) {
  if (orientation(tin.point(t[0]), tin.point(t[1]), tin.point(t[2])) < 0) std::swap(t[1], t[2]);
  return t;
}

constexpr std::size_t kUnlimited = std::numeric_limits<std::size_t>::max();

std::vector<VertexId> sorted(std::span<const VertexId> vertices) {
  std::vector<VertexId> list(vertices.begin(), vertices.end());
  std::sort(list.begin(), list.end());
  return list;
}

struct Counter {
  const Ground& ground;
  detail::Flood flood;
  detail::SweepCount sweeps;
  detail::SideCount sides;
  std::size_t found = 0;  ///< by looks through sides

  TriangleId flood_from(const Triangle& corners) {
    const TriangleId start =
        Tin::triangle_of(ground.face_in_angle(corners[0], corners[1], corners[2]).value());
    flood.start(ground, corners, start, detail::Barrier::BlockingEdges);
    for (std::size_t faces = 1; !flood.spread(faces); faces *= 2) {
    }
    return start;
  }
  std::vector<VertexId> counted(const Triangle& corners, OrderDefinition definition) {
    const TriangleId start = flood_from(corners);
    return sorted(sweeps.count(ground, corners, start, definition, flood));
  }
  // Light from sides must fall on the same, stop as soon as there are more, and say where it goes too far.
  void expect_lit(const Triangle& corners, const std::vector<VertexId>& expected) {
    const auto all = sides.lit(ground, corners, kUnlimited, kUnlimited);
    ASSERT_TRUE(all);
    ASSERT_EQ(sorted(*all), expected);
    for (std::size_t faces = 1; faces < 64; faces *= 2) {
      const auto near = sides.lit(ground, corners, kUnlimited, faces);
      if (near) {
        ASSERT_EQ(sorted(*near), expected);
      }
    }
    for (std::size_t limit = 0; limit < 4; ++limit) {
      const auto some = sides.lit(ground, corners, limit, kUnlimited);
      ASSERT_TRUE(some);
      ASSERT_EQ(some->size() > limit, expected.size() > limit);
    }
  }
  // Looks through sides, where they do not go far, must count the same, and stop as soon as there are more.
  void expect_conflicts(const Triangle& corners, const std::vector<VertexId>& by_corners,
                        const std::vector<VertexId>& expected) {
    const auto all = sides.conflicting(ground, corners, by_corners, kUnlimited);
    if (all) {
      ++found;
      ASSERT_EQ(sorted(*all), expected);
    }
    for (std::size_t limit = by_corners.size(); limit < by_corners.size() + 4; ++limit) {
      const auto some = sides.conflicting(ground, corners, by_corners, limit);
      ASSERT_TRUE(some || !all);
      if (some) {
        ASSERT_EQ(some->size() > limit, expected.size() > limit);
      }
    }
  }
};

// Of all triangles, by all ways of counting.
void expect_what_the_oracle_counts(const Oracle& truth) {
  const Tin tin = test::ground_of(truth.scene());
  const Ground ground(tin, test::mode_of(truth.scene()));
  Counter counter{ground, {}, {}, {}, 0};
  for (const oracle::Corners& corners : truth.valid_triangles()) {
    const auto expected = truth.counted(corners);
    const Triangle t = counter_clockwise(tin, test::triangle(corners));
    std::vector<VertexId> conf_edge;  // which comes before SeesOpp
    for (const OrderDefinition definition : kSwept) {
      std::vector<VertexId> vertices;
      for (int v = 0; v < oracle::kMaxSites; ++v) {
        if ((expected[static_cast<std::size_t>(definition)] >> v & 1U) != 0) {
          vertices.push_back(test::vertex(v));
        }
      }
      ASSERT_EQ(counter.counted(t, definition), vertices)
          << definition_name(definition) << " of " << oracle::to_text(corners);
      if (definition == OrderDefinition::SeesTriang) counter.expect_lit(t, vertices);
      if (definition == OrderDefinition::ConfEdge) conf_edge = vertices;
      if (definition == OrderDefinition::SeesOpp) counter.expect_conflicts(t, vertices, conf_edge);
    }
  }
}

TEST(Sweeps, CountWhatTheOracleCounts) {
  oracle::for_each_scene(oracle::kStreams, 40, {.most = 16, .constraints = 10},
                         expect_what_the_oracle_counts);
}

// The line from 9 to 4 starts in the disc of 1, 6, 9 on ground that hangs together with the triangle outside
// of the disc only, and leaves the polygon there.
TEST(Sweeps, CountWhereTheGroundFallsApartInTheDisc) {
  const oracle::Scene scene{
      .sites = {{87, 8},
                {65, 97},
                {85, 24},
                {46, 46},
                {51, 5},
                {71, 10},
                {60, 91},
                {6, 72},
                {49, 42},
                {41, 66},
                {61, 44},
                {53, 22},
                {40, 80},
                {47, 84},
                {63, 40},
                {80, 22}},
      .constraints = {{0, 1},
                      {0, 2},
                      {0, 5},
                      {0, 14},
                      {1, 2},
                      {1, 6},
                      {1, 10},
                      {1, 11},
                      {3, 7},
                      {3, 9},
                      {4, 5},
                      {4, 8},
                      {6, 7},
                      {8, 9}},
      .boundary = {{0, 2}, {1, 2}, {1, 6}, {6, 7}, {3, 7}, {3, 9}, {8, 9}, {4, 8}, {4, 5}, {0, 5}}};
  ASSERT_EQ(oracle::defect(scene), "");
  expect_what_the_oracle_counts(Oracle(scene));
}

// The definitions one vertex at a time, by walks over the ground.
bool counts(const Ground& ground, const Triangle& t, VertexId p, OrderDefinition definition,
            std::span<const VertexId> inside) {
  const auto beyond = [&](VertexId x) {
    std::size_t side = 0;
    while (orientation(ground.point(t[side]), ground.point(t[(side + 1) % 3]), ground.point(x)) >= 0) ++side;
    return side;
  };
  const std::size_t side = beyond(p);
  const VertexId u = t[side], v = t[(side + 1) % 3], w = t[(side + 2) % 3];
  detail::SideSight side_sight;
  detail::Occupancy occupancy;
  switch (definition) {
    case OrderDefinition::SeesTriang:
      return side_sight.sees_side(ground, p, u, v);
    case OrderDefinition::SeesVtx:
      return side_sight.sees_side(ground, p, u, v) &&
             (ground.sees(p, u) || ground.sees(p, v) || ground.sees(p, w));
    case OrderDefinition::ConfEdge:
      return ground.sees(p, w) || std::any_of(inside.begin(), inside.end(), [&](VertexId r) {
               return beyond(r) != side && ground.sees(p, r);
             });
    case OrderDefinition::SeesOpp:
      return ground.sees(p, w);
    case OrderDefinition::Sees3vtx:
      return ground.sees(p, u) && ground.sees(p, v) && ground.sees(p, w);
    default:
      return occupancy.inspect(ground, {u, v, p}, detail::Inspection::FirstFault).fault ==
             TriangleFault::None;
  }
}

// A wide ring of vertices, on a lattice or not, and short constraint edges, round triangles with large discs.
Tin scattered(test::Random& random, std::size_t count, bool lattice, std::size_t share) {
  std::vector<Point2> points;
  const auto place = [&] {
    return lattice ? static_cast<double>(random.integer(0, 39)) : random.real(0, 40);
  };
  while (points.size() < count) {
    const double x = place();
    points.push_back({x, place()});
  }
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());
  Progress progress;
  const std::vector<double> heights(points.size(), 0.0);
  const Tin plain = triangulate(points, heights, {}, progress);
  std::vector<ConstraintEdge> edges;
  for (std::size_t i = 0; i < plain.halfedge_count(); ++i) {
    const HalfedgeId h{i};
    if (plain.represents_edge(h) && random.integer<std::size_t>(0, 99) < share) {
      edges.push_back({plain.origin(h), plain.target(h), EdgeKind::Breakline});
    }
  }
  return triangulate(points, heights, edges, progress);
}

// Compares the counts of triangles with many vertices in their discs.
void expect_same_as_pairs(const Tin& tin, GroundMode mode, test::Random& random, std::size_t fewest) {
  const Ground ground(tin, mode);
  const ConstrainedOrder order(tin, mode);
  OrderWorkspace workspace;
  Counter counter{ground, {}, {}, {}, 0};
  for (int tries = 0, found = 0; tries < 20000 && found < 40; ++tries) {
    const auto any = [&] { return VertexId{random.integer<std::size_t>(0, tin.vertex_count() - 1)}; };
    Triangle t{any(), any(), any()};
    if (t[0] == t[1] || t[1] == t[2] || t[0] == t[2] || !order.is_valid(t, workspace)) continue;
    t = counter_clockwise(tin, t);
    counter.flood_from(t);
    if (counter.flood.inside().size() < fewest) continue;
    ++found;
    const std::vector<VertexId> inside(counter.flood.inside().begin(), counter.flood.inside().end());
    std::vector<VertexId> conf_edge;
    for (const OrderDefinition definition : kSwept) {
      std::vector<VertexId> expected;
      for (const VertexId p : inside) {
        if (counts(ground, t, p, definition, inside)) expected.push_back(p);
      }
      std::sort(expected.begin(), expected.end());
      ASSERT_EQ(counter.counted(t, definition), expected) << definition_name(definition);
      if (definition == OrderDefinition::SeesTriang) counter.expect_lit(t, expected);
      if (definition == OrderDefinition::ConfEdge) conf_edge = expected;
      if (definition == OrderDefinition::SeesOpp) counter.expect_conflicts(t, expected, conf_edge);
      ASSERT_EQ(order.counted(t, definition, workspace), expected) << definition_name(definition);
    }
  }
  EXPECT_GT(counter.found, 0U);
}

TEST(Sweeps, CountWhatPairsCount) {
  test::Random random;
  SCOPED_TRACE(random.trace());
  for (const bool lattice : {false, true}) {
    for (const std::size_t share : {2, 10, 30}) {
      expect_same_as_pairs(scattered(random, 300, lattice, share), GroundMode::Hull, random, 10);
    }
  }
}

// A star-shaped polygon about the origin.
template <class Radius>
Tin star_polygon(std::size_t corners, const Radius& radius_of) {
  std::vector<Point2> points;
  std::vector<ConstraintEdge> edges;
  for (std::size_t i = 0; i < corners; ++i) {
    const double angle = 2 * 3.141592653589793 * static_cast<double>(i) / static_cast<double>(corners);
    const double radius = radius_of(i);
    points.push_back({radius * std::cos(angle), radius * std::sin(angle)});
    edges.push_back({VertexId{i}, VertexId{(i + 1) % corners}, EdgeKind::Boundary});
  }
  Progress progress;
  const Tin tin = triangulate(points, std::vector<double>(corners, 0.0), edges, progress);
  // Counter-clockwise corners in order: a triangle lies inside exactly if its corners come in that order.
  std::vector<bool> keep;
  for (const Triangle& t : tin.triangles()) keep.push_back(t[0] < t[1] && t[1] < t[2]);
  return keep_triangles(tin, keep);
}

// With long and short spikes.
Tin spiky_polygon(test::Random& random, std::size_t corners) {
  return star_polygon(corners, [&](std::size_t) {
    return random.integer(0, 3) == 0 ? random.real(2, 4) : random.real(8, 10);
  });
}

TEST(Sweeps, CountWhatPairsCountInSimplePolygons) {
  test::Random random;
  SCOPED_TRACE(random.trace());
  for (int i = 0; i < 6; ++i) {
    const Tin tin = spiky_polygon(random, 300);
    EXPECT_TRUE(Ground(tin, GroundMode::Polygon).simple_polygons());
    EXPECT_FALSE(Ground(tin, GroundMode::Hull).simple_polygons());
    expect_same_as_pairs(tin, GroundMode::Polygon, random, 6);
  }
}

// Inside the circle through three corners teeth, and pockets between them that look across to other teeth.
TEST(Sweeps, CountConflictsAcrossSimplePolygons) {
  test::Random random;
  SCOPED_TRACE(random.trace());
  std::size_t beside = 0;  // that do not see their opposite corner
  for (const std::size_t third : {20, 60, 300}) {
    const Tin tin = star_polygon(3 * third, [&](std::size_t i) {
      const std::size_t from_corner = std::min(i % third, third - i % third);
      if (from_corner * 20 < third) return from_corner == 0 ? 2.2 : 2.3;
      return i % 2 == 0 ? random.real(2.05, 2.1) : random.real(2.1, 2.19);
    });
    const Ground ground(tin, GroundMode::Polygon);
    ASSERT_TRUE(ground.simple_polygons());
    const Triangle corners{VertexId{std::size_t{0}}, VertexId{third}, VertexId{2 * third}};
    Counter counter{ground, {}, {}, {}, 0};
    const std::vector<VertexId> found = counter.counted(corners, OrderDefinition::ConfEdge);
    std::vector<VertexId> expected;
    for (const VertexId p : counter.flood.inside()) {
      if (counts(ground, corners, p, OrderDefinition::ConfEdge, counter.flood.inside()))
        expected.push_back(p);
    }
    EXPECT_EQ(found, sorted(expected));
    beside += found.size() - counter.counted(corners, OrderDefinition::SeesOpp).size();
  }
  EXPECT_GT(beside, 0U);
}

// A simple polygon that winds through the points, with no vertex inside: triangles are added as long as each
// brings a new corner, the latest first mostly.
Tin winding_polygon(test::Random& random, std::size_t corners, bool lattice) {
  const Tin all = scattered(random, 4 * corners, lattice, 0);
  std::vector<bool> keep(all.triangle_count(), false), used(all.vertex_count(), false);
  std::vector<HalfedgeId> open;
  const auto add = [&](TriangleId t) {
    keep[t.index()] = true;
    for (std::size_t i = 0; i < 3; ++i) {
      const HalfedgeId h{3 * t.index() + i};
      used[all.origin(h).index()] = true;
      if (!all.on_rim(h)) open.push_back(all.twin(h));
    }
  };
  add(TriangleId{random.integer<std::size_t>(0, all.triangle_count() - 1)});
  for (std::size_t left = corners - 3; left > 0 && !open.empty();) {
    const std::size_t last = open.size() - 1;
    const std::size_t i = random.integer(0, 3) == 0 ? random.integer<std::size_t>(0, last)
                                                    : last - std::min<std::size_t>(last, 1);
    const HalfedgeId entry = open[i];
    open.erase(open.begin() + static_cast<std::ptrdiff_t>(i));
    if (used[all.apex(entry).index()]) continue;
    add(Tin::triangle_of(entry));
    --left;
  }
  return keep_triangles(all, keep);
}

// Corners of triangles that lie near each other.
Triangle some_corners(test::Random& random, const Tin& tin) {
  Triangle corners;
  HalfedgeId h{random.integer<std::size_t>(0, tin.halfedge_count() - 1)};
  for (VertexId& corner : corners) {
    for (int steps = random.integer(0, 4); steps > 0; --steps) {
      if (!tin.on_rim(h)) h = tin.twin(h);
      h = random.integer(0, 1) == 0 ? Tin::next(h) : Tin::previous(h);
    }
    corner = tin.apex(h);
  }
  return corners;
}

TEST(Sweeps, CountConflictsInWindingPolygons) {
  test::Random random;
  SCOPED_TRACE(random.trace());
  std::size_t triangles = 0, beside = 0, none = 0;
  for (int i = 0; i < 60; ++i) {
    const Tin tin = winding_polygon(random, 20 + 4 * static_cast<std::size_t>(i), i % 2 == 0);
    const Ground ground(tin, GroundMode::Polygon);
    ASSERT_TRUE(ground.simple_polygons());
    const ConstrainedOrder order(tin, GroundMode::Polygon);
    OrderWorkspace workspace;
    Counter counter{ground, {}, {}, {}, 0};
    for (int tries = 0; tries < 4000; ++tries) {
      Triangle corners = some_corners(random, tin);
      if (corners[0] == corners[1] || corners[1] == corners[2] || corners[0] == corners[2]) continue;
      if (!order.is_valid(corners, workspace)) continue;
      corners = counter_clockwise(tin, corners);
      const std::vector<VertexId> found = counter.counted(corners, OrderDefinition::ConfEdge);
      const std::vector<VertexId> inside = sorted(counter.flood.inside());
      std::vector<VertexId> expected;
      for (const VertexId p : inside) {
        if (counts(ground, corners, p, OrderDefinition::ConfEdge, inside)) expected.push_back(p);
      }
      ASSERT_EQ(found, expected);
      ++triangles;
      none += inside.size() - found.size();
      beside += found.size() - counter.counted(corners, OrderDefinition::SeesOpp).size();
    }
  }
  EXPECT_GT(triangles, 1000U);
  EXPECT_GT(beside, 100U);
  EXPECT_GT(none, 1000U);
}

TEST(Sweeps, FollowLemma2InSimplePolygons) {
  test::Random random;
  SCOPED_TRACE(random.trace());
  const Tin tin = spiky_polygon(random, 2000);
  const ConstrainedOrder order(tin, GroundMode::Polygon);
  OrderWorkspace workspace;
  for (const Triangle& t : tin.triangles()) {
    EXPECT_EQ(order.counted(t, OrderDefinition::Sees3vtx, workspace),
              order.counted(t, OrderDefinition::EmptyQuad, workspace));
  }
}

TEST(Sweeps, KnowSimplePolygons) {
  // A ring round a hole, and two triangles that meet in a vertex only.
  const std::vector<Point2> ring{{0, 0}, {9, 0}, {9, 9}, {0, 9}, {3, 3}, {6, 3}, {6, 6}, {3, 6}};
  std::vector<Triangle> triangles;
  const auto add = [&](std::size_t a, std::size_t b, std::size_t c) {
    triangles.push_back({VertexId{a}, VertexId{b}, VertexId{c}});
  };
  for (std::size_t i = 0; i < 4; ++i) {
    add(i, (i + 1) % 4, 4 + i);
    add((i + 1) % 4, 4 + (i + 1) % 4, 4 + i);
  }
  const std::vector<double> heights(8, 0.0);
  EXPECT_FALSE(Ground(Tin(ring, heights, triangles, {}), GroundMode::Polygon).simple_polygons());
  triangles.resize(6);
  EXPECT_TRUE(Ground(Tin(ring, heights, triangles, {}), GroundMode::Polygon).simple_polygons());
  triangles.clear();
  add(0, 4, 3);
  add(4, 5, 6);
  EXPECT_FALSE(Ground(Tin(ring, heights, triangles, {}), GroundMode::Polygon).simple_polygons());
}

}  // namespace
}  // namespace thalweg
