#pragma once

/// Lengths, areas and angles of a TIN in metres, by plain code.

#include <thalweg/mesh/tin.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

namespace thalweg::test {

class PlainShape {
 public:
  /// Metres per unit of the plane and of heights.
  PlainShape(const Tin& tin, double horizontal, double vertical)
      : tin_(tin), horizontal_(horizontal), vertical_(vertical) {}

  using Vector = std::array<long double, 3>;
  using Edge = std::pair<VertexId, VertexId>;

  [[nodiscard]] Vector at(VertexId v) const {
    return {tin_.point(v).x * horizontal_, tin_.point(v).y * horizontal_, tin_.height(v) * vertical_};
  }
  [[nodiscard]] Vector normal(const Triangle& t) const {
    const Vector a = at(t[0]), b = at(t[1]), c = at(t[2]);
    Vector n;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
      n[i] = (b[j] - a[j]) * (c[k] - a[k]) - (b[k] - a[k]) * (c[j] - a[j]);
    }
    return n;
  }
  static long double between(const Vector& m, const Vector& n) {
    long double dot = 0, cross = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
      dot += m[i] * n[i];
      cross += (m[j] * n[k] - m[k] * n[j]) * (m[j] * n[k] - m[k] * n[j]);
    }
    return std::atan2(std::sqrt(cross), dot);
  }
  [[nodiscard]] long double angle(const Triangle& a, const Triangle& b) const {
    return between(normal(a), normal(b));
  }
  [[nodiscard]] long double length(const Edge& edge) const {
    const Vector a = at(edge.first), b = at(edge.second);
    return std::hypot(b[0] - a[0], b[1] - a[1]);
  }
  [[nodiscard]] long double area(const Triangle& t) const { return normal(t)[2] / 2; }
  [[nodiscard]] long double ratio(const Triangle& a, const Triangle& b) const {
    return std::max(area(a), area(b)) / std::min(area(a), area(b));
  }
  [[nodiscard]] bool flat(const Triangle& t) const {
    return tin_.height(t[0]) == tin_.height(t[1]) && tin_.height(t[1]) == tin_.height(t[2]);
  }
  /// 1 if the apex of b lies strictly below the plane of a, -1 if above; whole heights and coordinates make
  /// this exact.
  [[nodiscard]] int bend(const Triangle& a, const Triangle& b, const Edge& edge) const {
    const VertexId apex =
        *std::find_if(b.begin(), b.end(), [&](VertexId v) { return v != edge.first && v != edge.second; });
    const Vector n = normal(a), p = at(apex), o = at(a[0]);
    const long double above = n[0] * (p[0] - o[0]) + n[1] * (p[1] - o[1]) + n[2] * (p[2] - o[2]);
    return above < 0 ? 1 : above > 0 ? -1 : 0;
  }
  [[nodiscard]] std::array<long double, 3> angles(const Triangle& t) const {
    std::array<long double, 3> found{};
    for (std::size_t i = 0; i < 3; ++i) {
      const Vector a = at(t[i]), b = at(t[(i + 1) % 3]), c = at(t[(i + 2) % 3]);
      found[i] = between({b[0] - a[0], b[1] - a[1], 0}, {c[0] - a[0], c[1] - a[1], 0}) * 180 /
                 std::numbers::pi_v<long double>;
    }
    std::sort(found.begin(), found.end());
    return found;
  }

 protected:
  const Tin& tin_;
  double horizontal_, vertical_;
};

}  // namespace thalweg::test
