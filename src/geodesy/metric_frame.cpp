// A conformal plane about the data.
//
// 1. Longitudes are brought to -180..180 and to 0..360. If they span less than 180 degrees in one of the
//    two, that is the smallest arc that holds them; else they are sorted, and the arc is what the largest
//    gap leaves.
// 2. The scale of each candidate projection is sampled on a grid over the extent's half (scale is even in
//    the longitude's distance from the centre, and monotonous towards the edges), and the header's rules
//    pick one.
// 3. GeographicLib projects: transverse Mercator by Krueger's series (5 nm within 3900 km of the central
//    meridian, beyond what the rules allow it), the conic and Mercator by one class, polar stereographic in
//    closed form.
#include "base/parallel.hpp"
#include "position.hpp"

#include <thalweg/base/error.hpp>
#include <thalweg/geodesy/metric_frame.hpp>

#include <GeographicLib/LambertConformalConic.hpp>
#include <GeographicLib/PolarStereographic.hpp>
#include <GeographicLib/TransverseMercator.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <tuple>
#include <variant>

namespace thalweg {

void check_position(Point2 p, std::size_t index) {
  constexpr double kLargestLongitude = 360;
  constexpr double kLargestLatitude = 90;
  if (std::abs(p.x) <= kLargestLongitude && std::abs(p.y) <= kLargestLatitude) return;
  const auto where = fmt::format("position {}: longitude {}, latitude {}", index, p.x, p.y);
  if (!std::isfinite(p.x) || !std::isfinite(p.y)) {
    throw Error(ErrorCode::BadCoordinate, where + " is not finite; remove or correct it");
  }
  const bool swapped = std::abs(p.y) <= kLargestLongitude && std::abs(p.x) <= kLargestLatitude;
  throw Error(ErrorCode::BadCoordinate,
              where + " is out of range (longitude within 360, latitude within 90 degrees); " +
                  (swapped ? "if x and y are swapped, exchange the two columns or fix the source's axis order"
                           : "if these are projected coordinates, name their CRS with --a-crs"));
}

namespace {

using GeographicLib::LambertConformalConic;
using GeographicLib::PolarStereographic;
using GeographicLib::TransverseMercator;

struct Extent {
  Point2 centre;
  double half_width = 0;
  double lat_min = 90;
  double lat_max = -90;
  bool beyond_180 = false;
};

double wrap_180(double lon) {
  return std::remainder(lon, 360.0);
}

double wrap_360(double lon) {
  const double wrapped = wrap_180(lon);
  return wrapped < 0 ? wrapped + 360 : wrapped;
}

double round_to_hundredth(double deg) {
  return std::round(deg * 100) / 100;
}

// The arc left by the largest gap between sorted longitudes, as its western end and width.
std::pair<double, double> arc_beside_largest_gap(std::vector<double> longitudes) {
  std::sort(longitudes.begin(), longitudes.end());
  double west = longitudes.front();
  double gap = longitudes.front() + 360 - longitudes.back();
  for (std::size_t i = 1; i < longitudes.size(); ++i) {
    if (longitudes[i] - longitudes[i - 1] > gap) {
      gap = longitudes[i] - longitudes[i - 1];
      west = longitudes[i];
    }
  }
  return {west, 360 - gap};
}

Extent measure_extent(std::span<const Point2> lonlat) {
  Extent extent;
  Box2 in_180;
  Box2 in_360;
  for (std::size_t i = 0; i < lonlat.size(); ++i) {
    check_position(lonlat[i], i);
    in_180.add({wrap_180(lonlat[i].x), lonlat[i].y});
    in_360.add({wrap_360(lonlat[i].x), lonlat[i].y});
    extent.beyond_180 |= lonlat[i].x > 180;
  }
  double west = in_180.x_min;
  double width = in_180.width();
  if (in_360.width() < width) {
    west = in_360.x_min;
    width = in_360.width();
  }
  if (width >= 180) {
    std::vector<double> longitudes(lonlat.size());
    std::transform(lonlat.begin(), lonlat.end(), longitudes.begin(), [](Point2 p) { return wrap_180(p.x); });
    std::tie(west, width) = arc_beside_largest_gap(std::move(longitudes));
  }
  const double middle = round_to_hundredth(west + width / 2);
  extent.centre.x = extent.beyond_180 ? wrap_360(middle) : wrap_180(middle);
  extent.centre.y = round_to_hundredth((in_180.y_min + in_180.y_max) / 2);
  extent.half_width = width / 2;
  extent.lat_min = in_180.y_min;
  extent.lat_max = in_180.y_max;
  return extent;
}

}  // namespace

struct MetricFrame::Plane {
  Ellipsoid ellipsoid;
  Projection projection = Projection::TransverseMercator;
  Point2 centre;
  bool beyond_180 = false;
  std::variant<TransverseMercator, LambertConformalConic, PolarStereographic> map;
  double northing_at_centre = 0;

