// Lengths and areas on the ellipsoid against known ones.
#include <thalweg/base/error.hpp>
#include <thalweg/geodesy/geodesic.hpp>
#include <thalweg/geodesy/metric_frame.hpp>
#include <thalweg/geodesy/position_text.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace thalweg {
namespace {

std::vector<VertexId> loop_of(std::initializer_list<std::size_t> ids) {
  std::vector<VertexId> loop;
  for (const std::size_t id : ids) loop.push_back(VertexId{id});
  return loop;
}

constexpr Ellipsoid kSphere{.equatorial_radius_m = 6371000, .flattening = 0};

TEST(Zones, OfPlaces) {
  EXPECT_EQ(utm_or_ups_epsg({9, 47}), 32632);
  EXPECT_EQ(utm_or_ups_epsg({-70.7, -33.5}), 32719);
  EXPECT_EQ(utm_or_ups_epsg({5, 60}), 32632);  // of Norway
  EXPECT_EQ(utm_or_ups_epsg({0, 88}), 5041);
  EXPECT_EQ(utm_or_ups_epsg({0, -88}), 5042);
  EXPECT_THROW(utm_or_ups_epsg({0, 91}), Error);
}

TEST(Frame, OfNoEllipsoid) {
  const std::vector<Point2> place{{10, 46}};
  for (const Ellipsoid& none : {Ellipsoid{6e6, 1}, Ellipsoid{0, 0}, Ellipsoid{6e6, std::nan("")}}) {
    EXPECT_THROW(MetricFrame::for_extent(place, none), Error);
    EXPECT_THROW(MetricFrame::from_proj_string("+proj=tmerc +lon_0=9", none), Error);
  }
}

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

using Edges = std::vector<std::pair<VertexId, VertexId>>;

TEST(GeodesicLength, KnownLines) {
  // A degree of the equator is pi a / 180; the quarter meridian of WGS 84 is 10 001 965.729 m.
  const std::vector<Point2> lonlat{{179.5, 0}, {-179.5, 0}, {17, 90}};
  const Edges edges{{VertexId{0}, VertexId{1}}, {VertexId{1}, VertexId{0}}, {VertexId{1}, VertexId{2}}};
  const std::vector<double> lengths = geodesic_lengths_m(lonlat, edges);
  EXPECT_NEAR(lengths[0], std::numbers::pi * 6378137 / 180, 1e-8);
  EXPECT_EQ(lengths[0], lengths[1]);
  EXPECT_NEAR(lengths[2], 10001965.729, 1e-3);
}

TEST(GeodesicLength, FlindersPeakToBuninyong) {
  // The example of the Geocentric Datum of Australia Technical Manual, chapter 4: 54 972.271 m on GRS 80.
  const auto degrees = [](double d, double m, double s) { return d + m / 60 + s / 3600; };
  const std::vector<Point2> lonlat{{degrees(144, 25, 29.52440), -degrees(37, 57, 3.72030)},
                                   {degrees(143, 55, 35.38390), -degrees(37, 39, 10.15610)}};
  const Edges edges{{VertexId{0}, VertexId{1}}};
  EXPECT_NEAR(geodesic_lengths_m(lonlat, edges, {.flattening = 1 / 298.257222101})[0], 54972.271, 5e-4);
}

TEST(GeodesicLength, BadPositionsAreRefused) {
  const std::vector<Point2> lonlat{{0, 0}, {1, 95}};
  const Edges edges{{VertexId{0}, VertexId{1}}};
  EXPECT_THROW(geodesic_lengths_m(lonlat, edges), Error);
}

}  // namespace
}  // namespace thalweg
