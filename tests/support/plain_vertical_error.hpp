#pragma once

/// Squares of vertical distances between a TIN and marks, by looking for a triangle around each mark.

#include <thalweg/mesh/tin.hpp>

#include <algorithm>
#include <array>
#include <span>

namespace thalweg::test {

/// Whole coordinates, so that it is exact which triangles hold it.
struct Mark {
  Point2 at;
  double height = 0;
};

/// Each mark on the surface once, against the first triangle that holds it.
inline long double plain_vertical_error(const Tin& tin, std::span<const Mark> marks, double vertical) {
  long double sum = 0;
  for (const Mark& mark : marks) {
    for (const Triangle& t : tin.triangles()) {
      std::array<long double, 3> share{};
      for (std::size_t i = 0; i < 3; ++i) {
        const Point2 a = tin.point(t[(i + 1) % 3]), b = tin.point(t[(i + 2) % 3]);
        share[i] = (b.x - a.x) * (mark.at.y - a.y) - (b.y - a.y) * (mark.at.x - a.x);
      }
      if (*std::min_element(share.begin(), share.end()) < 0) continue;
      long double error = -mark.height;
      for (std::size_t i = 0; i < 3; ++i) {
        error += share[i] / (share[0] + share[1] + share[2]) * tin.height(t[i]);
      }
      sum += error * error * vertical * vertical;
      break;
    }
  }
  return sum;
}

}  // namespace thalweg::test
