// Exact questions, each first put to interval arithmetic (or to doubles with an error bound), and to rational
// numbers only where that does not decide.
//
// Cell against segment: with d = b - a and h the cell's half sides, the line meets the closed cell about c if
// and only if |cross(d, c - a)| <= h.x |d.y| + h.y |d.x|. If c's projection is inside the segment by more
// than (h.x |d.x| + h.y |d.y|) / |d|, the line's part in the cell is part of the segment. A segment with an
// end inside the cell meets it. What is left is clipped exactly: parameters t with 0 <= t <= 1 and
// low <= a + t d < high.
#include "segments.hpp"

#include <CGAL/Exact_rational.h>
#include <CGAL/Interval_nt.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace thalweg {

namespace {

using Interval = CGAL::Interval_nt<false>;
using Rational = CGAL::Exact_rational;

// Bounds the rounding of a cross or dot product of coordinate differences, relative to the sum of the
// products' magnitudes: (3 + 16 e) e by Shewchuk, Adaptive Precision Floating-Point Arithmetic, 1997, and
// some room.
constexpr double kProductError = 0x1p-50;
// Products above this have lost nothing to underflow that the error bounds do not cover.
constexpr double kNoUnderflow = 1e-270;

// The parameters of a segment in a cell: those above `low` and below `high`, ends in or out.
struct Clip {
  Rational low{0};
  Rational high{1};
  bool low_open = false;
  bool high_open = false;
  bool never = false;

  void raise(const Rational& t, bool open) {
    if (t > low || (t == low && open)) {
      low = t;
      low_open = open;
    }
  }
  void lower(const Rational& t, bool open) {
    if (t < high || (t == high && open)) {
      high = t;
      high_open = open;
    }
  }
  [[nodiscard]] bool empty() const { return never || low > high || (low == high && (low_open || high_open)); }
};

void clip_axis(Clip& clip, double from, double to, double centre, double half) {
  const Rational start(from);
  const Rational step = Rational(to) - start;
  const Rational first = Rational(centre) - Rational(half) - start;
  const Rational beyond = Rational(centre) + Rational(half) - start;
  if (step == 0) {
    clip.never = clip.never || first > 0 || beyond <= 0;
  } else if (step > 0) {
    clip.raise(first / step, false);
    clip.lower(beyond / step, true);
  } else {
    clip.raise(beyond / step, true);
    clip.lower(first / step, false);
  }
}

Clip clip_to_cell(const Segment& s, const Cell& cell) {
  Clip clip;
  clip_axis(clip, s.a.x, s.b.x, cell.centre.x, cell.half_x);
  clip_axis(clip, s.a.y, s.b.y, cell.centre.y, cell.half_y);
  return clip;
}

// Only where it does: rounding keeps order, so a rounded difference below a double is one before rounding.
bool holds_inside(const Cell& cell, Point2 p) {
  return std::abs(p.x - cell.centre.x) < cell.half_x && std::abs(p.y - cell.centre.y) < cell.half_y;
}

template <class Number>
struct Place {
  Number x;
  Number y;
};

template <class Number>
Place<Number> crossing(const Segment& s, const Segment& t) {
  const Number sx = Number(s.b.x) - Number(s.a.x), sy = Number(s.b.y) - Number(s.a.y);
  const Number tx = Number(t.b.x) - Number(t.a.x), ty = Number(t.b.y) - Number(t.a.y);
  const Number x = Number(t.a.x) - Number(s.a.x), y = Number(t.a.y) - Number(s.a.y);
  const Number along = (x * ty - y * tx) / (sx * ty - sy * tx);
  return {Number(s.a.x) + along * sx, Number(s.a.y) + along * sy};
}

template <class Number>
auto within(const Place<Number>& p, const Cell& cell) {
  const Number x = p.x - Number(cell.centre.x);
  const Number y = p.y - Number(cell.centre.y);
  return (x >= Number(-cell.half_x)) & (x < Number(cell.half_x)) & (y >= Number(-cell.half_y)) &
         (y < Number(cell.half_y));
}

std::optional<bool> crosses_in_cell_filtered(const Segment& s, const Segment& t, const Cell& cell) {
  const Interval::Protector protector;
  const CGAL::Uncertain<bool> answer = within(crossing<Interval>(s, t), cell);
  if (CGAL::is_certain(answer)) return CGAL::get_certain(answer);
  return std::nullopt;
}

// The node, if all of the interval agrees and doubles are not farther apart than the grid's nodes.
std::optional<double> round_interval(const Interval& value, double grid) {
  const double low = std::floor((value / Interval(grid) + Interval(0.5)).inf());
  const double high = std::floor((value / Interval(grid) + Interval(0.5)).sup());
  constexpr double kDense = 0x1p52;
  if (low == high && std::abs(low) < kDense) return low * grid;
  return std::nullopt;
}

std::optional<Point2> round_crossing_filtered(const Segment& s, const Segment& t, double grid) {
  const Interval::Protector protector;
  const Place<Interval> p = crossing<Interval>(s, t);
  const auto x = round_interval(p.x, grid);
  const auto y = round_interval(p.y, grid);
  if (x && y) return Point2{*x, *y};
  return std::nullopt;
}

double round_exactly(const Rational& value, double grid) {
  const auto [below, above] = CGAL::to_interval(value);
  if (spacing_at(below) >= grid) {
    return value + value < Rational(below) + Rational(above) ? below : above;
  }
  const Rational shifted = value / Rational(grid) + Rational(0.5);
  double node = std::floor(CGAL::to_interval(shifted).second);
  while (Rational(node) > shifted) node -= 1;
  return node * grid;
}

}  // namespace

