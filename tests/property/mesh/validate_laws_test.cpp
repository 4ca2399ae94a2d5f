// `validate` against looking at all pairs, on random heaps of triangles, sound and unsound ones.
#include "support/meshes.hpp"

#include <thalweg/geometry/predicates.hpp>
#include <thalweg/mesh/validate.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <vector>

namespace thalweg {
namespace {

struct Heap {
  std::vector<Point2> points;
  std::vector<Triangle> triangles;
};

// Interiors of counter-clockwise triangles are disjoint exactly if an edge of one of them separates them.
bool interiors_meet(const Heap& heap, const Triangle& s, const Triangle& t) {
  const auto separates = [&](const Triangle& a, const Triangle& b) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Point2 p = heap.points[a[i].index()], q = heap.points[a[(i + 1) % 3].index()];
      if (std::all_of(b.begin(), b.end(),
                      [&](VertexId v) { return orientation(p, q, heap.points[v.index()]) <= 0; })) {
        return true;
      }
    }
    return false;
  };
  return !separates(s, t) && !separates(t, s);
}

bool in_closed_triangle(const Heap& heap, const Triangle& t, Point2 p) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (orientation(heap.points[t[i].index()], heap.points[t[(i + 1) % 3].index()], p) < 0) return false;
  }
  return true;
}

// The codes of overlap, touching vertices and equal positions that hold, by definition.
std::set<int> codes_by_definition(const Heap& heap) {
  std::set<int> codes;
  for (std::size_t i = 0; i < heap.triangles.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (interiors_meet(heap, heap.triangles[i], heap.triangles[j])) codes.insert(violation::kOverlap);
    }
  }
  for (std::size_t v = 0; v < heap.points.size(); ++v) {
    for (std::size_t w = 0; w < v; ++w) {
      if (heap.points[v] == heap.points[w]) codes.insert(violation::kSamePosition);
    }
    for (const Triangle& t : heap.triangles) {
      if (std::find(t.begin(), t.end(), VertexId{v}) != t.end()) continue;
      if (in_closed_triangle(heap, t, heap.points[v])) codes.insert(violation::kVertexOnSurface);
    }
  }
  return codes;
}

// Random triangles on few lattice points; sparse: overlapping ones are refused most of the time.
Heap random_heap(test::Random& random) {
  Heap heap;
  const int side = random.integer(2, 6);
  const std::size_t n = random.integer<std::size_t>(3, 9);
  while (heap.points.size() < n) {
    const Point2 p = {random.integer(0, side) * 1.0, random.integer(0, side) * 1.0};
    const bool taken = std::find(heap.points.begin(), heap.points.end(), p) != heap.points.end();
    if (!taken || random.integer(0, 39) == 0) heap.points.push_back(p);
  }
  const int refuse = random.integer(0, 1) == 0 ? 40 : 2;
  std::set<std::pair<VertexId, VertexId>> sides;
  for (int attempt = random.integer(1, 60); attempt > 0; --attempt) {
    const std::size_t a = random.integer<std::size_t>(0, n - 3);
    Triangle t = test::triangle(a, random.integer(a + 1, n - 1), random.integer(a + 1, n - 1));
    const int turn =
        orientation(heap.points[t[0].index()], heap.points[t[1].index()], heap.points[t[2].index()]);
    if (turn < 0) std::swap(t[1], t[2]);
    if (turn == 0 || t[1] == t[2]) continue;
    if (sides.contains({t[0], t[1]}) || sides.contains({t[1], t[2]}) || sides.contains({t[2], t[0]}))
      continue;
    const bool overlaps = std::any_of(heap.triangles.begin(), heap.triangles.end(),
                                      [&](const Triangle& other) { return interiors_meet(heap, t, other); });
    if (overlaps && random.integer(0, refuse) != 0) continue;
    heap.triangles.push_back(t);
    sides.insert({{t[0], t[1]}, {t[1], t[2]}, {t[2], t[0]}});
  }
  std::sort(heap.triangles.begin(), heap.triangles.end());
  return heap;
}

std::set<int> codes_of(const std::vector<Violation>& violations) {
  std::set<int> codes;
  for (const Violation& v : violations) codes.insert(v.code);
  return codes;
}

