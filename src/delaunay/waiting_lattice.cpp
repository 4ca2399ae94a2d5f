// Rows of a lattice in a triangle.
//
// 1. A lattice is what is left of the smallest steps between consecutive vertices (numbered along a curve or
//    row by row, neighbours mostly follow each other) when each column and each row has one coordinate.
// 2. In a row the triangle lies between two of its sides. Where they cross the row is computed in columns,
//    in doubles; within a fiftieth of a column, twice what uneven spacing can amount to, an exact test
//    decides instead, and only if the vertex there matters.
// 3. Distances are computed two at a time, by the same operations as for a single vertex, so they are the
//    same to the last bit. Which vertex is the farthest is looked for afterwards, in the row that has it.
#include "waiting_lattice.hpp"

#include <thalweg/geometry/predicates.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace thalweg::detail {

namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr double kUneven = 0.01;
constexpr double kDoubt = 0.02;

/// A side where it crosses rows, in columns.
struct Crossing {
  double column = 0, y = 0, slope = 0;
  bool level = false;
  [[nodiscard]] double at(double row_y) const { return column + (row_y - y) * slope; }
};

/// Two doubles in one register; what compilers for all machines make of it is the same to the last bit.
using Pair = double __attribute__((vector_size(16)));

Pair pair_at(const double* from) {
  Pair pair;
  std::memcpy(&pair, from, sizeof(pair));
  return pair;
}

/// Distances in one row.
struct RowPlane {
  RowPlane(std::span<const double> columns, double y, const double* heights, const HeightPlane& plane)
      : x(columns.data()),
        z(heights),
        origin_x(plane.origin.x),
        origin_z(plane.z),
        by_x(plane.by_x),
        rise(plane.by_y * (y - plane.origin.y)) {}
  const double* x;
  const double* z;
  double origin_x, origin_z, by_x, rise;
  [[nodiscard]] double error(std::size_t i) const {
    return std::abs(z[i] - (origin_z + (by_x * (x[i] - origin_x) + rise)));
  }
  /// Of i and i + 1.
  [[nodiscard]] Pair errors(std::size_t i) const {
    const Pair above = pair_at(z + i) - (origin_z + (by_x * (pair_at(x + i) - origin_x) + rise));
    return above < 0 ? -above : above;
  }
};

double largest(const RowPlane& row, std::size_t first, std::size_t end) {
  Pair most{-1, -1}, other = most;
  std::size_t i = first;
  for (; i + 4 <= end; i += 4) {
    const Pair error = row.errors(i), next = row.errors(i + 2);
    most = error > most ? error : most;
    other = next > other ? next : other;
  }
  most = most > other ? most : other;
  double result = std::max(most[0], most[1]);
  for (; i < end; ++i) {
    const double error = row.error(i);
    result = error > result ? error : result;
  }
  return result;
}

}  // namespace

bool OwningTriangle::holds(Point2 p) const {
  for (std::size_t i = 0; i < 3; ++i) {
    const int side = orientation(corner[(i + 1) % 3], corner[(i + 2) % 3], p);
    if (side < 0 || (side == 0 && (owned >> i & 1U) == 0)) return false;
  }
  return true;
}

std::optional<WaitingLattice::Axis> WaitingLattice::find_axis(std::span<const Point2> xy,
                                                              const std::vector<bool>& waits,
                                                              double Point2::*coordinate) {
  double low = std::numeric_limits<double>::infinity(), high = -low, step = low;
  double before = kNone;
  std::size_t count = 0;
  for (std::size_t v = 0; v < xy.size(); ++v) {
    if (!waits[v]) continue;
    ++count;
    const double here = xy[v].*coordinate;
    low = std::min(low, here);
    high = std::max(high, here);
    const double between = std::abs(here - before);
    if (between > 0 && between < step) step = between;
    before = here;
  }
  const double steps = (high - low) / step;
  if (!(steps >= 1) || steps > 4 * static_cast<double>(count)) return std::nullopt;
  const auto last = static_cast<std::size_t>(std::lround(steps));
  Axis axis{.at = std::vector<double>(last + 1, kNone), .by = static_cast<double>(last) / (high - low)};
  axis.at.front() = low;
  for (std::size_t v = 0; v < xy.size(); ++v) {
    if (!waits[v]) continue;
    const double here = xy[v].*coordinate;
    double& there = axis.at[axis.nearest(here)];
    if (std::isnan(there)) there = here;
    if (there != here) return std::nullopt;
  }
  for (std::size_t i = 0; i < axis.at.size(); ++i) {
    const double even = low + static_cast<double>(i) / axis.by;
    if (std::isnan(axis.at[i])) axis.at[i] = even;
    if (!(std::abs(axis.at[i] - even) * axis.by <= kUneven)) return std::nullopt;
  }
  return axis;
}

