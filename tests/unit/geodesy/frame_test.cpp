// Which projection a frame chooses, what it rejects, and its laws on small cases.
#include <thalweg/base/error.hpp>
#include <thalweg/geodesy/metric_frame.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace thalweg {
namespace {

using testing::HasSubstr;

MetricFrame frame_of(std::vector<Point2> lonlat) {
  return MetricFrame::for_extent(lonlat);
}

Error error_of(const std::vector<Point2>& lonlat) {
  try {
    (void)MetricFrame::for_extent(lonlat);
  } catch (const Error& error) {
    return error;
  }
  return {ErrorCode::Internal, "nothing was thrown"};
}

TEST(MetricFrame, NarrowDataIsTransverseMercatorAboutItsCentre) {
  const MetricFrame frame = frame_of({{-84.41375, 36.44625}, {-84.077917, 36.732917}});
  EXPECT_EQ(frame.projection(), Projection::TransverseMercator);
  EXPECT_EQ(
      frame.proj_string(),
      "+proj=tmerc +lat_0=36.59 +lon_0=-84.25 +k_0=1 +x_0=0 +y_0=0 +a=6378137 +rf=298.257223563 +units=m "
      "+no_defs +type=crs");
  const Point2 origin = frame.to_plane(frame.centre_deg());
  EXPECT_NEAR(origin.x, 0, 1e-9);
  EXPECT_NEAR(origin.y, 0, 1e-9);
}

TEST(MetricFrame, AStripFromSouthToNorthIsTransverseMercator) {
  EXPECT_EQ(frame_of({{10, -85}, {14, 85}}).projection(), Projection::TransverseMercator);
}

TEST(MetricFrame, TheTransverseLimitAtTheEquatorIsEightDegreesToEachSide) {
  EXPECT_EQ(frame_of({{-8, -10}, {8, 10}}).projection(), Projection::TransverseMercator);
  EXPECT_EQ(frame_of({{-8.2, -1}, {8.2, 1}}).projection(), Projection::Mercator);
}

TEST(MetricFrame, WideDataIsConicOrMercator) {
  EXPECT_EQ(frame_of({{-125, 25}, {-66, 49}}).projection(), Projection::LambertConformalConic);
  EXPECT_EQ(frame_of({{110, -44}, {154, -10}}).projection(), Projection::LambertConformalConic);
  EXPECT_EQ(frame_of({{-180, -60}, {0, 0}, {180, 60}}).projection(), Projection::Mercator);
}

TEST(MetricFrame, PolarDataIsStereographic) {
  EXPECT_EQ(frame_of({{-170, 71}, {-50, 88}, {70, 75}}).projection(), Projection::PolarStereographic);
  const MetricFrame south = frame_of({{-120, -65}, {0, -90}, {100, -70}, {170, -62}});
  EXPECT_EQ(south.projection(), Projection::PolarStereographic);
  EXPECT_EQ(south.centre_deg().y, -90);
  EXPECT_THAT(south.proj_string(), HasSubstr("+proj=stere +lat_0=-90 "));
}

TEST(MetricFrame, AllConventionsOfLongitudeGiveOnePlane) {
  const MetricFrame signed_frame = frame_of({{-115, 20}, {-105.25, 30}});
  const MetricFrame unsigned_frame = frame_of({{245, 20}, {254.75, 30}});
  EXPECT_EQ(signed_frame.proj_string(), unsigned_frame.proj_string());
  const Point2 a = signed_frame.to_plane({-110.5, 22.25});
  const Point2 b = unsigned_frame.to_plane({249.5, 22.25});
  EXPECT_EQ(a, b);
  EXPECT_NEAR(signed_frame.to_geographic(a).x, -110.5, 1e-12);
  EXPECT_NEAR(unsigned_frame.to_geographic(a).x, 249.5, 1e-12);
}

TEST(MetricFrame, TheAntimeridianIsNoBorder) {
  const MetricFrame frame = frame_of({{179.5, -17}, {-179.5, -16}, {180, -16.5}, {-180, -16.5}});
  EXPECT_EQ(frame.projection(), Projection::TransverseMercator);
  EXPECT_EQ(std::abs(frame.centre_deg().x), 180);
  EXPECT_EQ(frame.to_plane({180, -16.5}), frame.to_plane({-180, -16.5}));
  EXPECT_NEAR(frame.to_plane({-179.5, -16.5}).x - frame.to_plane({179.5, -16.5}).x, 106.7e3, 0.1e3);
  const Point2 east = frame.continuous({-179.5, -16.5});
  const Point2 west = frame.continuous({179.5, -16.5});
  EXPECT_DOUBLE_EQ(east.x - west.x, 1);
}

TEST(MetricFrame, TheSmallestArcMayBeWiderThanAHalfCircle) {
  // Gaps: 100 degrees between 80 and 180, less elsewhere.
  const MetricFrame frame = frame_of({{-180, 40}, {-90, 41}, {0, 40}, {80, 41}});
  EXPECT_DOUBLE_EQ(frame.centre_deg().x, -50);
  EXPECT_EQ(frame.continuous({179, 40}).x, 179 - 360);
  EXPECT_EQ(frame.continuous({80, 40}).x, 80);
}

TEST(MetricFrame, OnePositionHasAFrame) {
  const MetricFrame frame = frame_of({{12.345, 90}});
  EXPECT_NEAR(frame.to_geographic(frame.to_plane({12.345, 89.5})).x, 12.345, 1e-9);
}

TEST(MetricFrame, BadPositionsAreNamedWithTheRemedy) {
  EXPECT_EQ(error_of({}).code(), ErrorCode::EmptyInput);
  const Error swapped = error_of({{10, 50}, {47.5, 122.3}});
  EXPECT_EQ(swapped.code(), ErrorCode::BadCoordinate);
  EXPECT_THAT(swapped.what(), HasSubstr("position 1: longitude 47.5, latitude 122.3"));
  EXPECT_THAT(swapped.what(), HasSubstr("swapped"));
  const Error projected = error_of({{635589.01, 848886.45}});
  EXPECT_EQ(projected.code(), ErrorCode::BadCoordinate);
  EXPECT_THAT(projected.what(), HasSubstr("--a-crs"));
  EXPECT_THAT(error_of({{NAN, 0}}).what(), HasSubstr("not finite"));
  EXPECT_EQ(error_of({{0, -INFINITY}}).code(), ErrorCode::BadCoordinate);
  EXPECT_EQ(error_of({{0, 90.5}}).code(), ErrorCode::BadCoordinate);
  EXPECT_EQ(error_of({{360.5, 0}}).code(), ErrorCode::BadCoordinate);
}

TEST(MetricFrame, BothPolesOfAWideExtentAreRefused) {
  const Error error = error_of({{-150, -90}, {0, 0}, {150, 90}});
  EXPECT_EQ(error.code(), ErrorCode::BadCoordinate);
  EXPECT_THAT(error.what(), HasSubstr("--t-crs"));
}

TEST(MetricFrame, ManyPositionsAreProjectedAsOne) {
  std::vector<Point2> lonlat;
  for (int i = 0; i < 10000; ++i) lonlat.push_back({7 + i * 1e-5, 46 + (i % 97) * 1e-3});
  const MetricFrame frame = MetricFrame::for_extent(lonlat);
  const std::vector<Point2> plane = frame.to_plane(lonlat, Progress());
  ASSERT_EQ(plane.size(), lonlat.size());
  for (std::size_t i = 0; i < lonlat.size(); ++i) EXPECT_EQ(plane[i], frame.to_plane(lonlat[i]));
  lonlat[9000].y = 91;
  EXPECT_THROW((void)frame.to_plane(lonlat, Progress()), Error);
}

}  // namespace
}  // namespace thalweg