bool meets_cell(const Segment& s, const Cell& cell) {
  const double dx = s.b.x - s.a.x, dy = s.b.y - s.a.y;
  const double x = cell.centre.x - s.a.x, y = cell.centre.y - s.a.y;
  const double wide = cell.half_x * std::abs(dy) + cell.half_y * std::abs(dx);
  const double wide_error = kProductError * (std::abs(dx * y) + std::abs(dy * x) + wide);
  const double across = std::abs(dx * y - dy * x);
  if (wide > kNoUnderflow) {
    if (across > wide + wide_error) return false;
    const double along = dx * x + dy * y;
    const double squared = dx * dx + dy * dy;
    const double room = cell.half_x * std::abs(dx) + cell.half_y * std::abs(dy) +
                        kProductError * (std::abs(dx * x) + std::abs(dy * y) + squared);
    constexpr double kMore = 1 + 0x1p-40;
    if (across + wide_error < wide && along > kMore * room && squared - along > kMore * room) return true;
  }
  if (holds_inside(cell, s.a) || holds_inside(cell, s.b)) return true;
  return !clip_to_cell(s, cell).empty();
}

bool enters_before(const Segment& s, const Cell& first, const Cell& second) {
  // Entries are within half sides of their centres, so they are in the order of the centres' projections
  // where these differ by more than that.
  const double dx = s.b.x - s.a.x, dy = s.b.y - s.a.y;
  const double x = second.centre.x - first.centre.x, y = second.centre.y - first.centre.y;
  const double ahead = dx * x + dy * y;
  const double unsure =
      (first.half_x + second.half_x) * std::abs(dx) + (first.half_y + second.half_y) * std::abs(dy);
  if (unsure > kNoUnderflow) {
    const double error = kProductError * (std::abs(dx * x) + std::abs(dy * y) + unsure);
    if (std::abs(ahead) > unsure + error) return ahead > 0;
  }
  if (holds_inside(first, s.a) && holds_inside(second, s.a)) return first.centre < second.centre;
  const Rational enter_first = clip_to_cell(s, first).low;
  const Rational enter_second = clip_to_cell(s, second).low;
  return enter_first != enter_second ? enter_first < enter_second : first.centre < second.centre;
}

bool crosses_in_cell(const Segment& s, const Segment& t, const Cell& cell) {
  if (const auto answer = crosses_in_cell_filtered(s, t, cell)) return *answer;
  return within(crossing<Rational>(s, t), cell);
}

Point2 round_crossing(const Segment& s, const Segment& t, double grid) {
  if (const auto node = round_crossing_filtered(s, t, grid)) return *node;
  const Place<Rational> p = crossing<Rational>(s, t);
  return {round_exactly(p.x, grid), round_exactly(p.y, grid)};
}

}  // namespace thalweg
