// Segments near a query are visited, whatever their lengths and directions.
#include "delaunay/box_tree.hpp"

#include "support/random.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <vector>

namespace thalweg {
namespace {

// Segments between lattice points of a random spacing, so that many are level, upright or run through
// queries.
std::vector<Segment> random_segments(test::Random& random, double spacing) {
  const auto count = random.integer<std::size_t>(1, 60);
  const int side = random.integer(1, 40), longest = random.integer(1, side);
  std::vector<Segment> segments;
  for (std::size_t i = 0; i < count; ++i) {
    const int x = random.integer(0, side), y = random.integer(0, side);
    const int dx = random.integer(-longest, longest), dy = random.integer(-longest, longest);
    segments.push_back({{spacing * x, spacing * y}, {spacing * (x + dx), spacing * (y + dy)}});
  }
  return segments;
}

TEST(SegmentTree, VisitsEverySegmentThatHasAPointInTheQuery) {
  test::Random random;
  SCOPED_TRACE(random.trace());
  for (int scene = 0; scene < 2000; ++scene) {
    const double spacing = std::ldexp(1.0, random.integer(-20, 20));
    const std::vector<Segment> segments = random_segments(random, spacing);
    const BoxTree tree = segment_tree(segments, Progress());
    for (int query = 0; query < 40; ++query) {
      const std::size_t wanted = random.integer<std::size_t>(0, segments.size() - 1);
      const auto& [a, b] = segments[wanted];
      const double t = random.integer(0, 64) / 64.0;  // with a + t (b - a) exact
      const Point2 p = {a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)};
      std::set<std::uint32_t> visited;
      tree.visit(box_around(p, spacing * random.integer(0, 3) / 8.0),
                 [&](std::uint32_t segment) { visited.insert(segment); });
      ASSERT_TRUE(visited.contains(static_cast<std::uint32_t>(wanted)));
    }
  }
}

TEST(SegmentTree, LeavesOutOnlyWhatSharesAnEnd) {
  test::Random random;
  SCOPED_TRACE(random.trace());
  for (int scene = 0; scene < 500; ++scene) {
    const std::vector<Segment> segments = random_segments(random, 1);
    const auto last_vertex = random.integer<std::uint32_t>(1, 20);
    std::vector<BoxTree::Ends> ends;
    for (std::size_t i = 0; i < segments.size(); ++i) {
      const bool in_fan = random.integer(0, 3) > 0;
      ends.push_back({in_fan ? 0 : random.integer(0U, last_vertex), random.integer(0U, last_vertex)});
    }
    BoxTree tree = segment_tree(segments, Progress());
    tree.note_ends(ends);
    for (int query = 0; query < 40; ++query) {
      const Box2 box = box_around(segments[random.integer<std::size_t>(0, segments.size() - 1)].a, 3);
      const BoxTree::Ends own{random.integer(0U, last_vertex), random.integer(0U, last_vertex)};
      std::set<std::uint32_t> all, apart;
      tree.visit(box, [&](std::uint32_t segment) { all.insert(segment); });
      tree.visit_apart(own, box, [&](std::uint32_t segment) {
        EXPECT_TRUE(all.contains(segment));
        apart.insert(segment);
      });
      for (const std::uint32_t segment : all) {
        const auto [a, b] = ends[segment];
        const bool shares = a == own[0] || a == own[1] || b == own[0] || b == own[1];
        ASSERT_TRUE(shares || apart.contains(segment));
      }
    }
  }
}

}  // namespace
}  // namespace thalweg
