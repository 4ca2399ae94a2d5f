// Vertices in rows as high as a square of eight vertices is wide.
//
// Counting in a disc: it lies in a ball about the middle of its box. In a row, what is farther from that
// middle than half the ball's longest chord there is outside. Between two vertices of the row all are inside
// if the corners of the box of their x and of the row's y are, for the disc is convex: these two are guessed
// from the ball's shortest chord, and moved inwards until exact predicates confirm it. All others are asked
// for one by one.
#include "order/vertex_rows.hpp"

#include "order/circumdisc.hpp"

#include <cmath>
#include <limits>
#include <utility>

namespace thalweg::detail {

namespace {

constexpr double kVerticesACell = 8;

/// Half the chord of a ball at a distance from its middle; 0 beyond it.
double half_chord(double radius, double distance) {
  return distance < radius ? std::sqrt((radius - distance) * (radius + distance)) : 0;
}

}  // namespace

VertexRows::VertexRows(const Tin& tin) : tin_(tin) {
  std::vector<std::pair<double, VertexId>> used;
  Box2 bounds;
  for (std::size_t v = 0; v < tin.vertex_count(); ++v) {
    if (tin.outgoing(VertexId{v}).empty()) continue;
    used.emplace_back(tin.point(VertexId{v}).x, v);
    bounds.add(tin.point(VertexId{v}));
  }
  frame_ = CellFrame(bounds, static_cast<double>(used.size()) / kVerticesACell);
  std::sort(used.begin(), used.end());
  first_.assign(frame_.rows() + 1, 0);
  low_.assign(frame_.rows(), std::numeric_limits<double>::infinity());
  high_.assign(frame_.rows(), -std::numeric_limits<double>::infinity());
  for (const auto& [x, v] : used) {
    const double y = tin.point(v).y;
    const std::size_t row = frame_.row(y);
    ++first_[row + 1];
    low_[row] = std::min(low_[row], y);
    high_[row] = std::max(high_[row], y);
  }
  for (std::size_t row = 0; row < frame_.rows(); ++row) first_[row + 1] += first_[row];
  std::vector<std::uint32_t> fill(first_.begin(), first_.end() - 1);
  x_.resize(used.size());
  vertices_.resize(used.size());
  for (const auto& [x, v] : used) {
    const std::uint32_t place = fill[frame_.row(tin.point(v).y)]++;
    x_[place] = x;
    vertices_[place] = v;
  }
}

std::size_t VertexRows::count_in_disc(const Triangle& corners) const {
  const Circumdisc disc(tin_.point(corners[0]), tin_.point(corners[1]), tin_.point(corners[2]));
  const Box2 box = disc.box();
  const Point2 middle{(box.x_min + box.x_max) / 2, (box.y_min + box.y_max) / 2};
  const double radius = std::max(box.width(), box.height()) / 2;
  const bool bounded = std::isfinite(radius) && std::isfinite(middle.x) && std::isfinite(middle.y);
  const double slack = 1e-12 * (std::abs(middle.x) + std::abs(middle.y) + radius);  // far more than rounding
  std::size_t count = 0;
  for (std::size_t row = frame_.row(box.y_min); row <= frame_.row(box.y_max); ++row) {
    std::size_t begin = first_[row], end = first_[row + 1], inside_begin = begin, inside_end = begin;
    if (bounded && begin < end) {
      const double near = std::max({0.0, low_[row] - middle.y, middle.y - high_[row]});
      const double longest = half_chord(radius + slack, std::max(0.0, near - slack)) + slack;
      begin = lower(row, middle.x - longest);
      end = lower(row, std::nextafter(middle.x + longest, std::numeric_limits<double>::infinity()));
      const double shortest =
          half_chord(radius, std::max(std::abs(low_[row] - middle.y), std::abs(high_[row] - middle.y)));
      const auto column_is_inside = [&](std::size_t i) {
        return disc.side({x_[i], low_[row]}) > 0 && disc.side({x_[i], high_[row]}) > 0;
      };
      inside_begin = std::clamp(lower(row, middle.x - shortest), begin, end);
      inside_end = std::clamp(lower(row, middle.x + shortest), inside_begin, end);
      while (inside_begin < inside_end && !column_is_inside(inside_begin)) ++inside_begin;
      while (inside_begin < inside_end && !column_is_inside(inside_end - 1)) --inside_end;
    }
    const auto ask = [&](std::size_t from, std::size_t to) {
      for (std::size_t i = from; i < to; ++i) {
        const VertexId v = vertices_[i];
        if (std::find(corners.begin(), corners.end(), v) != corners.end()) continue;
        count += disc.holds(tin_.point(v)) ? 1 : 0;
      }
    };
    ask(begin, inside_begin);
    count += inside_end - inside_begin;
    ask(inside_end, end);
  }
  return count;
}

}  // namespace thalweg::detail
