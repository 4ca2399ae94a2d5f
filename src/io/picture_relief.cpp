// Shaded relief.
//
// 1. Colour by height: a ramp of quiet map colours between the 0.2 and 99.8 % quantiles of the vertices'
//    heights, so that one stray point does not take the colours from all others. Ground that lies wholly
//    under zero is sea bed.
// 2. Light: Lambert's law, one value a triangle, from the north-west (azimuth 315, altitude 45 degrees),
//    divided by that of flat ground. Shade darkens and cools the colour, light bleaches it.
// 3. Heights are exaggerated for the light only, until the mean slope is that of hills (1 in 4): plains show
//    their form.
// 4. Each pixel is the mean of 2 x 2 samples; a sample belongs to the triangle that holds it (edge
//    functions).
#include "io/picture_relief.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <utility>

namespace thalweg {

namespace {

struct Stop {
  double position;
  Colour colour;
};

constexpr std::array<Stop, 7> kLand = {{{0.00, rgb(0x8fb996)},
                                        {0.18, rgb(0xb5cf9f)},
                                        {0.38, rgb(0xdfe0ae)},
                                        {0.58, rgb(0xeed9a7)},
                                        {0.76, rgb(0xd8b48b)},
                                        {0.90, rgb(0xc4a596)},
                                        {1.00, rgb(0xf1ebe7)}}};
constexpr std::array<Stop, 5> kSea = {{{0.00, rgb(0x3f6d99)},
                                       {0.30, rgb(0x6b9bbf)},
                                       {0.60, rgb(0x9fc6d8)},
                                       {0.85, rgb(0xcfe5e6)},
                                       {1.00, rgb(0xeff4ea)}}};

Colour mix(Colour a, Colour b, double share) {
  return {a.red + (b.red - a.red) * share, a.green + (b.green - a.green) * share,
          a.blue + (b.blue - a.blue) * share, a.alpha + (b.alpha - a.alpha) * share};
}

Colour ramp(std::span<const Stop> stops, double position) {
  for (std::size_t i = 1; i < stops.size(); ++i) {
    if (position > stops[i].position) continue;
    const double length = stops[i].position - stops[i - 1].position;
    return mix(stops[i - 1].colour, stops[i].colour, (position - stops[i - 1].position) / length);
  }
  return stops.back().colour;
}

struct Gradient {
  double x = 0;
  double y = 0;
};

// Slope of a triangle's plane, zero for a flat or degenerate one.
Gradient gradient(const Tin& tin, const Triangle& t) {
  const Point2 a = tin.point(t[0]), b = tin.point(t[1]), c = tin.point(t[2]);
  const double za = tin.height(t[0]), zb = tin.height(t[1]) - za, zc = tin.height(t[2]) - za;
  const double bx = b.x - a.x, by = b.y - a.y, cx = c.x - a.x, cy = c.y - a.y;
  const double area = bx * cy - by * cx;
  if (!(area > 0)) return {};
  return {(zb * cy - zc * by) / area, (zc * bx - zb * cx) / area};
}

// Mean slope of the ground: by area, so that slivers count for nothing.
double mean_slope(const Tin& tin) {
  double area_sum = 0;
  double slope_sum = 0;
  for (const Triangle& t : tin.triangles()) {
    const Point2 a = tin.point(t[0]), b = tin.point(t[1]), c = tin.point(t[2]);
    const double area = std::abs((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x));
    const Gradient g = gradient(tin, t);
    area_sum += area;
    slope_sum += area * std::hypot(g.x, g.y);
  }
  return area_sum > 0 ? slope_sum / area_sum : 0;
}

/// The least and greatest value but for a share of strays at either end.
std::pair<double, double> range_without(std::vector<double>& values, double share) {
  const auto strays = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  const auto low = values.begin() + strays, high = values.end() - 1 - strays;
  std::nth_element(values.begin(), low, values.end());
  const double least = *low;
  std::nth_element(low, high, values.end());
  return {least, *high};
}

std::uint32_t to_pixel(Colour c) {
  const auto byte = [](double v) {
    return static_cast<std::uint32_t>(std::lround(std::clamp(v, 0.0, 1.0) * 255));
  };
  return 0xff000000U | byte(c.red) << 16U | byte(c.green) << 8U | byte(c.blue);
}

}  // namespace

ReliefStyle::ReliefStyle(const PictureScene& scene) : ramp_(1024) {
  constexpr double kStray = 0.002;
  constexpr double kHills = 0.25;
  constexpr double kMost = 50;
  std::vector<double> heights;
  for (std::size_t v = 0; v < scene.tin.vertex_count(); ++v) {
    if (!scene.tin.outgoing(VertexId{v}).empty()) heights.push_back(scene.tin.heights()[v]);
  }
  std::tie(z_low_, z_high_) = range_without(heights, kStray);
  const bool under_water = *std::max_element(heights.begin(), heights.end()) <= 0 && z_low_ < 0;
  const double vertical = scene.vertical_metres_per_unit / scene.horizontal_metres_per_unit;
  const double slope = mean_slope(scene.tin) * vertical;
  if (slope > 0) exaggeration_ = round_down_nicely(std::clamp(kHills / slope, 1.0, kMost));
  slope_factor_ = vertical * exaggeration_;
  for (std::size_t i = 0; i < ramp_.size(); ++i) {
    const double position = static_cast<double>(i) / static_cast<double>(ramp_.size() - 1);
    ramp_[i] = under_water ? ramp(kSea, position) : ramp(kLand, position);
  }
}

Colour ReliefStyle::tint(double position) const {
  return ramp_[static_cast<std::size_t>(position * static_cast<double>(ramp_.size() - 1))];
}

double ReliefStyle::light(const Tin& tin, const Triangle& triangle) const {
  const Gradient g = gradient(tin, triangle);
  const double x = -g.x * slope_factor_, y = -g.y * slope_factor_;
  // The sun stands at (-1/2, 1/2, sqrt 1/2); flat ground gets sqrt 1/2.
  const double sun = (-0.5 * x + 0.5 * y) * std::sqrt(2.0) + 1;
  return std::max(0.0, sun / std::sqrt(x * x + y * y + 1));
}

Colour ReliefStyle::shaded(double z, double light) const {
  constexpr Colour kShade = rgb(0x3b4464);
  constexpr double kDarkest = 0.72;
  constexpr double kBrightest = 0.55;
  const double range = z_high_ - z_low_;
  const Colour colour = tint(range > 0 ? std::clamp((z - z_low_) / range, 0.0, 1.0) : 0.5);
  if (light >= 1) return mix(colour, rgb(0xffffff), kBrightest * (light - 1) / (std::sqrt(2.0) - 1));
  const Colour multiplied = {colour.red * kShade.red, colour.green * kShade.green, colour.blue * kShade.blue,
                             1};
  return mix(colour, multiplied, kDarkest * (1 - light));
}

namespace {

constexpr int kSamples = 2;  // a pixel and direction

// Fills samples, row 0 at the bottom.
class Painter {
 public:
  Painter(const Tin& tin, const ReliefStyle& style, const MapFrame& frame, int width, int height)
      : tin_(tin),
        style_(style),
        origin_{frame.ground.x_min, frame.ground.y_min},
        columns_(kSamples * width),
        rows_(kSamples * height),
        x_scale_(columns_ / frame.ground.width()),
        y_scale_(rows_ / frame.ground.height()),
        samples_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), 0) {}

