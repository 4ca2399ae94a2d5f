#pragma once

/// Water on a TIN by plain code: depths of pits height by height, and which drawn valleys drain.

#include "support/plain_surface.hpp"

#include <thalweg/mesh/tin.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace thalweg::test {

class PlainWater {
 public:
  using Edge = std::pair<VertexId, VertexId>;

  PlainWater(const Tin& tin, double horizontal, double vertical)
      : tin_(tin), horizontal_(horizontal), vertical_(vertical), edges_(triangles_by_edge(tin)) {
    for (const ConstraintEdge& edge : tin.constraint_edges()) kind_[std::minmax(edge.a, edge.b)] = edge.kind;
    for (const auto& [edge, kind] : kind_) {
      if (has(kind, EdgeKind::Valley)) on_valley_.insert({edge.first, edge.second});
    }
  }

  static bool measures(const std::string& name) {
    return name == "pit-depth" || name == "valley-triangles" || name == "draining-valleys";
  }
  /// In steps of 2^-32; less is better. Pre: it is measured here.
  [[nodiscard]] std::int64_t value(const std::string& name) const {
    if (name == "pit-depth") return pit_depth();
    std::int64_t steps = 0;
    if (name == "valley-triangles") {
      for (const Triangle& t : tin_.triangles()) steps += on_valleys(t) ? std::int64_t{1} << 32U : 0;
      return steps;
    }
    for (const auto& [edge, triangles] : edges_) {
      if (triangles.size() < 2 || !is_drawn_valley(edge) || !drains(triangles[0], triangles[1], edge))
        continue;
      const Point2 a = tin_.point(edge.first), b = tin_.point(edge.second);
      const long double length = std::hypot((a.x - b.x) * static_cast<long double>(horizontal_),
                                            (a.y - b.y) * static_cast<long double>(horizontal_));
      steps -= static_cast<std::int64_t>(std::floor(length * 0x1p32L + 0.5L));
    }
    return steps;
  }

  /// In steps of 2^-32 m: floods to each height in turn; between two heights every set of flooded vertices
  /// that does not touch the rim or a lake is one pit that is so much deeper.
  [[nodiscard]] std::int64_t pit_depth() const {
    std::set<double> heights(tin_.heights().begin(), tin_.heights().end());
    std::int64_t depth = 0;
    for (auto here = heights.begin(); std::next(here) != heights.end(); ++here) {
      const std::int64_t step = rounded(*std::next(here)) - rounded(*here);
      depth += static_cast<std::int64_t>(closed_pools(*here)) * step;
    }
    return depth;
  }

  [[nodiscard]] bool on_valleys(const Triangle& t) const {
    return std::all_of(t.begin(), t.end(), [&](VertexId v) { return on_valley_.contains(v); });
  }
  [[nodiscard]] bool is_drawn_valley(const Edge& edge) const {
    const auto found = kind_.find(edge);
    return found != kind_.end() && has(found->second, EdgeKind::Valley);
  }
  /// Whether the surface on both sides rises from the edge, or runs along it on one of them. Exact for small
  /// whole coordinates.
  [[nodiscard]] bool drains(const Triangle& a, const Triangle& b, const Edge& edge) const {
    const long double of_a = rise_from(edge, a), of_b = rise_from(edge, b);
    return of_a >= 0 && of_b >= 0 && of_a + of_b > 0 && tin_.height(edge.first) != tin_.height(edge.second);
  }

 private:
  [[nodiscard]] std::int64_t rounded(double height) const {
    return static_cast<std::int64_t>(
        std::floor(static_cast<long double>(height) * vertical_ * 0x1p32L + 0.5L));
  }

  /// The gradient of the triangle's plane, times its doubled area, along the normal of the edge that points
  /// into the triangle.
  [[nodiscard]] long double rise_from(const Edge& edge, const Triangle& t) const {
    const auto at = [&](VertexId v) { return tin_.point(v); };
    const long double x1 = at(t[1]).x - at(t[0]).x, y1 = at(t[1]).y - at(t[0]).y,
                      x2 = at(t[2]).x - at(t[0]).x, y2 = at(t[2]).y - at(t[0]).y,
                      z1 = tin_.height(t[1]) - tin_.height(t[0]), z2 = tin_.height(t[2]) - tin_.height(t[0]);
    const long double gx = z1 * y2 - z2 * y1, gy = z2 * x1 - z1 * x2;
    const VertexId apex =
        *std::find_if(t.begin(), t.end(), [&](VertexId v) { return v != edge.first && v != edge.second; });
    const long double ex = at(edge.second).x - at(edge.first).x, ey = at(edge.second).y - at(edge.first).y;
    const long double ax = at(apex).x - at(edge.first).x, ay = at(apex).y - at(edge.first).y;
    const long double side = ex * ay - ey * ax > 0 ? 1 : -1;
    return side * (-ey * gx + ex * gy);
  }

  [[nodiscard]] std::size_t closed_pools(double height) const {
    std::vector<bool> seen(tin_.vertex_count(), false);
    std::size_t count = 0;
    for (std::size_t start = 0; start < seen.size(); ++start) {
      if (seen[start] || tin_.height(VertexId{start}) > height) continue;
      std::vector<VertexId> pool = {VertexId{start}};
      seen[start] = true;
      bool open = false, any = false;
      for (std::size_t i = 0; i < pool.size(); ++i) {
        for (const auto& [edge, triangles] : edges_) {
          if (edge.first != pool[i] && edge.second != pool[i]) continue;
          any = true;
          const VertexId across = edge.first == pool[i] ? edge.second : edge.first;
          const auto kind = kind_.find(edge);
          const bool lake = kind != kind_.end() && has(kind->second, EdgeKind::Lake) &&
                            tin_.height(across) == tin_.height(pool[i]);
          open = open || triangles.size() < 2 || lake;
          if (tin_.height(across) > height || seen[across.index()]) continue;
          seen[across.index()] = true;
          pool.push_back(across);
        }
      }
      count += any && !open ? 1 : 0;
    }
    return count;
  }

  const Tin& tin_;
  double horizontal_, vertical_;
  std::map<Edge, std::vector<Triangle>> edges_;
  std::map<Edge, EdgeKind> kind_;
  std::set<VertexId> on_valley_;
};

}  // namespace thalweg::test
