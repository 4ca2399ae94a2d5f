// The legend: rows are listed and measured first, then drawn, so that nothing can overlap.
#include "io/picture_legend.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

namespace thalweg {

namespace {

constexpr double kGap = 0.7;  // between symbol, label and count, in font sizes

// The smallest of 1, 2, 5 times a power of ten that is no smaller than `value`.
double round_up_nicely(double value) {
  const double down = round_down_nicely(value);
  return down >= value ? down : round_down_nicely(down * 2.5);
}

std::string count_text(std::size_t count) {
  return format_number(static_cast<double>(count), 1);
}

void add_mesh_rows(std::vector<LegendRow>& rows, const PictureScene& scene) {
  const MapCounts counts = count_things(scene);
  rows.push_back({LegendSymbol::None, "Vertices", count_text(scene.tin.vertex_count())});
  rows.push_back({LegendSymbol::Outline, "Triangles", count_text(scene.tin.triangle_count())});
  const std::span<const LineStyle> styles = line_styles();
  for (std::size_t i = styles.size(); i-- > 0;) {
    if (counts.edges[i] > 0)
      rows.push_back({LegendSymbol::Line, styles[i].label, count_text(counts.edges[i]), styles[i]});
  }
}

}  // namespace

std::vector<LegendRow> legend_rows(const PictureScene& scene) {
  std::vector<LegendRow> rows;
  add_mesh_rows(rows, scene);
  const MapCounts counts = count_things(scene);
  if (!scene.flipped.empty())
    rows.push_back({LegendSymbol::Flipped, "Flipped diagonals", count_text(scene.flipped.size())});
  if (!scene.pits_before.empty())
    rows.push_back({LegendSymbol::PitBefore, "Pits before", count_text(counts.pits_before)});
  if (!scene.pits_after.empty())
    rows.push_back({LegendSymbol::PitAfter, "Pits after", count_text(counts.pits_after)});
  return rows;
}

std::vector<LegendRow> legend_rows(const ComparisonScene& scene) {
  std::vector<LegendRow> rows;
  add_mesh_rows(rows, scene.after);
  const MapCounts before = count_things(scene.before);
  const MapCounts after = count_things(scene.after);
  rows.push_back({LegendSymbol::Flipped, "Flipped diagonals", count_text(scene.after.flipped.size())});
  rows.push_back({LegendSymbol::PitBefore, "Pits removed", count_text(before.pits_before)});
  rows.push_back({LegendSymbol::PitAfter, "Pits left", count_text(after.pits_after)});
  rows.push_back({LegendSymbol::PitNew, "New pits", count_text(after.pits_new)});
  return rows;
}

Legend::Legend(std::vector<LegendRow> rows, double vertical_metres_per_unit, const ReliefStyle& style,
               double font_size)
    : style_(style), font_size_(font_size), rows_(std::move(rows)) {
  list_ticks(vertical_metres_per_unit);
  const std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)> sheet(
      cairo_image_surface_create(CAIRO_FORMAT_A8, 1, 1), &cairo_surface_destroy);
  Canvas canvas(sheet.get());  // only to measure texts
  canvas.set_font(font_size, Weight::Normal);
  double labels = 0, counts = 0, heights = 0;
  for (const LegendRow& row : rows_) {
    labels = std::max(labels, canvas.text_width(row.label));
    counts = std::max(counts, canvas.text_width(row.count));
  }
  for (const Tick& tick : ticks_) heights = std::max(heights, canvas.text_width(tick.label));
  canvas.set_font(font_size, Weight::Bold);
  const double heading = canvas.text_width("Elevation (m)");
  width_ = std::max({symbol_width() + labels + counts + (1 + 2 * kGap) * font_size, heading,
                     symbol_width() + kGap * font_size + heights});
}

void Legend::list_ticks(double vertical_metres_per_unit) {
  constexpr double kMostTicks = 6;
  const double low = style_.z_low() * vertical_metres_per_unit;
  const double high = style_.z_high() * vertical_metres_per_unit;
  if (!(high > low)) {
    ticks_.push_back({0.5, format_number(low, 0.01)});
    return;
  }
  const double step = round_up_nicely((high - low) / kMostTicks);
  const double first = std::ceil(low / step - 1e-9);
  for (double i = 0; (first + i) * step <= high + 1e-9 * step && i <= 2 * kMostTicks; ++i) {
    const double z = (first + i) * step;
    ticks_.push_back({std::clamp((z - low) / (high - low), 0.0, 1.0), format_number(z, step)});
  }
}

double Legend::height() const {
  return 1.6 * font_size_ + ramp_height() + 1.4 * font_size_ +
         static_cast<double>(rows_.size()) * row_height();
}

