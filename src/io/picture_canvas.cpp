// Drawing primitives.
#include "io/picture_canvas.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

namespace thalweg {

void Canvas::fill_box(double left, double top, double width, double height, Colour colour) {
  set_colour(colour);
  cairo_rectangle(cairo(), left, top, width, height);
  cairo_fill(cairo());
}

void Canvas::stroke_box(double left, double top, double width, double height, Colour colour,
                        double line_width) {
  set_colour(colour);
  cairo_set_line_width(cairo(), line_width);
  cairo_rectangle(cairo(), left, top, width, height);
  cairo_stroke(cairo());
}

void Canvas::stroke_line(Point2 from, Point2 to, Colour colour, double line_width) {
  const std::array<Point2, 2> ends = {from, to};
  stroke_path(ends, colour, line_width);
}

void Canvas::stroke_path(std::span<const Point2> points, Colour colour, double line_width) {
  if (points.size() < 2) return;
  set_colour(colour);
  cairo_set_line_width(cairo(), line_width);
  cairo_set_line_join(cairo(), CAIRO_LINE_JOIN_ROUND);
  cairo_set_line_cap(cairo(), CAIRO_LINE_CAP_ROUND);
  cairo_move_to(cairo(), points[0].x, points[0].y);
  for (const Point2 p : points.subspan(1)) cairo_line_to(cairo(), p.x, p.y);
  cairo_stroke(cairo());
}

void Canvas::disc(Point2 centre, double radius, Colour colour) {
  set_colour(colour);
  cairo_arc(cairo(), centre.x, centre.y, radius, 0, 2 * std::numbers::pi);
  cairo_fill(cairo());
}

void Canvas::ring(Point2 centre, double radius, Colour colour, double line_width) {
  set_colour(colour);
  cairo_set_line_width(cairo(), line_width);
  cairo_new_sub_path(cairo());
  cairo_arc(cairo(), centre.x, centre.y, radius, 0, 2 * std::numbers::pi);
  cairo_close_path(cairo());
  cairo_stroke(cairo());
}

void Canvas::add_polygon(std::span<const Point2> corners) const {
  cairo_new_sub_path(cairo());
  for (const Point2 p : corners) cairo_line_to(cairo(), p.x, p.y);
  cairo_close_path(cairo());
}

void Canvas::fill(Colour colour) {
  set_colour(colour);
  cairo_fill(cairo());
}

Canvas::Clip::Clip(Canvas& canvas, double left, double top, double width, double height) : canvas_(canvas) {
  cairo_save(canvas_.cairo());
  cairo_rectangle(canvas_.cairo(), left, top, width, height);
  cairo_clip(canvas_.cairo());
}

Canvas::Clip::~Clip() {
  cairo_restore(canvas_.cairo());
}

void Canvas::set_font(double size, Weight weight) const {
  cairo_select_font_face(cairo(), "sans-serif", CAIRO_FONT_SLANT_NORMAL,
                         weight == Weight::Bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(cairo(), size);
}

double Canvas::text_width(const std::string& text) const {
  cairo_text_extents_t extents;
  cairo_text_extents(cairo(), text.c_str(), &extents);
  return extents.x_advance;
}

void Canvas::text(double x, double y, const std::string& text, Colour colour) {
  set_colour(colour);
  cairo_move_to(cairo(), x, y);
  cairo_show_text(cairo(), text.c_str());
  cairo_new_path(cairo());
}

std::string Canvas::fitted(const std::string& text, double width) const {
  if (text_width(text) <= width) return text;
  const std::string ellipsis = "\u2026";
  std::string start = text;
  while (!start.empty()) {
    // Drop one whole UTF-8 character.
    while (!start.empty() && (static_cast<unsigned char>(start.back()) & 0xc0U) == 0x80U) start.pop_back();
    if (!start.empty()) start.pop_back();
    while (!start.empty() && start.back() == ' ') start.pop_back();
    if (text_width(start + ellipsis) <= width) return start + ellipsis;
  }
  return ellipsis;
}

namespace {

// Length of the valid UTF-8 character that starts the text, or 0.
std::size_t utf8_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char first = byte(0);
  const std::size_t length = first < 0x80   ? 1
                             : first < 0xc2 ? 0
                             : first < 0xe0 ? 2
                             : first < 0xf0 ? 3
                             : first < 0xf5 ? 4
                                            : 0;
  if (length == 0 || length > text.size()) return 0;
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xc0U) != 0x80U) return 0;
  }
  if (length < 3) return length;
  const bool overlong = (first == 0xe0 && byte(1) < 0xa0) || (first == 0xf0 && byte(1) < 0x90);
  const bool outside = (first == 0xed && byte(1) > 0x9f) || (first == 0xf4 && byte(1) > 0x8f);
  return overlong || outside ? 0 : length;
}

}  // namespace

std::string printable(const std::string& text) {
  std::string clean;
  for (std::string_view rest = text; !rest.empty();) {
    const std::size_t length = utf8_length(rest);
    const bool control = length == 1 && (static_cast<unsigned char>(rest[0]) < 0x20 || rest[0] == 0x7f);
    if (length == 0 || control)
      clean += '?';
    else
      clean += rest.substr(0, length);
    rest.remove_prefix(std::max<std::size_t>(length, 1));
  }
  return clean;
}

double round_down_nicely(double value) {
  const double power = std::pow(10, std::floor(std::log10(value)));
  for (const double digit : {5.0, 2.0}) {
    if (digit * power <= value) return digit * power;
  }
  return power;
}

std::string format_number(double value, double step) {
  const int decimals = std::clamp(static_cast<int>(std::ceil(-std::log10(step) - 1e-9)), 0, 9);
  constexpr std::size_t kLongest = 400;
  std::array<char, kLongest> text{};
  std::snprintf(text.data(), text.size(), "%.*f", decimals, value == 0 ? 0.0 : std::abs(value));
  std::string digits = text.data();
  const std::size_t whole = std::min(digits.find('.'), digits.size());
  for (std::size_t i = whole; i > 3 && whole > 4; i -= 3) digits.insert(i - 3, i > 3 ? "\u2009" : "");
  if (digits.rfind("\u2009", 0) == 0) digits.erase(0, std::string("\u2009").size());
  return (value < 0 ? "\u2212" : "") + digits;
}

}  // namespace thalweg
