// The result depends on the surface alone: not on the order of its vertices, an exact translation, or
// threads.
#include "support/random.hpp"

#include <thalweg/delaunay/triangulate.hpp>
#include <thalweg/optimize/optimize.hpp>
#include <thalweg/order/quadrilaterals.hpp>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <set>

namespace thalweg::test {
namespace {

struct Surface {
  std::vector<Point2> points;
  std::vector<double> heights;
};

/// Half of the vertices on a lattice, so that circles tie; few heights, so that angles tie and plateaus meet.
Surface random_surface(std::size_t side, int levels, Random& random) {
  std::set<Point2> places;
  const auto width = static_cast<double>(side);
  for (std::size_t i = 0; i < side * side; ++i) {
    places.insert({static_cast<double>(i % side), static_cast<double>(i / side)});
    places.insert({random.real(width, 2 * width), random.real(0, width)});
  }
  Surface surface{{places.begin(), places.end()}, {}};
  for (std::size_t i = 0; i < places.size(); ++i) surface.heights.push_back(random.integer(0, levels));
  return surface;
}

Surface shuffled(const Surface& surface, Random& random) {
  std::vector<std::size_t> order(surface.points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::shuffle(order.begin(), order.end(), random.engine());
  Surface out;
  for (const std::size_t i : order) {
    out.points.push_back(surface.points[i]);
    out.heights.push_back(surface.heights[i]);
  }
  return out;
}

/// A triangulation is its diagonals by coordinates; with the values reported.
struct Outcome {
  std::set<std::array<Point2, 2>> diagonals;
  std::vector<double> values;
  bool operator==(const Outcome&) const = default;
};

Outcome optimise(const Surface& surface, Point2 origin, OptimizeOptions options) {
  Progress progress;
  std::vector<Point2> points;
  for (const Point2 p : surface.points) points.push_back({p.x + origin.x, p.y + origin.y});
  const Tin tin = triangulate(points, surface.heights, {}, progress);
  const std::vector<Quadrilateral> quadrilaterals = find_quadrilaterals(tin, {}, progress);
  const OptimizeResult result = optimize_first_order(tin, quadrilaterals, options, progress);
  Outcome outcome;
  for (std::size_t q = 0; q < quadrilaterals.size(); ++q) {
    if (result.flipped[q] == 0) continue;
    std::array<Point2, 2> ends = {tin.point(quadrilaterals[q].s), tin.point(quadrilaterals[q].t)};
    for (Point2& p : ends) p = {p.x - origin.x, p.y - origin.y};
    std::sort(ends.begin(), ends.end());
    outcome.diagonals.insert(ends);
  }
  for (const CriterionResult& line : result.criteria) {
    outcome.values.insert(outcome.values.end(), {line.delaunay, line.result, line.bound});
  }
  return outcome;
}

void expect_invariant(const Surface& surface, const OptimizeOptions& options, Random& random) {
  const Outcome outcome = optimise(surface, {}, options);
  EXPECT_FALSE(outcome.diagonals.empty());
  EXPECT_TRUE(outcome == optimise(shuffled(surface, random), {}, options)) << "order of vertices";
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_TRUE(outcome == optimise(surface, {}, options)) << "threads";
}

TEST(Invariance, OrderAndThreads) {
  Random random;
  SCOPED_TRACE(random.trace());
  for (const int levels : {2, 5, 1000}) {
    const Surface surface = random_surface(25, levels, random);
    expect_invariant(surface, {}, random);
    expect_invariant(surface, {.criteria = {Criterion::LocalMinima}}, random);
    expect_invariant(surface, {.criteria = {Criterion::NormalAngleSum, Criterion::LocalMinima}}, random);
    expect_invariant(surface, {.criteria = {Criterion::PitDepth}}, random);
    expect_invariant(surface, {.criteria = {Criterion::NormalAngleSum, Criterion::PitDepth}}, random);
    expect_invariant(surface, {.width_limit = 1, .effort = 1'000'000}, random);
  }
}

TEST(Invariance, ExactTranslation) {
  Random random;
  SCOPED_TRACE(random.trace());
  Surface surface = random_surface(25, 4, random);
  for (Point2& p : surface.points) p = {std::floor(p.x * 1024) / 1024, std::floor(p.y * 1024) / 1024};
  const Outcome outcome = optimise(surface, {}, {});
  EXPECT_TRUE(outcome == optimise(surface, {500000, 4000000}, {}));
}

}  // namespace
}  // namespace thalweg::test
