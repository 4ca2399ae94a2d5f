#pragma once

/// Small scenes of the oracle with heights, all their triangulations of an order, and the faces of it.

#include "support/plain_criteria.hpp"

#include <thalweg/optimize/optimize_faces.hpp>

#include <gtest/gtest.h>
#include <support/oracle/law_testing.hpp>
#include <support/oracle/triangulations.hpp>
#include <support/scene_tin.hpp>

#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace thalweg::test {

inline constexpr oracle::SceneOptions kSmallFaces{.fewest = 5, .most = 10, .constraints = 5};
inline constexpr double kHorizontal = 2, kVertical = 0.5;
inline constexpr Steps kTolerance =
    64;  // steps: of a sum of some dozens of terms that plain code rounds otherwise

/// Constraint edges become valleys.
inline Tin with_heights(const Tin& ground, std::vector<Triangle> triangles,
                        const std::vector<double>& heights) {
  std::vector<ConstraintEdge> valleys = ground.constraint_edges();
  for (ConstraintEdge& edge : valleys) edge.kind = edge.kind | EdgeKind::Valley;
  return {{ground.points().begin(), ground.points().end()}, heights, std::move(triangles), valleys};
}

inline std::vector<Steps> value_of(const Tin& tin, const std::vector<Criterion>& criteria) {
  const PlainCriteria plain(tin, kHorizontal, kVertical);
  std::vector<Steps> value;
  for (const Criterion criterion : criteria)
    value.push_back(plain.value(std::string(traits_of(criterion).name)));
  return value;
}

/// Less at the first level at which they differ by more than rounding.
inline bool better(const std::vector<Steps>& a, const std::vector<Steps>& b) {
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (std::abs(a[i] - b[i]) > kTolerance) return a[i] < b[i];
  }
  return false;
}

struct Terrain {
  Tin tin;                          ///< the Delaunay triangulation, with heights
  std::vector<Tin> triangulations;  ///< all of the order
  std::vector<Steps> order_sums;    ///< of each
  FixedFaces faces;
};

inline std::optional<Terrain> terrain_of(const oracle::Oracle& oracle, const oracle::Enumeration& all,
                                         OrderDefinition definition, int k,
                                         const std::vector<double>& heights) {
  const Tin ground = ground_of(oracle.scene());
  Progress progress;
  const ConstrainedOrder order(ground, mode_of(oracle.scene()));
  auto faces = find_fixed_faces(
      ground,
      find_order_triangles(order, {.definition = definition, .max_order = static_cast<std::size_t>(k)},
                           progress),
      {}, progress);
  if (!faces) return std::nullopt;
  Terrain terrain{with_heights(ground, {ground.triangles().begin(), ground.triangles().end()}, heights),
                  {},
                  {},
                  std::move(*faces)};
  for (const std::size_t i : all.of_order(static_cast<oracle::Definition>(definition), k)) {
    std::vector<Triangle> triangles;
    Steps order_sum = 0;
    for (const int t : all.members[i]) {
      triangles.push_back(triangle(all.triangles[static_cast<std::size_t>(t)]));
      order_sum += all.orders[static_cast<std::size_t>(t)][static_cast<std::size_t>(definition)];
    }
    terrain.order_sums.push_back(order_sum);
    terrain.triangulations.push_back(with_heights(ground, std::move(triangles), heights));
  }
  return terrain;
}

inline Tin tin_of(const Terrain& terrain, const FaceOptimizeResult& result) {
  std::vector<Triangle> triangles;
  for (const OrderTriangle& t : result.triangles) triangles.push_back(t.corners);
  return with_heights(terrain.tin, std::move(triangles),
                      {terrain.tin.heights().begin(), terrain.tin.heights().end()});
}

inline void expect_line(const CriterionResult& line, Steps delaunay, Steps result) {
  const double sign = line.direction == "max" ? -1 : 1;
  constexpr double kNear = static_cast<double>(kTolerance) / 0x1p32;
  EXPECT_NEAR(line.delaunay, sign * static_cast<double>(delaunay) / 0x1p32, kNear) << line.name;
  EXPECT_NEAR(line.result, sign * static_cast<double>(result) / 0x1p32, kNear) << line.name;
  EXPECT_EQ(line.bound, line.result) << line.name;
  EXPECT_TRUE(line.optimal) << line.name;
}

}  // namespace thalweg::test
