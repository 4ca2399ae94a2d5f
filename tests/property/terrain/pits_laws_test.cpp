// find_pits against a count straight from the definition, on random TINs full of plateaus.
#include "support/meshes.hpp"

#include <thalweg/mesh/change_tin.hpp>
#include <thalweg/terrain/pits.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <set>
#include <vector>

namespace thalweg {
namespace {

// By adjacency sets and repeated passes; shares nothing with the library but the list of triangles.
PitSummary count_by_definition(const Tin& tin) {
  const std::size_t n = tin.vertex_count();
  std::map<std::pair<std::size_t, std::size_t>, int> uses;
  for (const Triangle& t : tin.triangles()) {
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [low, high] = std::minmax({t[i].index(), t[(i + 1) % 3].index()});
      ++uses[{low, high}];
    }
  }
  std::vector<std::size_t> label(n);
  std::iota(label.begin(), label.end(), 0U);
  for (bool changed = true; changed;) {  // the smallest id of a plateau spreads
    changed = false;
    for (const auto& [edge, count] : uses) {
      const auto [a, b] = edge;
      if (tin.heights()[a] != tin.heights()[b] || label[a] == label[b]) continue;
      label[a] = label[b] = std::min(label[a], label[b]);
      changed = true;
    }
  }
  std::set<std::size_t> drained, rim, lakes, used;
  for (const auto& [edge, count] : uses) {
    const auto [a, b] = edge;
    used.insert({label[a], label[b]});
    if (tin.heights()[a] < tin.heights()[b]) drained.insert(label[b]);
    if (tin.heights()[b] < tin.heights()[a]) drained.insert(label[a]);
    if (count == 1) rim.insert({label[a], label[b]});
  }
  for (const ConstraintEdge& e : tin.constraint_edges()) {
    if (has(e.kind, EdgeKind::Lake) && label[e.a.index()] == label[e.b.index()])
      lakes.insert(label[e.a.index()]);
  }
  PitSummary summary;
  summary.is_pit.assign(n, 0);
  for (const std::size_t plateau : used) {
    if (drained.contains(plateau)) continue;
    const PitKind kind = rim.contains(plateau)     ? PitKind::Boundary
                         : lakes.contains(plateau) ? PitKind::Lake
                                                   : PitKind::Interior;
    ++(kind == PitKind::Boundary ? summary.boundary
       : kind == PitKind::Lake   ? summary.lake
                                 : summary.interior);
    for (std::size_t v = 0; v < n; ++v) {
      if (label[v] == plateau) summary.is_pit[v] = static_cast<std::uint8_t>(kind);
    }
  }
  return summary;
}

Tin with_random_lakes_and_holes(const Tin& tin, test::Random& random) {
  std::vector<ConstraintEdge> constraints;
  for (std::size_t i = 0; i < tin.halfedge_count(); ++i) {
    const HalfedgeId h{i};
    if (!tin.represents_edge(h) || random.integer(0, 19) != 0) continue;
    constraints.push_back(
        {tin.origin(h), tin.target(h), random.integer(0, 1) == 0 ? EdgeKind::Lake : EdgeKind::Ridge});
  }
  const Tin marked({tin.points().begin(), tin.points().end()}, {tin.heights().begin(), tin.heights().end()},
                   {tin.triangles().begin(), tin.triangles().end()}, constraints);
  std::vector<bool> keep(tin.triangle_count());
  for (std::size_t t = 0; t < keep.size(); ++t) keep[t] = random.integer(0, 29) != 0;
  return keep_triangles(marked, keep);
}

TEST(FindPitsLaws, CountsWhatTheDefinitionCounts) {
  test::Random random;
  SCOPED_TRACE(random.trace());
  for (int scene = 0; scene < 400; ++scene) {
    const int levels = random.integer(1, 8);
    const Tin lattice = test::random_lattice(random.integer<std::size_t>(2, 14),
                                             random.integer<std::size_t>(2, 14), levels, random);
    const Tin tin = scene % 2 == 0 ? lattice : with_random_lakes_and_holes(lattice, random);
    const PitSummary expected = count_by_definition(tin);
    const PitSummary pits = find_pits(tin);
    ASSERT_EQ(pits.interior, expected.interior) << "scene " << scene;
    ASSERT_EQ(pits.boundary, expected.boundary) << "scene " << scene;
    ASSERT_EQ(pits.lake, expected.lake) << "scene " << scene;
    ASSERT_EQ(pits.is_pit, expected.is_pit) << "scene " << scene;
  }
}

// Renumbering vertices renames pits and changes nothing else.
TEST(FindPitsLaws, IdsDoNotMatter) {
  test::Random random;
  SCOPED_TRACE(random.trace());
  for (int scene = 0; scene < 50; ++scene) {
    const Tin tin = test::random_lattice(12, 9, 4, random);
    std::vector<std::size_t> new_id(tin.vertex_count());
    std::iota(new_id.begin(), new_id.end(), 0U);
    std::shuffle(new_id.begin(), new_id.end(), random.engine());
    std::vector<Point2> points(tin.vertex_count());
    std::vector<double> heights(tin.vertex_count());
    std::vector<Triangle> triangles;
    for (std::size_t v = 0; v < new_id.size(); ++v) {
      points[new_id[v]] = tin.points()[v];
      heights[new_id[v]] = tin.heights()[v];
    }
    for (const Triangle& t : tin.triangles()) {
      triangles.push_back(test::triangle(new_id[t[0].index()], new_id[t[1].index()], new_id[t[2].index()]));
    }
    const PitSummary before = find_pits(tin);
    const PitSummary after = find_pits(test::make_tin(points, triangles, {}, heights));
    EXPECT_EQ(before.interior, after.interior);
    EXPECT_EQ(before.boundary, after.boundary);
    for (std::size_t v = 0; v < new_id.size(); ++v) EXPECT_EQ(before.is_pit[v], after.is_pit[new_id[v]]);
  }
}

}  // namespace
}  // namespace thalweg
