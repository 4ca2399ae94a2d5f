#pragma once

/// What a TIN is worth in each criterion, by plain code from the criteria's definitions, in whole steps of
/// 2^-32; less is better. Shares nothing with the optimiser.

#include "support/plain_shape.hpp"
#include "support/plain_stars.hpp"
#include "support/plain_surface.hpp"
#include "support/plain_water.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

namespace thalweg::test {

using Steps = std::int64_t;

class PlainCriteria : private PlainShape {
 public:
  PlainCriteria(const Tin& tin, double horizontal, double vertical)
      : PlainShape(tin, horizontal, vertical), edges_(triangles_by_edge(tin)) {}

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
    if (PlainWater::measures(name)) return PlainWater(tin_, horizontal_, vertical_).value(name);
    return of_vertices(name);
  }

 private:
  [[nodiscard]] static Steps rounded(long double value) {
    return static_cast<Steps>(std::floor(value * 0x1p32L + 0.5L));
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

  std::map<Edge, std::vector<Triangle>> edges_;
};

}  // namespace thalweg::test
