#pragma once

/// The map of a picture: triangles, lines and pits over the relief; and its legend.

#include "io/picture_relief.hpp"

#include <thalweg/mesh/edge_kind.hpp>

#include <array>
#include <span>

namespace thalweg {

/// How lines of a kind are drawn.
struct LineStyle {
  EdgeKind kind = EdgeKind::None;
  const char* label = "";
  Colour colour;
  double width = 1;  ///< in tenths of the font's size
};

/// All kinds, in the order in which they are drawn; an edge of several kinds is drawn as the last of them.
std::span<const LineStyle> line_styles();

/// What the legend counts.
struct MapCounts {
  std::array<std::size_t, 6> edges{};  ///< constraint edges, as in `line_styles`
  std::size_t pits_before = 0;
  std::size_t pits_after = 0;
  std::size_t pits_new = 0;
};
MapCounts count_things(const PictureScene& scene);

struct MapColours {
  static constexpr Colour kPaper = rgb(0xffffff);
  static constexpr Colour kMapGround = rgb(0xf4f3ef);
  static constexpr Colour kInk = rgb(0x262626);
  static constexpr Colour kQuietInk = rgb(0x5c5c5c);
  static constexpr Colour kTriangle = rgb(0x2f2f2f);
  static constexpr Colour kFlipped = rgb(0xc2006b);
  static constexpr Colour kPitNew = rgb(0xe03c1f);
  static constexpr Colour kPitFill = rgb(0xffd92f);
  static constexpr Colour kPitInk = rgb(0x1f1f1f);
};

/// Edges that are no constraints: how many are large enough to be seen.
std::size_t count_visible_edges(const PictureScene& scene, const MapFrame& frame);

/// Draws edges that are no constraints, and over them those that were flipped. `unit` is a tenth of the
/// font's size.
void draw_triangle_edges(Canvas& canvas, const PictureScene& scene, const MapFrame& frame, double unit,
                         Progress& progress);
/// Draws constraint edges and pits.
void draw_lines_and_pits(Canvas& canvas, const PictureScene& scene, const MapFrame& frame, double unit,
                         Progress& progress);

/// Symbols of the legend, as on the map.
void draw_pit_before(Canvas& canvas, Point2 centre, double radius);
void draw_pit_after(Canvas& canvas, Point2 centre, double radius);
void draw_pit_new(Canvas& canvas, Point2 centre, double radius);

}  // namespace thalweg
