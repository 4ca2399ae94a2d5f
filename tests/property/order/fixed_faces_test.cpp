// The fixed-edge subdivision and the triangulations of its faces, against all triangulations of the oracle.
#include <thalweg/delaunay/triangulate.hpp>
#include <thalweg/mesh/change_tin.hpp>
#include <thalweg/order/fixed_faces.hpp>
#include <thalweg/order/useful_triangles.hpp>

#include <gtest/gtest.h>
#include <support/oracle/law_testing.hpp>
#include <support/oracle/triangulations.hpp>
#include <support/scene_tin.hpp>

#include <algorithm>
#include <limits>
#include <map>
#include <set>

namespace thalweg {
namespace {

using oracle::Corners;
using oracle::Edge;
using oracle::kStreams;
using oracle::Oracle;
using oracle::SceneOptions;

constexpr SceneOptions kSmall{.fewest = 4, .most = 9, .constraints = 6};
using Triangulation = std::vector<Corners>;

Corners corners_of(const Triangle& t) {
  return {static_cast<int>(t[0].value()), static_cast<int>(t[1].value()), static_cast<int>(t[2].value())};
}

std::set<Triangulation> by_enumeration(const oracle::Enumeration& all, OrderDefinition definition, int k) {
  std::set<Triangulation> found;
  for (const std::size_t i : all.of_order(static_cast<oracle::Definition>(definition), k)) {
    Triangulation triangles;
    for (const int t : all.members[i]) triangles.push_back(all.triangles[static_cast<std::size_t>(t)]);
    std::sort(triangles.begin(), triangles.end());
    found.insert(triangles);
  }
  return found;
}

// One triangulation of each face, in all combinations.
std::set<Triangulation> by_faces(const FixedFaces& faces) {
  std::vector<Triangulation> found(1);
  for (std::size_t t = 0; t < faces.triangles.size(); ++t) {
    const auto& sides = faces.sides[t];
    if (std::any_of(sides.begin(), sides.end(), [&](auto side) { return faces.edges[side / 2].free; }))
      continue;
    found[0].push_back(corners_of(faces.triangles[t].corners));
  }
  for (std::size_t face = 0; face < faces.faces.size(); ++face) {
    const auto list = list_triangulations(faces, face, {.most = 1'000'000});
    EXPECT_TRUE(list.has_value());
    std::vector<Triangulation> longer;
    for (const Triangulation& before : found) {
      for (std::size_t i = 0; i < list->count(); ++i) {
        longer.push_back(before);
        for (const std::uint32_t t : (*list)[i])
          longer.back().push_back(corners_of(faces.triangles[t].corners));
      }
    }
    found = std::move(longer);
  }
  const std::size_t count = found.size();
  for (Triangulation& triangles : found) std::sort(triangles.begin(), triangles.end());
  std::set<Triangulation> all(found.begin(), found.end());
  EXPECT_EQ(all.size(), count);
  return all;
}

void expect_laws(const FixedFaces& faces, const std::set<Triangulation>& all) {
  std::set<Corners> used;
  std::map<Edge, std::size_t> times;
  for (const Triangulation& triangles : all) {
    used.insert(triangles.begin(), triangles.end());
    for (const Edge& edge : oracle::edges_of(triangles)) ++times[edge];
  }
  std::set<Corners> candidates;
  for (const OrderTriangle& t : faces.triangles) candidates.insert(corners_of(t.corners));
  ASSERT_EQ(candidates, used);
  ASSERT_EQ(faces.edges.size(), times.size());
  for (const CandidateEdge& edge : faces.edges) {
    const Edge ends{static_cast<int>(edge.a.value()), static_cast<int>(edge.b.value())};
    ASSERT_EQ(edge.free, times.at(ends) < all.size()) << ends.first << "-" << ends.second;
  }
}

TEST(FixedFaces, HoldAllTriangulations) {
  for_each_scene(kStreams, 25, kSmall, [](const Oracle& oracle) {
    const oracle::Enumeration enumeration = enumerate(oracle);
    const Tin ground = test::ground_of(oracle.scene());
    const ConstrainedOrder order(ground, test::mode_of(oracle.scene()));
    Progress progress;
    for (const OrderDefinition definition : kOrderDefinitions) {
      for (int k = 0; k <= 4; ++k) {
        const auto all = by_enumeration(enumeration, definition, k);
        auto triangles = find_order_triangles(
            order, {.definition = definition, .max_order = static_cast<std::size_t>(k)}, progress);
        const auto faces = find_fixed_faces(ground, std::move(triangles), {}, progress);
        ASSERT_EQ(faces.has_value(), !all.empty()) << definition_name(definition) << " " << k;
        if (!faces) continue;
        ASSERT_EQ(by_faces(*faces), all) << definition_name(definition) << " " << k;
        ASSERT_NO_FATAL_FAILURE(expect_laws(*faces, all)) << definition_name(definition) << " " << k;
      }
    }
  });
}

// On a part of the ground: the triangulations of the whole that keep what is off the surface.
TEST(FixedFaces, AreThoseOfASurface) {
  for_each_scene(kStreams, 25, kSmall, [](const Oracle& oracle) {
    const Tin ground = test::ground_of(oracle.scene());
    const ConstrainedOrder order(ground, test::mode_of(oracle.scene()));
    Progress progress;
    const auto triangles = find_order_triangles(order, {.max_order = 3}, progress);
    std::vector<bool> keep(ground.triangle_count(), true);
    for (std::size_t t = 0; t < keep.size(); t += 3) keep[t] = false;
    const Tin surface = keep_triangles(ground, keep);
    if (surface.triangle_count() == 0) return;
    const auto faces = find_fixed_faces(surface, keep_on_surface(surface, triangles, progress), {}, progress);
    ASSERT_TRUE(faces.has_value());
    std::set<Triangulation> expected;
    std::set<Corners> off;
    for (std::size_t t = 0; t < keep.size(); ++t) {
      if (!keep[t]) off.insert(corners_of(ground.triangle(TriangleId{t})));
    }
    for (Triangulation whole : by_enumeration(enumerate(oracle), OrderDefinition::SeesOpp, 3)) {
      const auto gone = std::erase_if(whole, [&](const Corners& t) { return off.contains(t); });
      if (static_cast<std::size_t>(gone) == off.size()) expected.insert(whole);
    }
    ASSERT_EQ(by_faces(*faces), expected);
  });
}

// Without constraint edges the search from edge to edge misses no triangle that a triangulation has.
TEST(FixedFaces, AreTheSameOfUsefulTriangles) {
  oracle::Dice dice("useful-triangles");
  for (int i = 0; i < 40; ++i) {
    const int range = i % 2 == 0 ? 12 : 1000;  // a lattice with gaps; nearly general position
    std::set<std::pair<int, int>> places;
    for (int n = dice.between(3, 120); n > 0; --n) {
      const int x = dice.between(0, range);
      places.emplace(x, dice.between(0, range));
    }
    std::vector<Point2> points;
    for (const auto& [x, y] : places) points.push_back({static_cast<double>(x), static_cast<double>(y)});
    std::vector<double> heights(points.size(), 0);
    Progress progress;
    const Tin ground = triangulate(std::move(points), std::move(heights), {}, progress);
    if (ground.triangle_count() == 0) continue;
    const ConstrainedOrder order(ground);
    const std::size_t most = std::numeric_limits<std::size_t>::max();
    ASSERT_TRUE(find_useful_triangles(order, {.max_order = most}, progress) ==
                find_useful_triangles(order, {.max_order = most - 1}, progress));
    for (std::size_t k = 0; k <= 4; ++k) {
      const OrderTriangleOptions options{.max_order = k};
      const auto all = find_order_triangles(order, options, progress);
      const auto useful = find_useful_triangles(order, options, progress);
      ASSERT_TRUE(std::includes(all.begin(), all.end(), useful.begin(), useful.end())) << i << " " << k;
      const auto of_all = find_fixed_faces(ground, all, {}, progress);
      const auto of_useful = find_fixed_faces(ground, useful, {}, progress);
      ASSERT_TRUE(of_all && of_useful);
      ASSERT_TRUE(of_all->triangles == of_useful->triangles) << i << " " << k;
      ASSERT_EQ(of_all->faces.items, of_useful->faces.items) << i << " " << k;
    }
  }
}

}  // namespace
}  // namespace thalweg