  // Easting and northing of a position `lon` degrees east of the centre, and the scale there.
  struct Image {
    Point2 at;
    double scale = 0;
  };
  [[nodiscard]] Image image(double lon, double lat) const {
    Image i;
    double convergence = 0;
    if (const auto* mercator = std::get_if<TransverseMercator>(&map)) {
      mercator->Forward(0, lat, lon, i.at.x, i.at.y, convergence, i.scale);
    } else if (const auto* conic = std::get_if<LambertConformalConic>(&map)) {
      conic->Forward(0, lat, lon, i.at.x, i.at.y, convergence, i.scale);
    } else {
      std::get<PolarStereographic>(map).Forward(centre.y > 0, lat, lon, i.at.x, i.at.y, convergence, i.scale);
    }
    i.at.y -= northing_at_centre;
    return i;
  }
  // Degrees east of the centre, and latitude.
  [[nodiscard]] Point2 source(Point2 p) const {
    const double y = p.y + northing_at_centre;
    Point2 s;
    if (const auto* mercator = std::get_if<TransverseMercator>(&map)) {
      mercator->Reverse(0, p.x, y, s.y, s.x);
    } else if (const auto* conic = std::get_if<LambertConformalConic>(&map)) {
      conic->Reverse(0, p.x, y, s.y, s.x);
    } else {
      std::get<PolarStereographic>(map).Reverse(centre.y > 0, p.x, y, s.y, s.x);
    }
    return s;
  }

  static Plane make(Projection projection, const Extent& extent, Ellipsoid ellipsoid) {
    const double a = ellipsoid.equatorial_radius_m;
    const double f = ellipsoid.flattening;
    const Point2 centre = extent.centre;
    switch (projection) {
      case Projection::TransverseMercator: {
        Plane plane{ellipsoid, projection, centre, extent.beyond_180, TransverseMercator(a, f, 1), 0};
        plane.northing_at_centre = plane.image(0, centre.y).at.y;
        return plane;
      }
      case Projection::LambertConformalConic:
        return {ellipsoid, projection, centre, extent.beyond_180, LambertConformalConic(a, f, centre.y, 1),
                0};
      case Projection::Mercator:
        return {ellipsoid, projection, {centre.x, 0}, extent.beyond_180, LambertConformalConic(a, f, 0, 1),
                0};
      case Projection::PolarStereographic:
        break;
    }
    return {ellipsoid,
            projection,
            {centre.x, std::copysign(90.0, centre.y)},
            extent.beyond_180,
            PolarStereographic(a, f, 1),
            0};
  }

