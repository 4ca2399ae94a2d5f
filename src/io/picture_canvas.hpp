#pragma once

/// Drawing on a page: Cairo with colours, text that fits, and errors as exceptions.

#include <thalweg/geometry/point.hpp>

#include <cairo.h>

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

namespace thalweg {

struct Colour {
  double red = 0, green = 0, blue = 0, alpha = 1;
  [[nodiscard]] constexpr Colour with_alpha(double a) const { return {red, green, blue, a}; }
};

/// 0xRRGGBB
constexpr Colour rgb(std::uint32_t hex) {
  constexpr double kFull = 255;
  return {(hex >> 16U & 0xffU) / kFull, (hex >> 8U & 0xffU) / kFull, (hex & 0xffU) / kFull, 1};
}

enum class Weight : std::uint8_t { Normal, Bold };

/// A page to draw on. Unit: one pixel (point) of the page, y down.
class Canvas {
 public:
  explicit Canvas(cairo_surface_t* surface) : cairo_(cairo_create(surface)) {}
  [[nodiscard]] cairo_t* cairo() const { return cairo_.get(); }

  void fill_box(double left, double top, double width, double height, Colour colour);
  void stroke_box(double left, double top, double width, double height, Colour colour, double line_width);
  void stroke_line(Point2 from, Point2 to, Colour colour, double line_width);
  /// Joined lines through all points.
  void stroke_path(std::span<const Point2> points, Colour colour, double line_width);
  void disc(Point2 centre, double radius, Colour colour);
  void ring(Point2 centre, double radius, Colour colour, double line_width);
  /// Collects polygons; `fill` fills them all at once, so that no seam shows between neighbours.
  void add_polygon(std::span<const Point2> corners) const;
  void fill(Colour colour);

  /// While it lives, nothing is drawn outside a box.
  class Clip {
   public:
    Clip(Canvas& canvas, double left, double top, double width, double height);
    ~Clip();
    Clip(const Clip&) = delete;
    Clip& operator=(const Clip&) = delete;

   private:
    Canvas& canvas_;
  };

  void set_font(double size, Weight weight) const;
  [[nodiscard]] double text_width(const std::string& text) const;
  /// Puts text with its left end at x and its baseline at y.
  void text(double x, double y, const std::string& text, Colour colour);
  /// The text itself if it is no wider than `width`, else its beginning and an ellipsis.
  [[nodiscard]] std::string fitted(const std::string& text, double width) const;

 private:
  struct Destroy {
    void operator()(cairo_t* cairo) const { cairo_destroy(cairo); }
  };
  void set_colour(Colour c) const { cairo_set_source_rgba(cairo(), c.red, c.green, c.blue, c.alpha); }

  std::unique_ptr<cairo_t, Destroy> cairo_;
};

/// Valid UTF-8 without control characters: what is not becomes '?'. (Cairo stops drawing at an invalid text.)
std::string printable(const std::string& text);

/// The largest of 1, 2, 5 times a power of ten that is no larger than `value`. Pre: value > 0 and finite.
double round_down_nicely(double value);

/// "0.25", "1 500": as few decimals as `step` needs, thin spaces between thousands.
std::string format_number(double value, double step);

}  // namespace thalweg
