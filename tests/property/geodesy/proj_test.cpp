// Laws 1 and 2 of MetricFrame, and that its maps are conformal, on random positions of many extents. The
// plane is computed a second time by PROJ, through the command gdaltransform.
#include "support/random.hpp"

#include <thalweg/geodesy/metric_frame.hpp>

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <string>
#include <vector>

namespace thalweg {
namespace {

struct Region {
  const char* name;
  Point2 west_south;
  Point2 size;
  Projection projection;
  Ellipsoid ellipsoid = {};
};

constexpr Ellipsoid kClarke1866{.equatorial_radius_m = 6378206.4, .flattening = 1 / 294.978698213898};
constexpr Ellipsoid kSphere{.equatorial_radius_m = 6371000, .flattening = 0};
constexpr Region kRegions[] = {
    {"county", {-84.4, 36.4}, {0.4, 0.3}, Projection::TransverseMercator},
    {"county on Clarke 1866", {-84.4, 36.4}, {0.4, 0.3}, Projection::TransverseMercator, kClarke1866},
    {"chile", {-76, -56}, {10, 38}, Projection::TransverseMercator},
    {"fiji, across the antimeridian", {176.5, -20}, {5.5, 5}, Projection::TransverseMercator},
    {"svalbard", {8, 76}, {26, 6}, Projection::TransverseMercator},
    {"gabon", {8, -4}, {7, 7}, Projection::TransverseMercator},
    {"conterminous states", {-125, 24}, {58, 26}, Projection::LambertConformalConic},
    {"australia, 0 to 360", {112, -44}, {42, 34}, Projection::LambertConformalConic},
    {"northern pacific, 0 to 360", {150, 30}, {80, 25}, Projection::LambertConformalConic},
    {"low parallel", {60, -2}, {50, 12.2}, Projection::LambertConformalConic},
    {"tropics", {-180, -25}, {359, 50}, Projection::Mercator, kSphere},
    {"equator", {20, -8}, {60, 14}, Projection::Mercator},
    {"arctic", {-180, 62}, {359, 28}, Projection::PolarStereographic},
    {"antarctica", {-180, -90}, {359, 28}, Projection::PolarStereographic},
};

std::vector<Point2> random_positions(const Region& region, std::size_t count, test::Random& random) {
  std::vector<Point2> lonlat{region.west_south,
                             {region.west_south.x + region.size.x, region.west_south.y + region.size.y}};
  while (lonlat.size() < count) {
    lonlat.push_back({region.west_south.x + random.real(0, region.size.x),
                      region.west_south.y + random.real(0, region.size.y)});
  }
  return lonlat;
}

std::vector<Point2> transform_with_proj(const MetricFrame& frame, const std::vector<Point2>& lonlat) {
  const auto file =
      std::filesystem::temp_directory_path() / ("thalweg_proj_test_" + std::to_string(getpid()));
  std::ofstream input(file);
  input << std::setprecision(17);
  for (const Point2 p : lonlat) input << p.x << ' ' << p.y << '\n';
  input.close();
  const std::string plane = frame.proj_string();
  const std::string source =
      "+proj=longlat " + plane.substr(plane.find(plane.find("+R=") < plane.size() ? "+R=" : "+a="));
  const std::string command = "gdaltransform -output_xy -s_srs '" + source.substr(0, source.find("+units")) +
                              " +no_defs' -t_srs '" + plane + "' < " + file.string();
  std::vector<Point2> result;
  if (FILE* pipe = popen(command.c_str(), "r")) {
    Point2 p;
    while (fscanf(pipe, "%lf %lf", &p.x, &p.y) == 2) result.push_back(p);
    pclose(pipe);
  }
  std::filesystem::remove(file);
  return result;
}

std::string name_of(const Region& region) {
  return std::string(region.name) + ": ";
}

TEST(MetricFrameLaws, ProjReproducesThePlaneToAMicrometre) {
  ASSERT_EQ(std::system("gdaltransform --version > /dev/null 2>&1"), 0)
      << "gdaltransform is not installed: tools/dev/packages check does it";
  test::Random random;
  SCOPED_TRACE(random.trace());
  for (const Region& region : kRegions) {
    const std::vector<Point2> lonlat = random_positions(region, 400, random);
    const MetricFrame frame = MetricFrame::for_extent(lonlat, region.ellipsoid);
    EXPECT_EQ(frame.projection(), region.projection) << region.name;
    const std::vector<Point2> theirs = transform_with_proj(frame, lonlat);
    ASSERT_EQ(theirs.size(), lonlat.size()) << region.name;
    double largest = 0;
    for (std::size_t i = 0; i < lonlat.size(); ++i) {
      const Point2 ours = frame.to_plane(lonlat[i]);
      largest = std::max({largest, std::abs(ours.x - theirs[i].x), std::abs(ours.y - theirs[i].y)});
    }
    EXPECT_LE(largest, 1e-6) << name_of(region) << frame.proj_string();
    RecordProperty(region.name, std::to_string(largest * 1e9) + " nm");
  }
}

TEST(MetricFrameLaws, GeographicInvertsPlane) {
  test::Random random;
  SCOPED_TRACE(random.trace());
  for (const Region& region : kRegions) {
    const std::vector<Point2> lonlat = random_positions(region, 2000, random);
    const MetricFrame frame = MetricFrame::for_extent(lonlat, region.ellipsoid);
    for (const Point2 p : lonlat) {
      const Point2 back = frame.to_geographic(frame.to_plane(p));
      const double east = std::remainder(back.x - p.x, 360) * std::cos(p.y * 0.017453292519943295);
      EXPECT_LE(std::hypot(east, back.y - p.y) * 111e3, 1e-6) << name_of(region) << p.x << ' ' << p.y;
      const Point2 continuous = frame.continuous(p);
      EXPECT_LE(std::abs(continuous.x - frame.centre_deg().x), 180);
      EXPECT_EQ(std::remainder(continuous.x - p.x, 360), 0);
    }
  }
}

// The Jacobian by differences: its columns, per metre on the ground, are perpendicular and equally long.
TEST(MetricFrameLaws, TheMapIsConformal) {
  test::Random random;
  SCOPED_TRACE(random.trace());
  constexpr double kRadian = 0.017453292519943295;
  constexpr double kStep = 1e-4;
  for (const Region& region : kRegions) {
    const MetricFrame frame = MetricFrame::for_extent(random_positions(region, 2, random), region.ellipsoid);
    for (const Point2 p : random_positions(region, 200, random)) {
      if (std::abs(p.y) > 89) continue;
      const Point2 west = frame.to_plane({p.x - kStep, p.y}), east = frame.to_plane({p.x + kStep, p.y});
      const Point2 south = frame.to_plane({p.x, p.y - kStep}), north = frame.to_plane({p.x, p.y + kStep});
      const double f = region.ellipsoid.flattening, e2 = f * (2 - f);
      const double w2 = 1 - e2 * std::pow(std::sin(p.y * kRadian), 2);
      const double meridian_over_parallel = (1 - e2) / w2 / std::cos(p.y * kRadian);
      const Point2 along_parallel = {(east.x - west.x) * meridian_over_parallel,
                                     (east.y - west.y) * meridian_over_parallel};
      const Point2 along_meridian = {north.x - south.x, north.y - south.y};
      const double length = std::hypot(along_meridian.x, along_meridian.y);
      EXPECT_NEAR(along_parallel.x, along_meridian.y, 1e-6 * length) << region.name;
      EXPECT_NEAR(along_parallel.y, -along_meridian.x, 1e-6 * length) << region.name;
    }
  }
}

TEST(MetricFrameLaws, TheOrderOfPositionsDoesNotMatter) {
  test::Random random;
  SCOPED_TRACE(random.trace());
  for (const Region& region : kRegions) {
    std::vector<Point2> lonlat = random_positions(region, 100, random);
    const std::string plane = MetricFrame::for_extent(lonlat, region.ellipsoid).proj_string();
    std::shuffle(lonlat.begin(), lonlat.end(), random.engine());
    EXPECT_EQ(MetricFrame::for_extent(lonlat, region.ellipsoid).proj_string(), plane);
  }
}

}  // namespace
}  // namespace thalweg
