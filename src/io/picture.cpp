// The page: title, map, legend, scale bar.
//
// 1. Sizes follow one font size, a hundredth of the page's width but never less than 9 pixels.
// 2. On wide pages the legend stands beside the map, on narrow ones below it. The map is as large as its room
// allows.
// 3. The relief is always an image, of twice the page's resolution in SVG and PDF. Outlines of triangles are
// lines
//    over it, or a part of it where they would make a vector file unwieldy.
#include "io/file_writer.hpp"
#include "io/picture_legend.hpp"

#include <thalweg/base/error.hpp>
#include <thalweg/io/picture.hpp>

#include <cairo-pdf.h>
#include <cairo-svg.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>
#include <exception>
#include <optional>

namespace thalweg {

namespace {

enum class PictureFormat : std::uint8_t { Png, Svg, Pdf };

PictureFormat parse_extension(const std::string& extension) {
  std::string lower = extension;
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (lower == ".png") return PictureFormat::Png;
  if (lower == ".svg") return PictureFormat::Svg;
  if (lower == ".pdf") return PictureFormat::Pdf;
  throw Error(ErrorCode::Usage,
              "'" + extension + "' is no extension of a picture; known are .png, .svg and .pdf");
}

void check_scene(const PictureScene& scene) {
  constexpr int kNarrowest = 400;
  constexpr int kWidest = 8000;
  if (scene.width_px < kNarrowest || scene.width_px > kWidest) {
    throw Error(ErrorCode::Usage, "a picture of " + std::to_string(scene.width_px) +
                                      " pixels' width; it can be from " + std::to_string(kNarrowest) +
                                      " to " + std::to_string(kWidest));
  }
  if (scene.tin.triangle_count() == 0)
    throw Error(ErrorCode::EmptyInput, "a TIN without triangles has no picture");
  const std::size_t vertices = scene.tin.vertex_count();
  for (const std::span<const std::uint8_t> pits : {scene.pits_before, scene.pits_after}) {
    if (!pits.empty() && pits.size() != vertices) {
      throw Error(ErrorCode::Internal, "the pits of a picture do not fit its vertices");
    }
  }
}

struct DestroySurface {
  void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
};
using Surface = std::unique_ptr<cairo_surface_t, DestroySurface>;

// A file that Cairo writes to. Exceptions do not pass through Cairo: the first is kept and thrown later.
class SurfaceFile {
 public:
  SurfaceFile(const std::string& path, const std::string& target) : writer_(path, target) {}

  static cairo_status_t write(void* self, const unsigned char* data, unsigned int length) {
    auto& file = *static_cast<SurfaceFile*>(self);
    try {
      file.writer_.text({reinterpret_cast<const char*>(data), length});
      return CAIRO_STATUS_SUCCESS;
    } catch (...) {
      if (!file.failure_) file.failure_ = std::current_exception();
      return CAIRO_STATUS_WRITE_ERROR;
    }
  }

  void close(cairo_status_t status, const std::string& target) {
    if (failure_) std::rethrow_exception(failure_);
    if (status == CAIRO_STATUS_NO_MEMORY) {
      throw Error(ErrorCode::OutOfMemory, target + ": not enough memory to draw it; make it narrower");
    }
    if (status != CAIRO_STATUS_SUCCESS) {
      throw Error(ErrorCode::Internal,
                  target + ": could not be drawn (" + cairo_status_to_string(status) + ")");
    }
    writer_.close();
  }

