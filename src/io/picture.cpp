// The page of one TIN: title, map, legend, scale bar.
//
// 1. Sizes follow one font size, a hundredth of the page's width but never less than 9 pixels.
// 2. On wide pages the legend stands beside the map, on narrow ones below it. The map is as large as its room
//    allows.
#include "io/picture_legend.hpp"
#include "io/picture_page.hpp"

#include <thalweg/io/picture.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace thalweg {

namespace {

constexpr double kSmallestFont = 9;

// Where everything goes on the page.
struct PageLayout {
  double font_size = 0;
  double width = 0, height = 0;
  double margin = 0;
  double title_baseline = 0;
  MapPanel panel;
  double scale_bar_middle = 0;
  double legend_left = 0, legend_top = 0;
};

PageLayout lay_out(const PictureScene& scene, const Legend& legend, double font_size) {
  constexpr double kSideBySide = 900;
  constexpr double kTallest = 1.1;  // height of the map over its width
  PageLayout page;
  page.font_size = font_size;
  page.width = scene.width_px;
  page.margin = 1.6 * font_size;
  const bool beside = page.width >= kSideBySide;
  page.title_baseline = page.margin + font_size;
  MapPanel& panel = page.panel;
  panel.font_size = font_size;
  panel.left = page.margin;
  panel.top = std::round(scene.title.empty() ? page.margin : page.margin + 2.4 * font_size);
  panel.width = page.width - 2 * page.margin - (beside ? legend.width() + page.margin : 0);
  fit_ground(panel, ground_of(scene.tin), kTallest, beside ? legend.height() : 0);
  page.scale_bar_middle = panel.top + panel.height + 1.4 * font_size;
  page.legend_left = beside ? panel.left + panel.width + page.margin : page.margin;
  page.legend_top = beside ? panel.top : page.scale_bar_middle + 2 * font_size;
  const double below = beside ? page.scale_bar_middle + font_size : page.legend_top + legend.height();
  page.height = std::ceil(below + page.margin);
  return page;
}

void draw_title(Canvas& canvas, const std::string& title, double left, double baseline, double width,
                double font_size) {
  if (title.empty()) return;
  canvas.set_font(font_size, Weight::Bold);
  canvas.text(left, baseline, canvas.fitted(printable(title), width), MapColours::kInk);
}

}  // namespace

void draw_picture(const std::string& path, const std::string& extension, const PictureScene& scene,
                  Progress& progress) {
  constexpr double kFontsAcross = 100;
  const PictureFormat format = parse_picture_extension(extension);
  check_scene(scene);
  const double font_size = std::max(kSmallestFont, scene.width_px / kFontsAcross);
  const ReliefStyle style(scene);
  const Legend legend(legend_rows(scene), scene.vertical_metres_per_unit, style, font_size);
  const PageLayout page = lay_out(scene, legend, font_size);
  write_page(path, scene.target.empty() ? path : scene.target, {page.width, page.height, format},
             [&](Canvas& canvas) {
               canvas.fill_box(0, 0, page.width, page.height, MapColours::kPaper);
               draw_title(canvas, scene.title, page.margin, page.title_baseline, page.width - 2 * page.margin,
                          1.35 * font_size);
               draw_map(canvas, scene, style, page.panel, format, progress);
               legend.draw(canvas, page.legend_left, page.legend_top);
               draw_footer(canvas, scene, style, page.panel, page.scale_bar_middle, page.panel.width);
             });
  progress.advance(1);
}

void draw_comparison(const std::string& path, const std::string& extension, const ComparisonScene& scene,
                     Progress& progress) {
  constexpr double kFontsAcross = 150;
  constexpr double kTallest = 1.6;
  const PictureFormat format = parse_picture_extension(extension);
  check_scene(scene.before);
  check_scene(scene.after);
  const double font_size = std::max(kSmallestFont, scene.after.width_px / kFontsAcross);
  const double margin = 1.6 * font_size;
  const ReliefStyle style(scene.before);
  const Legend legend(legend_rows(scene), scene.before.vertical_metres_per_unit, style, font_size);
  const double width = scene.after.width_px;
  const double room = width - 2 * margin - legend.width() - margin;
  MapPanel left{.left = margin,
                .top = std::round(margin + 2 * font_size),
                .width = std::floor((room - margin) / 2),
                .frame = {},
                .font_size = font_size};
  fit_ground(left, ground_of(scene.before.tin), kTallest, legend.height());
  MapPanel right = left;
  right.left += left.width + margin;
  right.frame.left += left.width + margin;
  const double footer = left.top + left.height + 1.4 * font_size;
  write_page(
      path, scene.after.target.empty() ? path : scene.after.target,
      {width, std::ceil(footer + font_size + margin), format}, [&](Canvas& canvas) {
        canvas.fill_box(0, 0, width, footer + 2 * font_size + margin, MapColours::kPaper);
        for (const auto& [part, panel] : {std::pair(&scene.before, &left), std::pair(&scene.after, &right)}) {
          draw_title(canvas, part->title, panel->left, margin + font_size, panel->width, 1.2 * font_size);
          draw_map(canvas, *part, style, *panel, format, progress);
        }
        legend.draw(canvas, right.left + right.width + margin, right.top);
        draw_footer(canvas, scene.before, style, left, footer, 2 * left.width + margin);
      });
  progress.advance(1);
}

std::span<const FormatInfo> picture_formats() {
  static const std::vector<FormatInfo> formats = {{"PNG", "Picture, pixels", {".png"}, false, true, {}},
                                                  {"SVG", "Picture, vectors", {".svg"}, false, true, {}},
                                                  {"PDF", "Picture, one page", {".pdf"}, false, true, {}}};
  return formats;
}

}  // namespace thalweg