std::optional<WaitingLattice> WaitingLattice::find(std::span<const Point2> xy, std::span<const double> z,
                                                   const std::vector<bool>& waits) {
  WaitingLattice lattice;
  for (auto [axis, coordinate] :
       {std::pair{&lattice.columns_, &Point2::x}, std::pair{&lattice.rows_, &Point2::y}}) {
    auto found = find_axis(xy, waits, coordinate);
    if (!found) return std::nullopt;
    *axis = std::move(*found);
  }
  const std::size_t places = lattice.columns_.at.size() * lattice.rows_.at.size();
  if (places / 4 > static_cast<std::size_t>(std::count(waits.begin(), waits.end(), true))) {
    return std::nullopt;
  }
  lattice.z_.assign(places, kNone);
  lattice.vertex_.assign(places, kNoVertex);
  for (std::size_t v = 0; v < xy.size(); ++v) {
    if (!waits[v]) continue;
    const std::size_t at = lattice.index(lattice.rows_.nearest(xy[v].y), lattice.columns_.nearest(xy[v].x));
    lattice.z_[at] = z[v];
    lattice.vertex_[at] = static_cast<std::uint32_t>(v);
  }
  return lattice;
}

void WaitingLattice::take(Point2 p) {
  z_[index(rows_.nearest(p.y), columns_.nearest(p.x))] = kNone;
}

struct WaitingLattice::Row {
  std::size_t row = 0;
  std::size_t first = 0, end = 0;            ///< places that may be inside
  std::size_t sure_first = 0, sure_end = 0;  ///< of these, places that surely are
  [[nodiscard]] bool sure(std::size_t place) const { return place >= sure_first && place < sure_end; }
};

/// The rows of a triangle from below.
class WaitingLattice::Rows : public Row {
 public:
  Rows(const WaitingLattice& lattice, const OwningTriangle& triangle);
  /// Goes to the next row that may have a place.
  bool next();

 private:
  [[nodiscard]] Crossing crossing(Point2 below, Point2 above) const;
  [[nodiscard]] std::size_t column_after(double place) const;

  const Axis& columns_;
  const Axis& rows_;
  std::array<Crossing, 2> left_, right_;  ///< below and above the middle corner
  double middle_y_ = 0, least_ = 0, most_ = 0;
  bool flat_top_ = false;
  std::size_t next_ = 0, rows_end_ = 0;
};

WaitingLattice::Rows::Rows(const WaitingLattice& lattice, const OwningTriangle& triangle)
    : columns_(lattice.columns_), rows_(lattice.rows_) {
  const auto& corner = triangle.corner;
  std::size_t low = 0, high = 2;
  for (std::size_t i = 0; i < 3; ++i) {
    if (corner[i].y < corner[low].y) low = i;
    if (corner[i].y > corner[high].y) high = i;
  }
  const std::size_t middle = 3 - low - high;
  const Point2 lower = corner[low], between = corner[middle], upper = corner[high];
  const Crossing whole = crossing(lower, upper);
  const std::array<Crossing, 2> one{whole, whole}, two{crossing(lower, between), crossing(between, upper)};
  const bool middle_right = middle == (low + 1) % 3;
  left_ = middle_right ? one : two;
  right_ = middle_right ? two : one;
  middle_y_ = between.y;
  flat_top_ = between.y == upper.y;
  least_ = columns_.place(std::min({lower.x, between.x, upper.x})) - kDoubt;
  most_ = columns_.place(std::max({lower.x, between.x, upper.x})) + kDoubt;
  // A level side is a row of its own, where it is owned.
  const auto owned = [&](std::size_t side) { return (triangle.owned >> side & 1U) != 0; };
  const bool with_lower = lower.y == between.y && owned(high);
  const bool with_upper = flat_top_ && owned(low);
  const auto row_at = [&](double y) {
    return static_cast<std::size_t>(
        std::clamp(rows_.place(y) - kDoubt, 0.0, static_cast<double>(rows_.at.size())));
  };
  next_ = row_at(lower.y);
  rows_end_ = row_at(upper.y);
  const std::vector<double>& y = rows_.at;
  while (next_ < y.size() && (with_lower ? y[next_] < lower.y : y[next_] <= lower.y)) ++next_;
  while (rows_end_ < y.size() && (with_upper ? y[rows_end_] <= upper.y : y[rows_end_] < upper.y)) ++rows_end_;
}

