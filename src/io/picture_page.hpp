#pragma once

/// What every picture is made of: a page in one of the file formats, maps on it, and the line below them.

#include "io/picture_map.hpp"

#include <functional>
#include <string>

namespace thalweg {

enum class PictureFormat : std::uint8_t { Png, Svg, Pdf };

/// Throws: Error{Usage} for an extension that is none of a picture.
PictureFormat parse_picture_extension(const std::string& extension);

/// Throws: Error{Usage} for a width outside 400 to 8000.
void check_width(int width_px);

/// Throws: Error{Usage} as check_width; Error{EmptyInput} for a TIN without triangles;
/// Error{Internal} for spans that do not fit it.
void check_scene(const PictureScene& scene);

/// Size of a page in pixels (points), and how it is written.
struct PageSize {
  double width = 0;
  double height = 0;
  PictureFormat format = PictureFormat::Png;
};

/// Lets `draw` fill a page and writes it to `path`; errors name `target`.
/// Throws: what `draw` throws; Error{WriteFailed, OutOfMemory, Internal}.
void write_page(const std::string& path, const std::string& target, PageSize page,
                const std::function<void(Canvas&)>& draw);

/// A framed map.
struct MapPanel {
  double left = 0, top = 0, width = 0, height = 0;
  MapFrame frame;
  double font_size = 10;
};

/// The box of all triangles.
Box2 ground_of(const Tin& tin);

/// Lays the ground into the middle of the panel's box, whose height is that of the ground at the largest
/// scale at which it fits the width and `tallest` times the width. Pre: left, top, width, font_size are set.
void fit_ground(MapPanel& panel, const Box2& ground, double tallest, double least_height);

/// Draws relief, triangles, lines and pits. In SVG and PDF the relief is an image of twice the page's
/// resolution.
void draw_map(Canvas& canvas, const PictureScene& scene, const ReliefStyle& style, const MapPanel& panel,
              PictureFormat format, Progress& progress);

/// Scale bar at the left, light and exaggeration at the right, over `width`.
void draw_footer(Canvas& canvas, const PictureScene& scene, const ReliefStyle& style, const MapPanel& panel,
                 double middle, double width);

}  // namespace thalweg
