#include "support/meshes.hpp"

#include <thalweg/base/error.hpp>
#include <thalweg/optimize/optimize.hpp>

#include <gtest/gtest.h>

#include <limits>

namespace thalweg::test {
namespace {

/// A square s, u, t, v around which all is high; uv is the diagonal. Ring vertices 4 to 7 enclose it.
struct Basin {
  Tin tin;
  std::vector<Quadrilateral> quadrilaterals;
};

Basin basin(double s, double u, double t, double v, double ring) {
  Tin tin = make_tin(
      {{1, 1}, {2, 1}, {2, 2}, {1, 2}, {0, 0}, {3, 0}, {3, 3}, {0, 3}},
      {triangle(0, 1, 3), triangle(1, 2, 3), triangle(4, 1, 0), triangle(4, 5, 1), triangle(5, 2, 1),
       triangle(5, 6, 2), triangle(6, 3, 2), triangle(6, 7, 3), triangle(7, 0, 3), triangle(7, 4, 0)},
      {}, {s, u, t, v, ring, ring, ring, ring});
  const HalfedgeId diagonal = tin.find_halfedge(VertexId{std::size_t{1}}, VertexId{std::size_t{3}});
  Quadrilateral quadrilateral{tin.apex(diagonal), tin.origin(diagonal), tin.apex(tin.twin(diagonal)),
                              tin.target(diagonal), diagonal};
  return {std::move(tin), {quadrilateral}};
}

OptimizeResult run(const Basin& basin, const OptimizeOptions& options) {
  Progress progress;
  return optimize_first_order(basin.tin, basin.quadrilaterals, options, progress);
}

const OptimizeOptions kPits = {.criteria = {Criterion::LocalMinima}};

TEST(Optimize, DrainsAPitThroughTheOtherDiagonal) {
  const OptimizeResult result = run(basin(1, 5, 2, 5, 9), kPits);
  EXPECT_EQ(result.flipped, std::vector<std::uint8_t>{1});
  ASSERT_EQ(result.criteria.size(), 1U);
  const CriterionResult& line = result.criteria[0];
  EXPECT_EQ(line.name, "local-minima");
  EXPECT_EQ(line.unit, "count");
  EXPECT_EQ(line.direction, "min");
  EXPECT_EQ(line.delaunay, 2);
  EXPECT_EQ(line.result, 1);
  EXPECT_EQ(line.bound, 1);
  EXPECT_TRUE(line.optimal);
}

TEST(Optimize, LowersASpill) {
  // Apart, the pit at 2 spills at 5 into that at 1, which spills over the ring at 9.
  const OptimizeResult result =
      run(basin(1, 5, 2, 5, 9), {.criteria = {Criterion::PitDepth}, .vertical_metres_per_unit = 0.5});
  EXPECT_EQ(result.flipped, std::vector<std::uint8_t>{1});
  EXPECT_EQ(result.criteria[0].unit, "metres");
  EXPECT_EQ(result.criteria[0].delaunay, 0.5 * (3 + 8));
  EXPECT_EQ(result.criteria[0].result, 0.5 * 8);
  EXPECT_EQ(result.criteria[0].bound, 0.5 * 8);
  EXPECT_TRUE(result.criteria[0].optimal);
}

TEST(Optimize, UnitesLevelPits) {
  EXPECT_EQ(run(basin(1, 5, 1, 5, 9), kPits).criteria[0].result, 1);
}

TEST(Optimize, LeavesWhatHelpsNobody) {
  EXPECT_EQ(run(basin(1, 1, 5, 5, 9), kPits).flipped[0], 0);  // two adjacent lowest corners
  EXPECT_EQ(run(basin(1, 1, 1, 5, 9), kPits).flipped[0], 0);  // one plateau already
  EXPECT_EQ(run(basin(1, 5, 2, 5, 0), kPits).flipped[0], 0);  // drained by the ring
  EXPECT_EQ(run(basin(5, 1, 5, 2, 9), kPits).flipped[0], 0);  // the diagonal that is there drains
}

TEST(Optimize, KeepsALake) {
  Basin lake = basin(1, 5, 2, 5, 9);
  // u is not of t's height, so edge ut is no lake's shore; s and t keep their pits only where no lake takes
  // them.
  EXPECT_EQ(run(lake, kPits).criteria[0].delaunay, 2);
  const std::vector<ConstraintEdge> shore = {edge(0, 1, EdgeKind::Lake)};
  const Tin level({lake.tin.points().begin(), lake.tin.points().end()}, {1, 1, 5, 5, 9, 9, 9, 9},
                  {lake.tin.triangles().begin(), lake.tin.triangles().end()}, shore);
  Progress progress;
  EXPECT_EQ(optimize_first_order(level, lake.quadrilaterals, kPits, progress).criteria[0].delaunay, 0);
}

TEST(Optimize, PitsGoBeforeAngles) {
  const Basin sharp = basin(1, 1.1, 1.05, 8, 9);  // the new diagonal is sharper, but drains t
  const OptimizeResult smooth = run(sharp, {.criteria = {Criterion::NormalAngleSum}});
  const OptimizeResult both = run(sharp, {});
  EXPECT_LE(smooth.criteria[0].result, both.criteria[1].result);
  EXPECT_EQ(both.criteria[0].result, 1);
  EXPECT_EQ(both.fixed_by_elimination, 1U);
  EXPECT_EQ(both.pieces, 0U);
}

TEST(Optimize, NothingToDo) {
  const OptimizeResult none = run(basin(1, 5, 2, 5, 9), {.criteria = {}});
  EXPECT_EQ(none.flipped, std::vector<std::uint8_t>{0});
  EXPECT_TRUE(none.criteria.empty());
  Basin bare = basin(1, 5, 2, 5, 9);
  bare.quadrilaterals.clear();
  const OptimizeResult fixed = run(bare, {});
  EXPECT_TRUE(fixed.flipped.empty());
  EXPECT_TRUE(fixed.criteria[0].optimal && fixed.criteria[1].optimal);
  EXPECT_EQ(fixed.criteria[1].delaunay, fixed.criteria[1].result);
  EXPECT_EQ(run({Tin(), {}}, {}).criteria[1].result, 0);
}

ErrorCode code_of(const Basin& basin, const OptimizeOptions& options) {
  try {
    run(basin, options);
  } catch (const Error& error) {
    return error.code();
  }
  return ErrorCode::Internal;
}

TEST(Optimize, RefusesWhatMakesNoSense) {
  const Basin good = basin(1, 5, 2, 5, 9);
  EXPECT_EQ(code_of(good, {.criteria = {Criterion::LocalMinima, Criterion::LocalMinima}}), ErrorCode::Usage);
  EXPECT_EQ(code_of(good, {.horizontal_metres_per_unit = 0}), ErrorCode::Usage);
  EXPECT_EQ(code_of(good, {.vertical_metres_per_unit = std::numeric_limits<double>::quiet_NaN()}),
            ErrorCode::Usage);
  EXPECT_EQ(code_of(good, {.width_limit = 0}), ErrorCode::Usage);
  EXPECT_EQ(code_of(good, {.width_limit = 25}), ErrorCode::Usage);
  Basin overlapping = good;
  overlapping.quadrilaterals.push_back(overlapping.quadrilaterals[0]);
  EXPECT_EQ(code_of(overlapping, {}), ErrorCode::Unsupported);
}

TEST(Optimize, StopsOnRequest) {
  Progress progress;
  progress.cancel();
  const Basin good = basin(1, 5, 2, 5, 9);
  EXPECT_THROW(optimize_first_order(good.tin, good.quadrilaterals, {}, progress), Error);
}

TEST(Criteria, AreFoundByName) {
  for (const CriterionTraits& traits : all_criteria()) {
    EXPECT_EQ(find_criterion(traits.name), traits.criterion);
    EXPECT_EQ(&traits_of(traits.criterion), &traits);
  }
  EXPECT_FALSE(find_criterion("beauty").has_value());
}

TEST(Optimize, RefusesAnObjectiveWithoutParts) {
  EXPECT_THROW(Objective(std::vector<Objective::Part>()), Error);
}

}  // namespace
}  // namespace thalweg::test
