#pragma once

/// Shaded relief of a TIN as an image.

#include "io/picture_canvas.hpp"

#include <thalweg/base/progress.hpp>
#include <thalweg/io/picture.hpp>

#include <cstdint>
#include <vector>

namespace thalweg {

/// Where ground lies on the page: x right, y up on the ground, down on the page, one scale.
struct MapFrame {
  Box2 ground;
  double left = 0;
  double top = 0;
  double pixels_per_unit = 1;

  [[nodiscard]] Point2 to_page(Point2 p) const {
    return {left + (p.x - ground.x_min) * pixels_per_unit, top + (ground.y_max - p.y) * pixels_per_unit};
  }
  [[nodiscard]] double width() const { return ground.width() * pixels_per_unit; }
  [[nodiscard]] double height() const { return ground.height() * pixels_per_unit; }
};

/// Colours of heights and the exaggeration of the shading.
class ReliefStyle {
 public:
  explicit ReliefStyle(const PictureScene& scene);
  /// Heights, in units of the TIN, at the ends of the colour ramp; what lies beyond has the end's colour.
  [[nodiscard]] double z_low() const { return z_low_; }
  [[nodiscard]] double z_high() const { return z_high_; }
  /// By how much heights are exaggerated where the relief is shaded: 1 on steep ground.
  [[nodiscard]] double exaggeration() const { return exaggeration_; }
  /// The colour of flat ground, from 0 at the low end to 1 at the high end.
  [[nodiscard]] Colour tint(double position) const;
  /// The colour of ground at a height that is lit by `light` (1 on flat ground, 0 in the shade, up to sqrt
  /// 2).
  [[nodiscard]] Colour shaded(double z, double light) const;
  /// Light on a triangle from the north-west, 45 degrees above the horizon.
  [[nodiscard]] double light(const Tin& tin, const Triangle& triangle) const;

 private:
  double z_low_ = 0;
  double z_high_ = 1;
  double exaggeration_ = 1;
  double slope_factor_ = 1;  ///< vertical over horizontal metres a unit, times the exaggeration
  std::vector<Colour> ramp_;
};

/// Pixels as Cairo's ARGB32 wants them: 0xAARRGGBB, premultiplied, row by row.
struct ReliefImage {
  int width = 0;
  int height = 0;
  std::vector<std::uint32_t> pixels;
};

/// Draws the relief of the ground of `frame` into an image of width x height pixels, transparent outside the
/// TIN. Throws: Error{Cancelled}. Complexity: linear in triangles and pixels.
ReliefImage draw_relief(const Tin& tin, const ReliefStyle& style, const MapFrame& frame, int width,
                        int height, Progress& progress);

}  // namespace thalweg
