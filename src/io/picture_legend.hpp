#pragma once

/// The legend of a picture: colours of heights, symbols with their counts, scale bar.

#include "io/picture_map.hpp"

#include <string>
#include <vector>

namespace thalweg {

enum class LegendSymbol : std::uint8_t { None, Line, Flipped, Outline, PitBefore, PitAfter, PitNew };

struct LegendRow {
  LegendSymbol symbol = LegendSymbol::None;
  std::string label;
  std::string count;
  LineStyle line = {};
};

/// The rows of a map, of two maps side by side.
std::vector<LegendRow> legend_rows(const PictureScene& scene);
std::vector<LegendRow> legend_rows(const ComparisonScene& scene);

/// A column of the ramp of heights and of rows with symbol, label and count. Knows its size before it is
/// drawn.
class Legend {
 public:
  /// Sizes follow `font_size`.
  Legend(std::vector<LegendRow> rows, double vertical_metres_per_unit, const ReliefStyle& style,
         double font_size);
  [[nodiscard]] double width() const { return width_; }
  [[nodiscard]] double height() const;
  void draw(Canvas& canvas, double left, double top) const;

 private:
  struct Tick {
    double position;  ///< 0 at the low end of the ramp, 1 at the high end
    std::string label;
  };
  void list_ticks(double vertical_metres_per_unit);
  void draw_ramp(Canvas& canvas, double left, double top) const;
  void draw_symbol(Canvas& canvas, const LegendRow& row, double left, double middle) const;
  [[nodiscard]] double row_height() const { return 1.65 * font_size_; }
  [[nodiscard]] double symbol_width() const { return 2.4 * font_size_; }
  [[nodiscard]] double ramp_height() const { return 13 * font_size_; }

  const ReliefStyle& style_;
  double font_size_;
  double width_ = 0;
  std::vector<LegendRow> rows_;
  std::vector<Tick> ticks_;
};

/// Draws a scale bar of a round length, at most `most` pixels long, with its left end at (left, middle).
void draw_scale_bar(Canvas& canvas, double left, double middle, double most, double metres_per_pixel,
                    double font_size);

}  // namespace thalweg
