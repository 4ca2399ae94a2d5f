// Drawn lines against the surface: edges by how their triangles fall, valley lines (valley_lines) for which
// way they run.
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
    for (std::size_t i = 0; i < tin_.halfedge_count(); ++i) {
      if (tin_.represents_edge(HalfedgeId{i})) look_at(HalfedgeId{i});
    }
    for (std::size_t i = 0; i < tin_.triangle_count(); ++i) {
      const Triangle& t = tin_.triangle(TriangleId{i});
      result_.flat_triangles +=
          tin_.height(t[0]) == tin_.height(t[1]) && tin_.height(t[1]) == tin_.height(t[2]) ? 1 : 0;
      const bool all =
          std::all_of(t.begin(), t.end(), [&](VertexId v) { return valleys_.on_valley[v.index()] != 0; });
      result_.triangles_on_valleys += all ? 1 : 0;
    }
    for (const std::vector<VertexId>& line : valleys_.lines) note_rises(line);
    result_.places.insert(result_.places.end(), crossed_.begin(), crossed_.end());
    return std::move(result_);
  }

 private:
  /// As fall_across, of the halfedge's triangle.
  [[nodiscard]] int fall(HalfedgeId h) const {
    const VertexId a = tin_.origin(h), b = tin_.target(h), c = tin_.apex(h);
    return fall_across(tin_.point(a), tin_.height(a), tin_.point(b), tin_.height(b), tin_.point(c),
                       tin_.height(c));
  }

  void look_at(HalfedgeId h) {
    const VertexId a = tin_.origin(h), b = tin_.target(h);
    const HalfedgeId twin = tin_.twin(h);
    const int here = fall(h), there = twin.valid() ? fall(twin) : -1;
    const bool valley = makes_valley(here, there) && tin_.height(a) != tin_.height(b);
    const bool drawn = has(tin_.kind(h), EdgeKind::Valley);
    result_.flat_edges += tin_.height(a) == tin_.height(b) ? 1 : 0;
    result_.undrawn_valley_edges += valley && !drawn ? 1 : 0;
    if (drawn) {
      ++result_.valley_edges;
      const double length = std::hypot(tin_.point(a).x - tin_.point(b).x, tin_.point(a).y - tin_.point(b).y) *
                            scale_.horizontal_metres_per_unit;
      result_.valley_length_m += length;
      if (valley) result_.draining_length_m += length;
    }
    if (!has(tin_.kind(h), EdgeKind::Ridge)) return;
    ++result_.ridge_edges;
    if (!twin.valid() || here * there >= 0) return;
    ++result_.crossed_ridge_edges;
    crossed_.push_back({.kind = Inconsistency::Kind::RidgeCrossed, .from = a, .to = b});
  }

  void note_rises(const std::vector<VertexId>& line) {
    for (std::size_t k = 1; k < line.size(); ++k) {
      const double rise = (tin_.height(line[k]) - tin_.height(line[k - 1])) * scale_.vertical_metres_per_unit;
      if (!(rise > 0)) continue;
      ++result_.rising_edges;
      result_.rise_sum_m += rise;
      result_.rise_max_m = std::max(result_.rise_max_m, rise);
      result_.places.push_back(
          {.kind = Inconsistency::Kind::ValleyRises, .from = line[k - 1], .to = line[k], .rise_m = rise});
    }
  }

  const Tin& tin_;
  const MetricScale& scale_;
  Consistency result_;
  std::vector<Inconsistency> crossed_;
  ValleyLines valleys_;
};

}  // namespace

Consistency check_consistency(const Tin& tin, const MetricScale& scale) {
  return Checker(tin, scale).run();
}

}  // namespace thalweg
