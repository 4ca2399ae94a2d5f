// Laws of Tin, flips, cuts and outlines on random lattices.
#include "support/meshes.hpp"

#include <thalweg/mesh/change_tin.hpp>
#include <thalweg/mesh/rim.hpp>
#include <thalweg/mesh/validate.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace thalweg {
namespace {

double doubled_area(const Tin& tin, const std::vector<VertexId>& loop) {
  double sum = 0;  // exact: whole coordinates
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Point2 p = tin.point(loop[i]), q = tin.point(loop[(i + 1) % loop.size()]);
    sum += p.x * q.y - p.y * q.x;
  }
  return sum;
}

TEST(TinLaws, AnyOrderAndStartOfTrianglesGivesTheSameTin) {
  test::Random random;
  SCOPED_TRACE(random.trace());
  for (int scene = 0; scene < 100; ++scene) {
    const Tin tin = test::random_lattice(8, 6, 5, random);
    std::vector<Triangle> triangles(tin.triangles().begin(), tin.triangles().end());
    std::shuffle(triangles.begin(), triangles.end(), random.engine());
    for (Triangle& t : triangles) std::rotate(t.begin(), t.begin() + random.integer(0, 2), t.end());
    const Tin again = test::make_tin({tin.points().begin(), tin.points().end()}, triangles);
    EXPECT_TRUE(std::ranges::equal(tin.triangles(), again.triangles()));
    EXPECT_TRUE(std::ranges::equal(tin.arrays().twins, again.arrays().twins));
    EXPECT_EQ(2 * tin.edge_count(), tin.halfedge_count() + 2 * (8 + 6 - 2));
  }
}

TEST(TinLaws, FlippingTwiceGivesBackTheTin) {
  test::Random random;
  SCOPED_TRACE(random.trace());
  for (int scene = 0; scene < 100; ++scene) {
    const Tin tin = test::random_lattice(8, 6, 5, random);
    std::vector<HalfedgeId> diagonals;
    for (std::size_t i = 0; i < tin.halfedge_count(); ++i) {
      const HalfedgeId h{i};
      const Point2 p = tin.point(tin.origin(h)), q = tin.point(tin.target(h));
      const bool diagonal = p.x != q.x && p.y != q.y;
      if (diagonal && tin.represents_edge(h) && random.integer(0, 1) == 0) diagonals.push_back(h);
    }
    const Tin flipped = flip_edges(tin, diagonals).tin;
    EXPECT_TRUE(validate(flipped).empty());
    std::vector<HalfedgeId> back;
    for (const HalfedgeId h : diagonals) {
      EXPECT_FALSE(flipped.find_halfedge(tin.origin(h), tin.target(h)).valid());
      back.push_back(flipped.find_halfedge(tin.apex(h), tin.apex(tin.twin(h))));
      ASSERT_TRUE(back.back().valid());
    }
    EXPECT_TRUE(std::ranges::equal(flip_edges(flipped, back).tin.triangles(), tin.triangles()));
  }
}

TEST(TinLaws, RimLoopsEncloseTheTrianglesAndHoldEachRimEdgeOnce) {
  test::Random random;
  SCOPED_TRACE(random.trace());
  for (int scene = 0; scene < 200; ++scene) {
    const Tin whole = test::random_lattice(7, 7, 5, random);
    std::vector<bool> keep(whole.triangle_count());
    for (std::size_t t = 0; t < keep.size(); ++t) keep[t] = random.integer(0, 3) != 0;
    const Tin tin = keep_triangles(whole, keep);
    ASSERT_TRUE(validate(tin).empty());
    double sum = 0;
    std::size_t edges = 0;
    for (const std::vector<VertexId>& loop : rim_loops(tin)) {
      sum += doubled_area(tin, loop);
      edges += loop.size();
      EXPECT_EQ(*std::min_element(loop.begin(), loop.end()), loop.front());
      for (std::size_t i = 0; i < loop.size(); ++i) {
        const HalfedgeId h = tin.find_halfedge(loop[i], loop[(i + 1) % loop.size()]);
        ASSERT_TRUE(h.valid());
        EXPECT_TRUE(tin.on_rim(h));
      }
    }
    EXPECT_EQ(sum, static_cast<double>(tin.triangle_count()));
    EXPECT_EQ(edges, 2 * tin.edge_count() - tin.halfedge_count());
  }
}

}  // namespace
}  // namespace thalweg
