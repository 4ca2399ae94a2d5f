#pragma once

/// What a TIN is worth in each criterion, by plain code from the criteria's definitions, in whole steps of
/// 2^-32; less is better. Shares nothing with the optimiser.

#include "support/plain_stars.hpp"
#include "support/plain_surface.hpp"
#include "support/plain_water.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

namespace thalweg::test {

using Steps = std::int64_t;

class PlainCriteria {
 public:
  PlainCriteria(const Tin& tin, double horizontal, double vertical)
      : tin_(tin), horizontal_(horizontal), vertical_(vertical), edges_(triangles_by_edge(tin)) {}

  [[nodiscard]] Steps value(const std::string& name) const {
    if (name == "local-minima") return rounded(static_cast<long double>(plain_pits(tin_)));
    if (name == "normal-angle-sum") return sum_of_edges([&](auto& a, auto& b, auto&) { return angle(a, b); });
    if (name == "normal-angle-squares")
      return sum_of_edges([&](auto& a, auto& b, auto&) { return angle(a, b) * angle(a, b); });
    if (name == "edge-length") return sum_of_edges([&](auto&, auto&, auto& edge) { return length(edge); });
    if (name == "area-ratio-sum") return sum_of_edges([&](auto& a, auto& b, auto&) { return ratio(a, b); });
    if (name == "convex-edges")
      return -sum_of_edges([&](auto& a, auto& b, auto& edge) { return bend(a, b, edge) > 0 ? 1.0L : 0.0L; });
    if (name == "normal-angle-max")
      return most_of_edges(
          [&](auto& a, auto& b) { return angle(a, b) * 180 / std::numbers::pi_v<long double>; });
    if (name == "area-ratio-max") return most_of_edges([&](auto& a, auto& b) { return ratio(a, b); });
    if (name == "flat-triangles") return of_triangles([&](auto& t) { return flat(t) ? 1.0L : 0.0L; }, true);
    if (name == "max-area") return of_triangles([&](auto& t) { return area(t); }, false);
    if (name == "max-angle") return of_triangles([&](auto& t) { return angles(t).back(); }, false);
    if (name == "min-angle") return of_triangles([&](auto& t) { return -angles(t).front(); }, false);
    if (name == "pit-depth") return PlainWater(tin_, vertical_).pit_depth();
    if (name == "valley-triangles") {
      const PlainWater water(tin_, vertical_);
      return of_triangles([&](auto& t) { return water.on_valleys(t) ? 1.0L : 0.0L; }, true);
    }
    if (name == "draining-valleys") {
      const PlainWater water(tin_, vertical_);
      return -sum_of_edges([&](auto& a, auto& b, auto& edge) {
        return water.is_drawn_valley(edge) && water.drains(a, b, edge) ? length(edge) : 0.0L;
      });
    }
    return of_vertices(name);
  }

 private:
  using Vector = std::array<long double, 3>;
  using Edge = std::pair<VertexId, VertexId>;

  [[nodiscard]] static Steps rounded(long double value) {
    return static_cast<Steps>(std::floor(value * 0x1p32L + 0.5L));
  }
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

  template <class Term>
  Steps sum_of_edges(const Term& term) const {
    Steps sum = 0;
    for (const auto& [edge, triangles] : edges_) {
      if (triangles.size() == 2) sum += rounded(term(triangles[0], triangles[1], edge));
    }
    return sum;
  }
  template <class Term>
  Steps most_of_edges(const Term& term) const {
    Steps most = 0;
    for (const auto& [edge, triangles] : edges_) {
      if (triangles.size() == 2) most = std::max(most, rounded(term(triangles[0], triangles[1])));
    }
    return most;
  }
  template <class Term>
  Steps of_triangles(const Term& term, bool summed) const {
    Steps sum = 0, most = rounded(term(tin_.triangles().front()));
    for (const Triangle& t : tin_.triangles()) {
      sum += rounded(term(t));
      most = std::max(most, rounded(term(t)));
    }
    return summed ? sum : most;
  }

  [[nodiscard]] Steps of_vertices(const std::string& name) const {
    PlainStars stars;
    for (const auto& [edge, triangles] : edges_) {
      const bool rim = triangles.size() == 1;
      stars.add(edge, rim, rim ? 0 : bend(triangles[0], triangles[1], edge));
    }
    return rounded(static_cast<long double>(stars.value(name)));
  }

  const Tin& tin_;
  double horizontal_, vertical_;
  std::map<Edge, std::vector<Triangle>> edges_;
};

}  // namespace thalweg::test