 private:
  FileWriter writer_;
  std::exception_ptr failure_;
};

Box2 ground_of(const Tin& tin) {
  Box2 box;
  for (const Triangle& t : tin.triangles()) {
    for (const VertexId v : t) box.add(tin.point(v));
  }
  return box;
}

// Where everything goes on the page.
struct PageLayout {
  double font_size = 0;
  double width = 0, height = 0;
  double margin = 0;
  double title_baseline = 0;
  double room_left = 0, room_top = 0, room_width = 0, room_height = 0;  // of the map
  MapFrame frame;
  double scale_bar_middle = 0;
  double legend_left = 0, legend_top = 0;
};

PageLayout lay_out(const PictureScene& scene, const Legend& legend, double font_size) {
  constexpr double kSideBySide = 900;
  constexpr double kTallest = 1.1;  // height of the map's room over its width
  PageLayout page;
  page.font_size = font_size;
  page.width = scene.width_px;
  page.margin = 1.6 * font_size;
  const double padding = font_size;  // inside the map's room, for symbols on the rim
  const bool beside = page.width >= kSideBySide;
  page.title_baseline = page.margin + font_size;
  page.room_left = page.margin;
  page.room_top = std::round(scene.title.empty() ? page.margin : page.margin + 2.4 * font_size);
  page.room_width = page.width - 2 * page.margin - (beside ? legend.width() + page.margin : 0);
  page.frame.ground = ground_of(scene.tin);
  const double width = page.room_width - 2 * padding;
  page.frame.pixels_per_unit =
      std::min(width / page.frame.ground.width(), kTallest * width / page.frame.ground.height());
  const double map_height = page.frame.height() + 2 * padding;
  page.room_height = std::round(beside ? std::max(map_height, legend.height()) : map_height);
  page.frame.left = std::round(page.room_left + (page.room_width - page.frame.width()) / 2);
  page.frame.top = std::round(page.room_top + (page.room_height - page.frame.height()) / 2);
  page.scale_bar_middle = page.room_top + page.room_height + 1.4 * font_size;
  page.legend_left = beside ? page.room_left + page.room_width + page.margin : page.margin;
  page.legend_top = beside ? page.room_top : page.scale_bar_middle + 2 * font_size;
  const double below = beside ? page.scale_bar_middle + font_size : page.legend_top + legend.height();
  page.height = std::ceil(below + page.margin);
  return page;
}

Surface to_surface(const ReliefImage& image) {
  Surface surface(cairo_image_surface_create(CAIRO_FORMAT_ARGB32, image.width, image.height));
  unsigned char* const data = cairo_image_surface_get_data(surface.get());
  if (data == nullptr)
    throw Error(ErrorCode::OutOfMemory, "not enough memory for the picture; make it narrower");
  const auto stride = static_cast<std::size_t>(cairo_image_surface_get_stride(surface.get()));
  const std::size_t row_bytes = sizeof(std::uint32_t) * static_cast<std::size_t>(image.width);
  for (int row = 0; row < image.height; ++row) {
    const std::uint32_t* const pixels = image.pixels.data() + static_cast<std::size_t>(row) * image.width;
    std::memcpy(data + static_cast<std::size_t>(row) * stride, pixels, row_bytes);
  }
  cairo_surface_mark_dirty(surface.get());
  return surface;
}

class Picture {
 public:
  Picture(const PictureScene& scene, const ReliefStyle& style, const Legend& legend, const PageLayout& page,
          PictureFormat format, Progress& progress)
      : scene_(scene), style_(style), legend_(legend), page_(page), format_(format), progress_(progress) {}

  void draw(Canvas& canvas) {
    canvas.fill_box(0, 0, page_.width, page_.height, MapColours::kPaper);
    draw_title(canvas);
    canvas.fill_box(page_.room_left, page_.room_top, page_.room_width, page_.room_height,
                    MapColours::kMapGround);
    const bool outlines_in_image = format_ != PictureFormat::Png && many_outlines();
    draw_relief_image(canvas, outlines_in_image);
    if (!outlines_in_image) draw_triangle_edges(canvas, scene_, page_.frame, unit(), progress_);
    draw_lines_and_pits(canvas, scene_, page_.frame, unit(), progress_);
    canvas.stroke_box(page_.room_left, page_.room_top, page_.room_width, page_.room_height,
                      MapColours::kQuietInk, 0.06 * page_.font_size);
    legend_.draw(canvas, page_.legend_left, page_.legend_top);
    draw_footer(canvas);
  }

 private:
  [[nodiscard]] double unit() const { return page_.font_size / 10; }

  [[nodiscard]] bool many_outlines() const {
    constexpr std::size_t kMost = 20000;  // 1 MB of SVG
    return count_visible_edges(scene_, page_.frame) + scene_.flipped.size() > kMost;
  }

  void draw_title(Canvas& canvas) const {
    if (scene_.title.empty()) return;
    canvas.set_font(1.35 * page_.font_size, Weight::Bold);
    canvas.text(page_.margin, page_.title_baseline,
                canvas.fitted(printable(scene_.title), page_.width - 2 * page_.margin), MapColours::kInk);
  }

