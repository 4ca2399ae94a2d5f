#pragma once

/// A map of a TIN: shaded relief, triangles, lines and pits.

#include <thalweg/base/progress.hpp>
#include <thalweg/io/format_info.hpp>
#include <thalweg/mesh/tin.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <string>

namespace thalweg {

/// What the map shows. Spans may be empty: not shown.
struct PictureScene {
  const Tin& tin;
  double horizontal_metres_per_unit = 1;
  double vertical_metres_per_unit = 1;
  std::span<const std::uint8_t> pits_before = {};  ///< one a vertex: stands for a pit of the Delaunay TIN
  std::span<const std::uint8_t> pits_after = {};   ///< one a vertex: stands for a pit of this TIN
  std::span<const std::uint8_t> pits_new =
      {};  ///< one a vertex: stands for a pit that another TIN does not have
  std::span<const std::array<VertexId, 2>> flipped =
      {};  ///< edges of this TIN that the Delaunay TIN does not have
  std::string title = {};
  std::string target = {};  ///< the file's name in errors; empty: `path`
  int width_px = 1600;      ///< of the whole picture; PDF and SVG have the same size in points
};

/// Draws the map to the file `path`. `extension` (".png", ".svg" or ".pdf", any case) decides the format.
/// Detail follows the scale: triangles thin out as they get small, symbols shrink where they are many; in SVG
/// and PDF the relief of a large TIN is an embedded image. Equal input gives equal bytes in PNG and PDF.
/// Throws: Error{Usage} for another extension or a width outside 400 to 8000; Error{EmptyInput} if there is
/// no triangle; Error{WriteFailed}; Error{Cancelled}.
void draw_picture(const std::string& path, const std::string& extension, const PictureScene& scene,
                  Progress& progress);

/// Two TINs of the same vertices. The left map marks in `flipped` what the right one does not have, and the
/// other way round; `pits_before` of the left are the pits that are gone, `pits_after` of both those that are
/// left, `pits_new` of the right those that came.
struct ComparisonScene {
  PictureScene before;  ///< its title stands over the left map
  PictureScene after;   ///< its width is that of the whole picture
};

/// Draws both side by side, in the same colours, light and scale, with one legend. Otherwise as draw_picture.
void draw_comparison(const std::string& path, const std::string& extension, const ComparisonScene& scene,
                     Progress& progress);

/// The formats of pictures.
std::span<const FormatInfo> picture_formats();

}  // namespace thalweg