// Rows closer than that to both ends of a side: rounding of the slope could matter.
Crossing WaitingLattice::Rows::crossing(Point2 below, Point2 above) const {
  constexpr double kLevel = 1e-6;
  const double rise = above.y - below.y;
  if (!(rise * rows_.by > kLevel)) return {.level = true};
  return {columns_.place(below.x), below.y, (above.x - below.x) * columns_.by / rise, false};
}

// The first column beyond a place.
std::size_t WaitingLattice::Rows::column_after(double place) const {
  if (!(place >= 0)) return 0;
  return std::min(static_cast<std::size_t>(place) + 1, columns_.at.size());
}

bool WaitingLattice::Rows::next() {
  while (next_ < rows_end_) {
    row = next_++;
    const double y = rows_.at[row];
    const std::size_t part = y >= middle_y_ && !flat_top_ ? 1 : 0;
    const Crossing& from = left_[part];
    const Crossing& to = right_[part];
    if (from.level || to.level) {
      first = column_after(least_);
      end = column_after(most_);
      sure_first = sure_end = end;
    } else {
      const double left = from.at(y), right = to.at(y);
      first = column_after(std::max(left - kDoubt, least_));
      end = column_after(std::min(right + kDoubt, most_));
      sure_first = std::min(column_after(left + kDoubt), end);
      sure_end = std::max(column_after(right - kDoubt), sure_first);
    }
    if (first < end) return true;
  }
  return false;
}

LatticePeak WaitingLattice::peak(const OwningTriangle& triangle, const HeightPlane& plane) const {
  double error = 0;
  std::optional<Row> best;
  for (Rows rows(*this, triangle); rows.next();) {
    const RowPlane row = RowPlane(columns_.at, rows_.at[rows.row], &z_[index(rows.row, 0)], plane);
    double most = largest(row, rows.sure_first, rows.sure_end);
    const auto look = [&](std::size_t i) {
      const double here = row.error(i);
      if (here >= error && here > most && triangle.holds(position(rows.row, i))) most = here;
    };
    for (std::size_t i = rows.first; i < rows.sure_first; ++i) look(i);
    for (std::size_t i = rows.sure_end; i < rows.end; ++i) look(i);
    if (most < error) continue;
    if (most > error || !best ||
        position(rows.row, farthest(rows, triangle, plane, most)) <
            position(best->row, farthest(*best, triangle, plane, most))) {
      best = rows;
    }
    error = most;
  }
  if (!best) return {};
  return {error, vertex_[index(best->row, farthest(*best, triangle, plane, error))]};
}

std::size_t WaitingLattice::farthest(const Row& row, const OwningTriangle& triangle, const HeightPlane& plane,
                                     double error) const {
  const RowPlane heights = RowPlane(columns_.at, rows_.at[row.row], &z_[index(row.row, 0)], plane);
  std::size_t i = row.first;
  while (heights.error(i) != error || !(row.sure(i) || triangle.holds(position(row.row, i)))) ++i;
  return i;
}

void WaitingLattice::append(const OwningTriangle& triangle, std::vector<std::uint32_t>& to) const {
  for (Rows rows(*this, triangle); rows.next();) {
    for (std::size_t i = rows.first; i < rows.end; ++i) {
      const std::size_t at = index(rows.row, i);
      if (std::isnan(z_[at])) continue;
      if (rows.sure(i) || triangle.holds(position(rows.row, i))) to.push_back(vertex_[at]);
    }
  }
}

}  // namespace thalweg::detail