  void draw_relief_image(Canvas& canvas, bool outlines_in_image) {
    const double resolution = format_ == PictureFormat::Png ? 1 : 2;
    const double pixels_per_unit = page_.frame.pixels_per_unit * resolution;
    MapFrame frame{page_.frame.ground, 0, 0, pixels_per_unit};
    const int width = std::max(1, static_cast<int>(std::ceil(frame.width())));
    const int height = std::max(1, static_cast<int>(std::ceil(frame.height())));
    frame.ground.x_max = frame.ground.x_min + width / pixels_per_unit;
    frame.ground.y_min = frame.ground.y_max - height / pixels_per_unit;
    const Surface surface = to_surface(draw_relief(scene_.tin, style_, frame, width, height, progress_));
    if (outlines_in_image) {
      Canvas over(surface.get());
      draw_triangle_edges(over, scene_, frame, unit() * resolution, progress_);
    }
    cairo_t* const cairo = canvas.cairo();
    cairo_save(cairo);
    cairo_translate(cairo, page_.frame.left, page_.frame.top);
    cairo_scale(cairo, 1 / resolution, 1 / resolution);
    cairo_set_source_surface(cairo, surface.get(), 0, 0);
    cairo_pattern_set_filter(cairo_get_source(cairo),
                             resolution == 1 ? CAIRO_FILTER_NEAREST : CAIRO_FILTER_GOOD);
    cairo_paint(cairo);
    cairo_restore(cairo);
  }

  void draw_footer(Canvas& canvas) const {
    const double font_size = page_.font_size;
    const double metres_per_pixel = scene_.horizontal_metres_per_unit / page_.frame.pixels_per_unit;
    draw_scale_bar(canvas, page_.room_left, page_.scale_bar_middle, page_.room_width / 4, metres_per_pixel,
                   font_size);
    std::string note = "Light from the north-west";
    if (style_.exaggeration() > 1) note += ", heights \u00d7" + format_number(style_.exaggeration(), 1);
    canvas.set_font(0.9 * font_size, Weight::Normal);
    const double right = page_.room_left + page_.room_width;
    note = canvas.fitted(note, page_.room_width / 2);
    canvas.text(right - canvas.text_width(note), page_.scale_bar_middle + 0.35 * font_size, note,
                MapColours::kQuietInk);
  }

  const PictureScene& scene_;
  const ReliefStyle& style_;
  const Legend& legend_;
  const PageLayout& page_;
  PictureFormat format_;
  Progress& progress_;
};

Surface create_surface(PictureFormat format, const PageLayout& page, SurfaceFile& file) {
  switch (format) {
    case PictureFormat::Png:
      return Surface(cairo_image_surface_create(CAIRO_FORMAT_RGB24, static_cast<int>(page.width),
                                                static_cast<int>(page.height)));
    case PictureFormat::Svg:
      return Surface(cairo_svg_surface_create_for_stream(SurfaceFile::write, &file, page.width, page.height));
    case PictureFormat::Pdf:
      break;
  }
  Surface surface(cairo_pdf_surface_create_for_stream(SurfaceFile::write, &file, page.width, page.height));
  // A fixed date: equal input gives equal bytes.
  cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_CREATE_DATE, "2000-01-01T00:00:00Z");
  return surface;
}

}  // namespace

void draw_picture(const std::string& path, const std::string& extension, const PictureScene& scene,
                  Progress& progress) {
  constexpr double kSmallestFont = 9;
  constexpr double kFontsAcross = 100;
  const PictureFormat format = parse_extension(extension);
  check_scene(scene);
  const std::string& target = scene.target.empty() ? path : scene.target;
  const double font_size = std::max(kSmallestFont, scene.width_px / kFontsAcross);
  const ReliefStyle style(scene);
  const Surface sheet(cairo_image_surface_create(CAIRO_FORMAT_A8, 1, 1));
  Canvas measure(sheet.get());
  const Legend legend(measure, scene, style, font_size);
  const PageLayout page = lay_out(scene, legend, font_size);

  SurfaceFile file(path, target);
  const Surface surface = create_surface(format, page, file);
  Picture picture(scene, style, legend, page, format, progress);
  cairo_status_t status = CAIRO_STATUS_SUCCESS;
  {
    Canvas canvas(surface.get());
    picture.draw(canvas);
    status = cairo_status(canvas.cairo());
  }
  if (status == CAIRO_STATUS_SUCCESS && format == PictureFormat::Png) {
    status = cairo_surface_write_to_png_stream(surface.get(), SurfaceFile::write, &file);
  }
  cairo_surface_finish(surface.get());
  if (status == CAIRO_STATUS_SUCCESS) status = cairo_surface_status(surface.get());
  file.close(status, target);
  progress.advance(1);
}

std::span<const FormatInfo> picture_formats() {
  static const std::vector<FormatInfo> formats = {{"PNG", "Picture, pixels", {".png"}, false, true, {}},
                                                  {"SVG", "Picture, vectors", {".svg"}, false, true, {}},
                                                  {"PDF", "Picture, one page", {".pdf"}, false, true, {}}};
  return formats;
}

}  // namespace thalweg
