// Sampling by point location: each place is found by a walk from the triangle of the place before it.
//
// Places are handed out in blocks to all threads. A walk that starts elsewhere ends in the same vertex, edge
// or triangle, so heights do not depend on the blocks; blocks have a fixed size, so neither does the choice
// of triangle on an edge.
#include "base/parallel.hpp"

#include <thalweg/delaunay/surface.hpp>
#include <thalweg/terrain/sample_surface.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace thalweg {

namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr double kDegrees = 180 / std::numbers::pi;

struct Gradient {
  double dx = 0;
  double dy = 0;
};

/// Rise a metre to the east and to the north.
Gradient gradient_of(const Tin& tin, TriangleId t, const MetricScale& scale) {
  const Triangle& corner = tin.triangle(t);
  const Point2 a = tin.point(corner[0]), b = tin.point(corner[1]), c = tin.point(corner[2]);
  const double ux = b.x - a.x, uy = b.y - a.y, uz = tin.height(corner[1]) - tin.height(corner[0]);
  const double vx = c.x - a.x, vy = c.y - a.y, vz = tin.height(corner[2]) - tin.height(corner[0]);
  const double factor =
      scale.vertical_metres_per_unit / scale.horizontal_metres_per_unit / (ux * vy - uy * vx);
  return {(uz * vy - vz * uy) * factor, (vz * ux - uz * vx) * factor};
}

// Lambert: the cosine between the normal and the light, which comes from azimuth 315, altitude 45 degrees.
double hillshade(const Gradient& g) {
  const double side = std::sqrt(0.5);
  const double east = -side * side, north = side * side, up = side;
  const double cosine = (up - g.dx * east - g.dy * north) / std::sqrt(1 + g.dx * g.dx + g.dy * g.dy);
  return 1 + std::round(254 * std::clamp(cosine, 0.0, 1.0));
}

double aspect(const Gradient& g) {
  if (g.dx == 0 && g.dy == 0) return kNone;
  const double degrees = std::atan2(-g.dx, -g.dy) * kDegrees;
  return degrees < 0 ? degrees + 360 : degrees;
}

}  // namespace

struct SurfaceSampler::Index {
  const Tin& tin;
  MetricScale scale;
  SurfaceLocator locator;

  [[nodiscard]] double value(const SurfacePlace& place, Point2 p, SurfaceValue wanted) const {
    if (wanted == SurfaceValue::Elevation) return locator.height(place, p);
    const Gradient gradient = gradient_of(tin, place.triangle, scale);
    if (wanted == SurfaceValue::Slope) return std::atan(std::hypot(gradient.dx, gradient.dy)) * kDegrees;
    return wanted == SurfaceValue::Aspect ? aspect(gradient) : hillshade(gradient);
  }
};

SurfaceSampler::SurfaceSampler(const Tin& tin, MetricScale scale)
    : index_(new Index{tin, scale, SurfaceLocator(tin)}) {}
SurfaceSampler::~SurfaceSampler() = default;

std::vector<double> SurfaceSampler::sample(std::span<const Point2> places, SurfaceValue value,
                                           const Progress& progress) const {
  constexpr std::size_t kBlock = 4096;
  std::vector<double> values(places.size(), kNone);
  for_each_block(places.size(), kBlock, progress, [&](std::size_t begin, std::size_t end) {
    TriangleId hint;
    for (std::size_t i = begin; i < end; ++i) {
      const std::optional<SurfacePlace> place = index_->locator.locate(places[i], hint);
      if (!place) continue;
      hint = place->triangle;
      values[i] = index_->value(*place, places[i], value);
    }
  });
  return values;
}

}  // namespace thalweg
