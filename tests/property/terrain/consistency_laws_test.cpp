// Drawn lines against plain code, against the flow on the same surface, and against the optimiser's criteria.
#include "support/plain_water.hpp"
#include "support/terrains.hpp"

#include <thalweg/optimize/optimize.hpp>
#include <thalweg/terrain/consistency.hpp>
#include <thalweg/terrain/pit_table.hpp>
#include <thalweg/terrain/surface_flow.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <vector>

namespace thalweg {
namespace {

/// Whole coordinates and heights, so that plain code is exact; some edges are drawn as valleys.
Tin whole_terrain(int i, test::Random& random) {
  const Tin tin = test::random_terrain(i, random);
  std::map<Point2, double> places;
  for (std::size_t v = 0; v < tin.vertex_count(); ++v) {
    const Point2 p = tin.point(VertexId{v});
    places[{std::round(8 * p.x), std::round(8 * p.y)}] = std::round(2 * tin.heights()[v]);
  }
  std::vector<Point2> points;
  std::vector<double> heights;
  for (const auto& [p, height] : places) {
    points.push_back(p);
    heights.push_back(height);
  }
  Progress progress;
  const Tin plain = triangulate(points, heights, {}, progress);
  std::vector<ConstraintEdge> valleys;
  for (std::size_t h = 0; h < plain.halfedge_count(); ++h) {
    const HalfedgeId edge{h};
    if (!plain.represents_edge(edge) || random.integer(0, 5) > 0) continue;
    valleys.push_back({plain.origin(edge), plain.target(edge), EdgeKind::Valley});
  }
  return triangulate(std::move(points), std::move(heights), valleys, progress);
}

double criterion_of(const Tin& tin, Criterion criterion) {
  Progress progress;
  return optimize_first_order(tin, {}, {.criteria = {criterion}}, progress).criteria[0].delaunay;
}

TEST(ConsistencyLaws, DrawnValleysAreThoseOfPlainCodeAndOfTheCriteria) {
  test::Random random;
  SCOPED_TRACE(random.trace());
  double draining = 0;
  for (int i = 0; i < 120; ++i) {
    const Tin tin = whole_terrain(i, random);
    const Consistency found = check_consistency(tin, {});
    const test::PlainWater water(tin, 1, 1);
    double length = 0;
    for (const auto& [edge, triangles] : test::triangles_by_edge(tin)) {
      const bool drains = triangles.size() == 2 && water.drains(triangles[0], triangles[1], edge);
      if (!drains || !water.is_drawn_valley(edge)) continue;
      const Point2 a = tin.point(edge.first), b = tin.point(edge.second);
      length += std::hypot(a.x - b.x, a.y - b.y);
    }
    std::size_t on_valleys = 0;
    for (const Triangle& t : tin.triangles()) on_valleys += water.on_valleys(t) ? 1 : 0;
    EXPECT_NEAR(found.draining_length_m, length, 1e-6) << i;
    EXPECT_EQ(found.triangles_on_valleys, on_valleys) << i;
    EXPECT_NEAR(criterion_of(tin, Criterion::DrainingValleys), found.draining_length_m, 1e-6) << i;
    EXPECT_EQ(criterion_of(tin, Criterion::ValleyTriangles), static_cast<double>(on_valleys)) << i;
    EXPECT_EQ(criterion_of(tin, Criterion::FlatTriangles), static_cast<double>(found.flat_triangles)) << i;
    draining += length;
  }
  EXPECT_GT(draining, 0);
}

TEST(ConsistencyLaws, ValleyEdgesAreThoseOfTheFlow) {
  test::Random random;
  SCOPED_TRACE(random.trace());
  for (int i = 0; i < 60; ++i) {
    const Tin tin = whole_terrain(i, random);
    Progress progress;
    const SurfaceFlow flow(tin, {}, progress);
    std::size_t undrawn = 0;
    for (std::size_t h = 0; h < tin.halfedge_count(); ++h) {
      const HalfedgeId edge{h};
      const bool counts = tin.represents_edge(edge) && !has(tin.kind(edge), EdgeKind::Valley);
      undrawn += counts && flow.is_valley(edge) ? 1 : 0;
    }
    EXPECT_EQ(check_consistency(tin, {}).undrawn_valley_edges, undrawn) << i;
  }
}

/// The two modules find spills by different ways: one walks from each pit, one sweeps heights.
TEST(ConsistencyLaws, DepthsOfPitsSumToTheCriterion) {
  test::Random random;
  SCOPED_TRACE(random.trace());
  for (int i = 0; i < 150; ++i) {
    const Tin tin = test::random_terrain(i, random);
    Progress progress;
    const SurfaceFlow flow(tin, {}, progress);
    double sum = 0;
    for (const Pit& pit : tabulate_pits(flow, {}, progress).pits) sum += pit.depth_m;
    EXPECT_NEAR(criterion_of(tin, Criterion::PitDepth), sum, 1e-6) << i;
  }
}

}  // namespace
}  // namespace thalweg