void Legend::draw(Canvas& canvas, double left, double top) const {
  canvas.set_font(font_size_, Weight::Bold);
  canvas.text(left, top + 0.8 * font_size_, "Elevation (m)", MapColours::kInk);
  draw_ramp(canvas, left, top + 1.6 * font_size_);
  canvas.set_font(font_size_, Weight::Normal);
  double middle = top + 1.6 * font_size_ + ramp_height() + 1.4 * font_size_ + row_height() / 2;
  for (const LegendRow& row : rows_) {
    const double baseline = middle + 0.35 * font_size_;
    draw_symbol(canvas, row, left, middle);
    canvas.text(left + symbol_width() + kGap * font_size_, baseline, row.label, MapColours::kInk);
    canvas.text(left + width_ - canvas.text_width(row.count), baseline, row.count, MapColours::kQuietInk);
    middle += row_height();
  }
}

void Legend::draw_ramp(Canvas& canvas, double left, double top) const {
  constexpr int kSteps = 200;
  const double width = symbol_width() * 0.75;
  const double step = ramp_height() / kSteps;
  for (int i = 0; i < kSteps; ++i) {
    const double position = (kSteps - 1 - i + 0.5) / kSteps;
    // Half a step of overlap: no paper shows through between the steps.
    canvas.fill_box(left, top + i * step, width, i + 1 == kSteps ? step : 1.5 * step, style_.tint(position));
  }
  canvas.stroke_box(left, top, width, ramp_height(), MapColours::kQuietInk, 0.06 * font_size_);
  canvas.set_font(font_size_, Weight::Normal);
  for (const Tick& tick : ticks_) {
    const double y = top + (1 - tick.position) * ramp_height();
    const double x = left + width;
    canvas.stroke_line({x, y}, {x + 0.35 * font_size_, y}, MapColours::kQuietInk, 0.07 * font_size_);
    canvas.text(left + symbol_width() + 0.1 * font_size_, y + 0.35 * font_size_, tick.label,
                MapColours::kInk);
  }
}

void Legend::draw_symbol(Canvas& canvas, const LegendRow& row, double left, double middle) const {
  const double unit = font_size_ / 10;
  const double right = left + symbol_width() * 0.85;
  const double centre = (left + right) / 2;
  switch (row.symbol) {
    case LegendSymbol::None:
      return;
    case LegendSymbol::Line:
      canvas.stroke_line({left, middle}, {right, middle}, row.line.colour, 1.6 * row.line.width * unit);
      return;
    case LegendSymbol::Flipped:
      canvas.stroke_line({left, middle}, {right, middle}, MapColours::kFlipped, 1.1 * unit);
      return;
    case LegendSymbol::Outline: {
      const double half = 0.55 * font_size_;
      const std::array<Point2, 4> corners = {{{centre - 1.3 * half, middle + 0.9 * half},
                                              {centre + 1.3 * half, middle + 0.9 * half},
                                              {centre, middle - half},
                                              {centre - 1.3 * half, middle + 0.9 * half}}};
      canvas.stroke_path(corners, MapColours::kTriangle.with_alpha(0.7), 0.7 * unit);
      return;
    }
    case LegendSymbol::PitBefore:
      draw_pit_before(canvas, {centre, middle}, 3.6 * unit);
      return;
    case LegendSymbol::PitAfter:
      draw_pit_after(canvas, {centre, middle}, 3.6 * unit);
      return;
    case LegendSymbol::PitNew:
      draw_pit_new(canvas, {centre, middle}, 3.6 * unit);
      return;
  }
}

void draw_scale_bar(Canvas& canvas, double left, double middle, double most, double metres_per_pixel,
                    double font_size) {
  constexpr double kKilometre = 1000;
  const double metres = round_down_nicely(most * metres_per_pixel);
  const double length = metres / metres_per_pixel;
  const double height = 0.45 * font_size;
  const bool long_bar = metres >= kKilometre;
  const double shown = long_bar ? metres / kKilometre : metres;
  const std::string label = format_number(shown, shown) + (long_bar ? " km" : " m");
  canvas.fill_box(left, middle - height / 2, length, height, MapColours::kPaper);
  canvas.fill_box(left, middle - height / 2, length / 2, height, MapColours::kInk);
  canvas.stroke_box(left, middle - height / 2, length, height, MapColours::kInk, 0.08 * font_size);
  canvas.set_font(font_size, Weight::Normal);
  canvas.text(left + length + 0.6 * font_size, middle + 0.35 * font_size, label, MapColours::kInk);
}

}  // namespace thalweg
