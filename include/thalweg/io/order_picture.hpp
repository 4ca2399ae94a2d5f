#pragma once

/// A picture of one triangle, its circumcircle, and which vertices inside it count.

#include <thalweg/mesh/ground_mode.hpp>
#include <thalweg/mesh/tin.hpp>

#include <span>
#include <string>
#include <vector>

namespace thalweg {

/// One panel: what it is about, and the vertices that it marks.
struct OrderPanel {
  std::string title;               ///< at the left, over the panel
  std::string value;               ///< at the right
  std::string note;                ///< below the title, in quiet ink
  std::vector<VertexId> marked;    ///< ascending; drawn as filled discs
  std::vector<VertexId> unmarked;  ///< ascending; drawn as rings
};

struct OrderPictureScene {
  const Tin& ground;
  GroundMode mode = GroundMode::Hull;
  Triangle triangle{};
  std::span<const OrderPanel> panels;
  std::string title = {};
  std::string marked_label = {};    ///< what a disc means, for the legend; empty: not in it
  std::string unmarked_label = {};  ///< what a ring means
  std::string target = {};          ///< the file's name in errors; empty: the path
  int width_px = 1600;              ///< of a page of four panels; PDF and SVG have the same size in points
};

/// Draws the panels, four side by side, or a single one on half a page, to the file `path`. Each shows the
/// triangle, its circumcircle (if it is not flat), the constraint edges near by and all vertices: marked,
/// unmarked, or as dots; ids where there are few. In mode Polygon what is no ground is grey. All panels have
/// the same frame: the disc, cut to the ground, and the triangle. `extension` (".png", ".svg" or ".pdf", any
/// case) decides the format. Equal input gives equal bytes. Pre: there is a panel. Throws: Error{Usage} for
/// another extension or a width outside 400 to 8000; Error{WriteFailed}. Complexity: the vertices and edges
/// of the ground for each panel.
void draw_order_picture(const std::string& path, const std::string& extension,
                        const OrderPictureScene& scene);

}  // namespace thalweg