std::string describe(const Heap& heap, const std::vector<Violation>& violations) {
  std::string text;
  for (const Point2 p : heap.points) text += "(" + std::to_string(p.x) + "," + std::to_string(p.y) + ") ";
  for (const Triangle& t : heap.triangles) {
    for (const VertexId v : t) text += std::to_string(v.value()) + " ";
    text += "; ";
  }
  for (const Violation& v : violations) text += std::to_string(v.code) + " " + v.what + "; ";
  return text;
}

TEST(ValidateLaws, FindsWhatAllPairsShow) {
  test::Random random;
  SCOPED_TRACE(random.trace());
  int sound = 0;
  int unsound = 0;
  for (int scene = 0; scene < 40'000; ++scene) {
    const Heap heap = random_heap(random);
    const std::vector<double> heights(heap.points.size(), 0);
    const TinArrays arrays{.points = heap.points, .heights = heights, .triangles = heap.triangles};
    const std::vector<Violation> found = validate(arrays);
    const std::set<int> expected = codes_by_definition(heap);
    // A sound TIN passes, an unsound one fails; a code that is given holds. (Which of several broken laws the
    // sweep over the rim meets first is not promised.)
    ASSERT_EQ(found.empty(), expected.empty()) << describe(heap, found);
    for (const int code : codes_of(found)) ASSERT_TRUE(expected.contains(code)) << describe(heap, found);
    ASSERT_EQ(codes_of(found).contains(violation::kSamePosition),
              expected.contains(violation::kSamePosition));
    // Twins shorten the way, not the findings.
    const Tin linked(heap.points, heights, heap.triangles, {});
    ASSERT_EQ(codes_of(validate(linked)), codes_of(found)) << describe(heap, found);
    ++(expected.empty() ? sound : unsound);
  }
  EXPECT_GT(sound, 5000);
  EXPECT_GT(unsound, 5000);
}

// A sound heap, written with some vertices moved.
TEST(ValidateLaws, FindsWhatAllPairsShowInTheWrittenCoordinates) {
  test::Random random;
  SCOPED_TRACE(random.trace());
  int sound = 0, turned = 0, overlapping = 0;
  for (int scene = 0; scene < 40'000; ++scene) {
    const Heap heap = random_heap(random);
    if (!codes_by_definition(heap).empty()) continue;
    Heap written = heap;
    for (int moves = random.integer(1, 3); moves > 0; --moves) {
      written.points[random.integer<std::size_t>(0, written.points.size() - 1)] = {
          random.integer(-1, 7) * 1.0, random.integer(-1, 7) * 1.0};
    }
    const bool turns = std::any_of(heap.triangles.begin(), heap.triangles.end(), [&](const Triangle& t) {
      return orientation(written.points[t[0].index()], written.points[t[1].index()],
                         written.points[t[2].index()]) <= 0;
    });
    const std::vector<double> heights(heap.points.size(), 0);
    const TinArrays arrays{.points = heap.points, .heights = heights, .triangles = heap.triangles};
    const std::set<int> found = codes_of(validate(arrays, written.points));
    if (turns) {
      ASSERT_EQ(found, std::set<int>{violation::kTurnedInWritten});
      ++turned;
    } else if (codes_by_definition(written).empty()) {
      ASSERT_TRUE(found.empty()) << describe(written, validate(arrays, written.points));
      ++sound;
    } else {
      ASSERT_EQ(found, std::set<int>{violation::kOverlapInWritten}) << describe(written, {});
      ++overlapping;
    }
  }
  EXPECT_GT(std::min({sound, turned, overlapping}), 500);
}

TEST(ValidateLaws, LatticesAreSoundUntilAVertexMovesTooFar) {
  test::Random random;
  SCOPED_TRACE(random.trace());
  for (int scene = 0; scene < 200; ++scene) {
    const Tin tin = test::random_lattice(9, 7, 5, random);
    ASSERT_TRUE(validate(tin, tin.points(), IsolatedVertices::Report).empty());
    std::vector<Point2> points(tin.points().begin(), tin.points().end());
    const std::size_t moved =
        9 * random.integer<std::size_t>(0, 6) + random.integer<std::size_t>(0, 7);  // not the last column
    points[moved].x += 1000;
    TinArrays arrays = tin.arrays();
    EXPECT_TRUE(codes_of(validate(arrays, points)).contains(violation::kTurnedInWritten));
    arrays.points = points;
    EXPECT_TRUE(codes_of(validate(arrays)).contains(violation::kNotCounterClockwise));
  }
}

}  // namespace
}  // namespace thalweg