  void paint(const Triangle& triangle) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Point2 p = tin_.point(triangle[i]);
      corners_[i] = {(p.x - origin_.x) * x_scale_, (p.y - origin_.y) * y_scale_};
    }
    const auto [a, b, c] = corners_;
    const double area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    if (!(area > 0)) return;
    light_ = style_.light(tin_, triangle);
    const double za = tin_.height(triangle[0]);
    const double zb = tin_.height(triangle[1]) - za, zc = tin_.height(triangle[2]) - za;
    z_x_ = (zb * (c.y - a.y) - zc * (b.y - a.y)) / area;
    z_y_ = (zc * (b.x - a.x) - zb * (c.x - a.x)) / area;
    z_origin_ = za - z_x_ * a.x - z_y_ * a.y;
    const int first = first_centre(std::min({a.y, b.y, c.y}));
    const int last = std::min(rows_ - 1, last_centre(std::max({a.y, b.y, c.y})));
    for (int row = first; row <= last; ++row) paint_row(row);
  }

  [[nodiscard]] ReliefImage averaged() const {
    ReliefImage image{columns_ / kSamples, rows_ / kSamples, {}};
    image.pixels.reserve(samples_.size() / kSamples / kSamples);
    for (int row = image.height - 1; row >= 0; --row) {
      for (int column = 0; column < image.width; ++column) image.pixels.push_back(average(row, column));
    }
    return image;
  }

 private:
  // First and last sample whose centre lies right of, left of a coordinate.
  static int first_centre(double x) { return std::max(0, static_cast<int>(std::ceil(x - 0.5))); }
  static int last_centre(double x) { return static_cast<int>(std::floor(x - 0.5)); }
  std::uint32_t* sample(int row, int column) {
    return &samples_[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
                     static_cast<std::size_t>(column)];
  }

  // The row's part of the triangle is right of every edge that runs down and left of every edge that runs up.
  void paint_row(int row) {
    const double y = row + 0.5;
    double from = 0, to = columns_;
    for (std::size_t i = 0; i < 3; ++i) {
      const Point2 a = corners_[i], b = corners_[(i + 1) % 3];
      if (a.y == b.y) continue;
      const double x = a.x + (y - a.y) * (b.x - a.x) / (b.y - a.y);
      if (b.y < a.y)
        from = std::max(from, x);
      else
        to = std::min(to, x);
    }
    const int last = std::min(columns_ - 1, last_centre(to));
    for (int column = first_centre(from); column <= last; ++column) {
      *sample(row, column) = to_pixel(style_.shaded(z_origin_ + z_x_ * (column + 0.5) + z_y_ * y, light_));
    }
  }

  [[nodiscard]] std::uint32_t average(int row, int column) const {
    std::array<std::uint32_t, 4> sums{};
    for (int i = 0; i < kSamples; ++i) {
      for (int j = 0; j < kSamples; ++j) {
        const std::uint32_t pixel =
            samples_[static_cast<std::size_t>(kSamples * row + i) * static_cast<std::size_t>(columns_) +
                     static_cast<std::size_t>(kSamples * column + j)];
        for (std::size_t k = 0; k < 4; ++k) sums[k] += pixel >> 8 * k & 0xffU;
      }
    }
    std::uint32_t pixel = 0;
    for (std::size_t k = 0; k < 4; ++k) pixel |= (sums[k] / (kSamples * kSamples)) << 8 * k;
    return pixel;
  }

  const Tin& tin_;
  const ReliefStyle& style_;
  Point2 origin_;
  int columns_, rows_;
  double x_scale_, y_scale_;
  std::vector<std::uint32_t> samples_;
  // Of the triangle that is being painted, in samples:
  std::array<Point2, 3> corners_;
  double light_ = 1;
  double z_origin_ = 0, z_x_ = 0, z_y_ = 0;
};

}  // namespace

ReliefImage draw_relief(const Tin& tin, const ReliefStyle& style, const MapFrame& frame, int width,
                        int height, Progress& progress) {
  constexpr std::size_t kProgressStep = 1U << 10U;
  Painter painter(tin, style, frame, width, height);
  progress.start_phase("draw relief");
  for (std::size_t t = 0; t < tin.triangle_count(); ++t) {
    if (t % kProgressStep == 0)
      progress.advance(static_cast<double>(t) / static_cast<double>(tin.triangle_count()));
    painter.paint(tin.triangles()[t]);
  }
  return painter.averaged();
}

}  // namespace thalweg
