// Drawn lines against the surface: edges by how their triangles fall, valley lines (valley_lines) for which
// way they run.
#include "base/parallel.hpp"
#include "terrain/valley_lines.hpp"

#include <thalweg/geometry/slope.hpp>
#include <thalweg/terrain/consistency.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace thalweg {

namespace {

class Checker {
 public:
  Checker(const Tin& tin, const MetricScale& scale)
      : tin_(tin), scale_(scale), valleys_(trace_valleys(tin_)) {}

  Consistency run() {
    constexpr std::size_t kBlock = 1 << 13;
    std::vector<Consistency> parts((tin_.triangle_count() + kBlock - 1) / kBlock);
    for_each_block(tin_.triangle_count(), kBlock, Progress(), [&](std::size_t begin, std::size_t end) {
      for (std::size_t t = begin; t < end; ++t) look_at(TriangleId{t}, parts[begin / kBlock]);
    });
    Consistency all;
    for (const std::vector<VertexId>& line : valleys_.lines) note_rises(line, all);
    for (const Consistency& part : parts) add(part, all);
    return all;
  }

 private:
  static void add(const Consistency& part, Consistency& all) {
    all.valley_edges += part.valley_edges;
    all.valley_length_m += part.valley_length_m;
    all.draining_length_m += part.draining_length_m;
    all.ridge_edges += part.ridge_edges;
    all.crossed_ridge_edges += part.crossed_ridge_edges;
    all.flat_triangles += part.flat_triangles;
    all.flat_edges += part.flat_edges;
    all.triangles_on_valleys += part.triangles_on_valleys;
    all.undrawn_valley_edges += part.undrawn_valley_edges;
    all.places.insert(all.places.end(), part.places.begin(), part.places.end());
  }

  /// And its edges, those that it stands for.
  void look_at(TriangleId t, Consistency& part) const {
    for (std::size_t side = 0; side < 3; ++side) {
      const HalfedgeId h = Tin::halfedge(t, side);
      if (tin_.represents_edge(h)) look_at(h, part);
    }
    const auto& [a, b, c] = tin_.triangle(t);
    part.flat_triangles += tin_.height(a) == tin_.height(b) && tin_.height(b) == tin_.height(c) ? 1 : 0;
    const auto on_valley = [this](VertexId v) { return valleys_.on_valley[v.index()] != 0; };
    part.triangles_on_valleys += on_valley(a) && on_valley(b) && on_valley(c) ? 1 : 0;
  }

  /// As fall_across, of the halfedge's triangle.
  [[nodiscard]] int fall(HalfedgeId h) const {
    const VertexId a = tin_.origin(h), b = tin_.target(h), c = tin_.apex(h);
    return fall_across(tin_.point(a), tin_.height(a), tin_.point(b), tin_.height(b), tin_.point(c),
                       tin_.height(c));
  }

  void look_at(HalfedgeId h, Consistency& part) const {
    const VertexId a = tin_.origin(h), b = tin_.target(h);
    const HalfedgeId twin = tin_.twin(h);
    const int here = fall(h), there = twin.valid() ? fall(twin) : -1;
    const bool valley = makes_valley(here, there) && tin_.height(a) != tin_.height(b);
    const bool drawn = has(tin_.kind(h), EdgeKind::Valley);
    part.flat_edges += tin_.height(a) == tin_.height(b) ? 1 : 0;
    part.undrawn_valley_edges += valley && !drawn ? 1 : 0;
    if (drawn) {
      ++part.valley_edges;
      const double length = std::hypot(tin_.point(a).x - tin_.point(b).x, tin_.point(a).y - tin_.point(b).y) *
                            scale_.horizontal_metres_per_unit;
      part.valley_length_m += length;
      if (valley) part.draining_length_m += length;
    }
    if (!has(tin_.kind(h), EdgeKind::Ridge)) return;
    ++part.ridge_edges;
    if (!twin.valid() || here * there >= 0) return;
    ++part.crossed_ridge_edges;
    part.places.push_back({.kind = Inconsistency::Kind::RidgeCrossed, .from = a, .to = b});
  }

  void note_rises(const std::vector<VertexId>& line, Consistency& all) const {
    for (std::size_t k = 1; k < line.size(); ++k) {
      const double rise = (tin_.height(line[k]) - tin_.height(line[k - 1])) * scale_.vertical_metres_per_unit;
      if (!(rise > 0)) continue;
      ++all.rising_edges;
      all.rise_sum_m += rise;
      all.rise_max_m = std::max(all.rise_max_m, rise);
      all.places.push_back(
          {.kind = Inconsistency::Kind::ValleyRises, .from = line[k - 1], .to = line[k], .rise_m = rise});
    }
  }

  const Tin& tin_;
  const MetricScale& scale_;
  ValleyLines valleys_;
};

}  // namespace

Consistency check_consistency(const Tin& tin, const MetricScale& scale) {
  return Checker(tin, scale).run();
}

}  // namespace thalweg
