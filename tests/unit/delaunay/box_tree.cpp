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

}  // namespace
}  // namespace thalweg
