// Pages and maps.
//
// 1. Cairo draws into a surface of the format; what it writes passes through a file writer of ours, so that a
//    full disk is an error.
// 2. The relief is always an image, of twice the page's resolution in SVG and PDF. Outlines of triangles are
//    lines over it, or a part of it where they would make a vector file unwieldy.
#include "io/picture_page.hpp"

#include "base/lower_case.hpp"
#include "io/file_writer.hpp"
#include "io/picture_legend.hpp"

#include <thalweg/base/error.hpp>

#include <cairo-pdf.h>
#include <cairo-svg.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <exception>
#include <memory>
#include <optional>

namespace thalweg {

PictureFormat parse_picture_extension(const std::string& extension) {
  const std::string name = lower(extension);
  if (name == ".png") return PictureFormat::Png;
  if (name == ".svg") return PictureFormat::Svg;
  if (name == ".pdf") return PictureFormat::Pdf;
  throw Error(ErrorCode::Usage,
              "'" + extension + "' is no extension of a picture; known are .png, .svg and .pdf");
}

void check_width(int width_px) {
  constexpr int kNarrowest = 400;
  constexpr int kWidest = 8000;
  if (width_px < kNarrowest || width_px > kWidest) {
    throw Error(ErrorCode::Usage, "a picture of " + std::to_string(width_px) +
                                      " pixels' width; it can be from " + std::to_string(kNarrowest) +
                                      " to " + std::to_string(kWidest));
  }
}

void check_scene(const PictureScene& scene) {
  check_width(scene.width_px);
  if (scene.tin.triangle_count() == 0)
    throw Error(ErrorCode::EmptyInput, "a TIN without triangles has no picture");
  const std::size_t vertices = scene.tin.vertex_count();
  for (const std::span<const std::uint8_t> pits : {scene.pits_before, scene.pits_after, scene.pits_new}) {
    if (!pits.empty() && pits.size() != vertices) {
      throw Error(ErrorCode::Internal, "the pits of a picture do not fit its vertices");
    }
  }
}

namespace {

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

Surface create_surface(PageSize page, SurfaceFile& file) {
  switch (page.format) {
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

bool many_outlines(const PictureScene& scene, const MapFrame& frame) {
  constexpr std::size_t kMost = 20000;  // 1 MB of SVG
  return count_visible_edges(scene, frame) + scene.flipped.size() > kMost;
}

void draw_relief_image(Canvas& canvas, const PictureScene& scene, const ReliefStyle& style,
                       const MapPanel& panel, double resolution, bool outlines_in_image, Progress& progress) {
  const double pixels_per_unit = panel.frame.pixels_per_unit * resolution;
  MapFrame frame{panel.frame.ground, 0, 0, pixels_per_unit};
  const int width = std::max(1, static_cast<int>(std::ceil(frame.width())));
  const int height = std::max(1, static_cast<int>(std::ceil(frame.height())));
  frame.ground.x_max = frame.ground.x_min + width / pixels_per_unit;
  frame.ground.y_min = frame.ground.y_max - height / pixels_per_unit;
  const Surface surface = to_surface(draw_relief(scene.tin, style, frame, width, height, progress));
  if (outlines_in_image) {
    Canvas over(surface.get());
    draw_triangle_edges(over, scene, frame, panel.font_size / 10 * resolution, progress);
  }
  cairo_t* const cairo = canvas.cairo();
  cairo_save(cairo);
  cairo_translate(cairo, panel.frame.left, panel.frame.top);
  cairo_scale(cairo, 1 / resolution, 1 / resolution);
  cairo_set_source_surface(cairo, surface.get(), 0, 0);
  cairo_pattern_set_filter(cairo_get_source(cairo),
                           resolution == 1 ? CAIRO_FILTER_NEAREST : CAIRO_FILTER_GOOD);
  cairo_paint(cairo);
  cairo_restore(cairo);
}

}  // namespace

void write_page(const std::string& path, const std::string& target, PageSize page,
                const std::function<void(Canvas&)>& draw) {
  SurfaceFile file(path, target);
  const Surface surface = create_surface(page, file);
  cairo_status_t status = CAIRO_STATUS_SUCCESS;
  {
    Canvas canvas(surface.get());
    draw(canvas);
    status = cairo_status(canvas.cairo());
  }
  if (status == CAIRO_STATUS_SUCCESS && page.format == PictureFormat::Png) {
    status = cairo_surface_write_to_png_stream(surface.get(), SurfaceFile::write, &file);
  }
  cairo_surface_finish(surface.get());
  if (status == CAIRO_STATUS_SUCCESS) status = cairo_surface_status(surface.get());
  file.close(status, target);
}

Box2 ground_of(const Tin& tin) {
  Box2 box;
  for (const Triangle& t : tin.triangles()) {
    for (const VertexId v : t) box.add(tin.point(v));
  }
  return box;
}

void fit_ground(MapPanel& panel, const Box2& ground, double tallest, double least_height) {
  const double padding = panel.font_size;  // for symbols on the rim
  panel.frame.ground = ground;
  const double width = panel.width - 2 * padding;
  panel.frame.pixels_per_unit = std::min(width / ground.width(), tallest * width / ground.height());
  panel.height = std::round(std::max(panel.frame.height() + 2 * padding, least_height));
  panel.frame.left = std::round(panel.left + (panel.width - panel.frame.width()) / 2);
  panel.frame.top = std::round(panel.top + (panel.height - panel.frame.height()) / 2);
}

void draw_map(Canvas& canvas, const PictureScene& scene, const ReliefStyle& style, const MapPanel& panel,
              PictureFormat format, Progress& progress) {
  const double unit = panel.font_size / 10;
  canvas.fill_box(panel.left, panel.top, panel.width, panel.height, MapColours::kMapGround);
  const bool outlines_in_image = format != PictureFormat::Png && many_outlines(scene, panel.frame);
  draw_relief_image(canvas, scene, style, panel, format == PictureFormat::Png ? 1 : 2, outlines_in_image,
                    progress);
  if (!outlines_in_image) draw_triangle_edges(canvas, scene, panel.frame, unit, progress);
  draw_lines_and_pits(canvas, scene, panel.frame, unit, progress);
  canvas.stroke_box(panel.left, panel.top, panel.width, panel.height, MapColours::kQuietInk, 0.6 * unit);
}

void draw_footer(Canvas& canvas, const PictureScene& scene, const ReliefStyle& style, const MapPanel& panel,
                 double middle, double width) {
  const double font_size = panel.font_size;
  const double metres_per_pixel = scene.horizontal_metres_per_unit / panel.frame.pixels_per_unit;
  draw_scale_bar(canvas, panel.left, middle, panel.width / 4, metres_per_pixel, font_size);
  std::string note = "Light from the north-west";
  if (style.exaggeration() > 1) note += ", heights \u00d7" + format_number(style.exaggeration(), 1);
  canvas.set_font(0.9 * font_size, Weight::Normal);
  note = canvas.fitted(note, width / 2);
  canvas.text(panel.left + width - canvas.text_width(note), middle + 0.35 * font_size, note,
              MapColours::kQuietInk);
}

}  // namespace thalweg
