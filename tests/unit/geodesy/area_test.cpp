// Areas on the ellipsoid against known ones.
#include <thalweg/base/error.hpp>
#include <thalweg/geodesy/area.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace thalweg {
namespace {

std::vector<VertexId> loop_of(std::initializer_list<std::size_t> ids) {
  std::vector<VertexId> loop;
  for (const std::size_t id : ids) loop.push_back(VertexId{id});
  return loop;
}

constexpr Ellipsoid kSphere{.equatorial_radius_m = 6371000, .flattening = 0};

TEST(GeodesicArea, AnOctantOfTheSphere) {
  const std::vector<Point2> lonlat{{0, 0}, {90, 0}, {30, 90}};
  const std::vector<std::vector<VertexId>> loops{loop_of({0, 1, 2})};
  const double octant = std::numbers::pi / 2 * 6371000.0 * 6371000.0;
  EXPECT_NEAR(geodesic_area_m2(lonlat, loops, kSphere), octant, 1e-9 * octant);
}

TEST(GeodesicArea, AnEighthOfWgs84) {
  const std::vector<Point2> lonlat{{0, 0}, {90, 0}, {0, 90}};
  const std::vector<std::vector<VertexId>> loops{loop_of({0, 1, 2})};
  EXPECT_NEAR(geodesic_area_m2(lonlat, loops), 510065621724088.4 / 8, 1);
}

TEST(GeodesicArea, AClockwiseHoleIsTakenAway) {
  std::vector<Point2> lonlat;
  for (const double half : {1.0, 0.5}) {
    for (const auto& [x, y] : {Point2{-half, -half}, {half, -half}, {half, half}, {-half, half}}) {
      lonlat.push_back({180 + x > 180 ? x - 180 : 180 + x, 45 + y});
    }
  }
  const std::vector<std::vector<VertexId>> outer{loop_of({0, 1, 2, 3})};
  const std::vector<std::vector<VertexId>> inner{loop_of({4, 5, 6, 7})};
  const std::vector<std::vector<VertexId>> both{loop_of({0, 1, 2, 3}), loop_of({4, 7, 6, 5})};
  const double whole = geodesic_area_m2(lonlat, outer);
  const double hole = geodesic_area_m2(lonlat, inner);
  EXPECT_NEAR(whole, 4 * 111.13e3 * 78.85e3, 1e-3 * whole);
  EXPECT_NEAR(geodesic_area_m2(lonlat, both), whole - hole, 1e-3);
}

TEST(GeodesicArea, NothingEnclosesNothing) {
  EXPECT_EQ(geodesic_area_m2({}, {}), 0);
}

TEST(GeodesicArea, BadPositionsAreRefused) {
  const std::vector<Point2> lonlat{{0, 0}, {1, 95}, {0, 1}};
  const std::vector<std::vector<VertexId>> loops{loop_of({0, 1, 2})};
  EXPECT_THROW(geodesic_area_m2(lonlat, loops), Error);
}

}  // namespace
}  // namespace thalweg