  // Largest over smallest scale within the extent; infinite where the map is singular.
  [[nodiscard]] double spread(const Extent& extent) const {
    constexpr int kSteps = 16;
    double smallest = std::numeric_limits<double>::infinity();
    double largest = 0;
    for (int i = 0; i <= kSteps; ++i) {
      for (int j = 0; j <= kSteps; ++j) {
        const double lat = std::lerp(extent.lat_min, extent.lat_max, static_cast<double>(i) / kSteps);
        const double scale = image(extent.half_width * j / kSteps, lat).scale;
        if (!std::isfinite(scale) || scale <= 0) return std::numeric_limits<double>::infinity();
        smallest = std::min(smallest, scale);
        largest = std::max(largest, scale);
      }
    }
    return largest / smallest;
  }
};

namespace {

void check_ellipsoid(const Ellipsoid& ellipsoid) {
  const auto& [radius, flattening] = ellipsoid;
  if (std::isfinite(radius) && radius > 0 && std::isfinite(flattening) && flattening < 1) return;
  throw Error(ErrorCode::BadCrs,
              fmt::format("an ellipsoid with an equatorial radius of {} m and a flattening of {} "
                          "is none of the earth's",
                          radius, flattening));
}

}  // namespace

MetricFrame MetricFrame::for_extent(std::span<const Point2> lonlat_deg, Ellipsoid ellipsoid) {
  check_ellipsoid(ellipsoid);
  if (lonlat_deg.empty()) {
    throw Error(ErrorCode::EmptyInput, "no positions to choose a metric plane for; give points or lines");
  }
  constexpr double kWidestTransverse = 45;  // half of the arc
  constexpr double kNarrowSpread = 1.01;
  constexpr double kTransverseSpread = 1.2;
  constexpr double kPolarLatitude = 60;
  constexpr double kHalfCircle = 90;  // half of the arc
  constexpr double kSteepestCone = 4;
  constexpr double kLargestSpread = 100;
  const Extent extent = measure_extent(lonlat_deg);
  const auto choose = [](Plane plane) {
    return MetricFrame(std::make_shared<const Plane>(std::move(plane)));
  };

  double best_spread = std::numeric_limits<double>::infinity();
  std::optional<Plane> best;
  if (extent.half_width <= kWidestTransverse) {
    Plane transverse = Plane::make(Projection::TransverseMercator, extent, ellipsoid);
    const double spread = transverse.spread(extent);
    if (spread <= kNarrowSpread) return choose(std::move(transverse));
    if (spread <= kTransverseSpread) {
      best_spread = spread;
      best = std::move(transverse);
    }
  }
  Plane polar = Plane::make(Projection::PolarStereographic, extent, ellipsoid);
  const bool about_pole = extent.lat_min >= kPolarLatitude || extent.lat_max <= -kPolarLatitude;
  if (about_pole && extent.half_width > kHalfCircle) return choose(std::move(polar));
  const auto conic =
      std::abs(extent.centre.y) < kSteepestCone ? Projection::Mercator : Projection::LambertConformalConic;
  for (Plane plane : {Plane::make(conic, extent, ellipsoid), std::move(polar)}) {
    const double spread = plane.spread(extent);
    if (spread >= best_spread) continue;
    best_spread = spread;
    best = std::move(plane);
  }
  if (best_spread >= kLargestSpread) {
    throw Error(
        ErrorCode::BadCoordinate,
        fmt::format(
            "no conformal plane holds latitudes {} to {} on an arc of {:.0f} degrees without stretching "
            "lengths a hundredfold; cut the data with --bbox, or choose a plane with --t-crs",
            extent.lat_min, extent.lat_max, 2 * extent.half_width));
  }
  return choose(std::move(*best));
}

MetricFrame MetricFrame::from_proj_string(const std::string& text, Ellipsoid ellipsoid) {
  check_ellipsoid(ellipsoid);
  const auto value = [&](const std::string& key) -> std::string {
    const std::size_t at = text.find("+" + key + "=");
    if (at == std::string::npos) return {};
    const std::size_t begin = at + key.size() + 2;
    return text.substr(begin, text.find(' ', begin) - begin);
  };
  const std::string name = value("proj");
  const auto projection = name == "tmerc"  ? Projection::TransverseMercator
                          : name == "lcc"  ? Projection::LambertConformalConic
                          : name == "merc" ? Projection::Mercator
                                           : Projection::PolarStereographic;
  const std::string lon = value("lon_0"), lat = name == "merc" ? "0" : value("lat_0");
  Extent extent;
  extent.centre = {std::strtod(lon.c_str(), nullptr), std::strtod(lat.c_str(), nullptr)};
  MetricFrame frame(std::make_shared<const Plane>(Plane::make(projection, extent, ellipsoid)));
  if (lon.empty() || lat.empty() || frame.proj_string() != text) {
    throw Error(ErrorCode::BadCrs, "'" + text + "' is no metric plane of this program and ellipsoid");
  }
  return frame;
}

Point2 MetricFrame::to_plane(Point2 lonlat_deg) const {
  check_position(lonlat_deg, 0);
  return plane_->image(wrap_180(lonlat_deg.x - plane_->centre.x), lonlat_deg.y).at;
}

std::vector<Point2> MetricFrame::to_plane(std::span<const Point2> lonlat_deg,
                                          const Progress& progress) const {
  constexpr std::size_t kBlock = 4096;
  std::vector<Point2> plane(lonlat_deg.size());
  for_each_block(lonlat_deg.size(), kBlock, progress, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      check_position(lonlat_deg[i], i);
      plane[i] = plane_->image(wrap_180(lonlat_deg[i].x - plane_->centre.x), lonlat_deg[i].y).at;
    }
  });
  return plane;
}

Point2 MetricFrame::to_geographic(Point2 plane) const {
  const Point2 source = plane_->source(plane);
  const double lon = source.x + plane_->centre.x;
  return {plane_->beyond_180 ? wrap_360(lon) : wrap_180(lon), source.y};
}

Point2 MetricFrame::continuous(Point2 lonlat_deg) const {
  const double turns = std::round((lonlat_deg.x - plane_->centre.x) / 360);
  return {std::abs(lonlat_deg.x - plane_->centre.x) <= 180 ? lonlat_deg.x : lonlat_deg.x - 360 * turns,
          lonlat_deg.y};
}

Projection MetricFrame::projection() const {
  return plane_->projection;
}
Ellipsoid MetricFrame::ellipsoid() const {
  return plane_->ellipsoid;
}
Point2 MetricFrame::centre_deg() const {
  return plane_->centre;
}

std::string MetricFrame::proj_string() const {
  const Point2 centre = {wrap_180(plane_->centre.x), plane_->centre.y};
  std::string map;
  switch (plane_->projection) {
    case Projection::TransverseMercator:
      map = fmt::format("tmerc +lat_0={}", centre.y);
      break;
    case Projection::LambertConformalConic:
      map = fmt::format("lcc +lat_1={0} +lat_0={0}", centre.y);
      break;
    case Projection::Mercator:
      map = "merc";
      break;
    case Projection::PolarStereographic:
      map = fmt::format("stere +lat_0={}", centre.y);
      break;
  }
  const double a = plane_->ellipsoid.equatorial_radius_m;
  const double f = plane_->ellipsoid.flattening;
  // Fifteen digits: what the flattening's rounding leaves of a published inverse flattening.
  const std::string shape = f == 0 ? fmt::format("+R={}", a) : fmt::format("+a={} +rf={:.15g}", a, 1 / f);
  return fmt::format("+proj={} +lon_0={} +k_0=1 +x_0=0 +y_0=0 {} +units=m +no_defs +type=crs", map, centre.x,
                     shape);
}

}  // namespace thalweg
