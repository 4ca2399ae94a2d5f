// Drawn lines against the surface: edges by what falls to them (flow_graph), valley lines (valley_lines) for
// which way they run.
#include "terrain/flow_graph.hpp"
#include "terrain/valley_lines.hpp"

#include <thalweg/terrain/consistency.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace thalweg {

namespace {

class Checker {
 public:
  Checker(const SurfaceFlow& flow, const MetricScale& scale)
      : flow_(flow), graph_(flow.graph()), tin_(graph_.tin), scale_(scale), valleys_(trace_valleys(tin_)) {}

  Consistency run() {
    for (std::size_t i = 0; i < tin_.halfedge_count(); ++i) {
      if (tin_.represents_edge(HalfedgeId{i})) look_at(HalfedgeId{i});
    }
    for (std::size_t i = 0; i < tin_.triangle_count(); ++i) {
      const Triangle& t = tin_.triangle(TriangleId{i});
      result_.flat_triangles += graph_.level(TriangleId{i}) ? 1 : 0;
      const bool all =
          std::all_of(t.begin(), t.end(), [&](VertexId v) { return valleys_.on_valley[v.index()] != 0; });
      result_.triangles_on_valleys += all ? 1 : 0;
    }
    for (const std::vector<VertexId>& line : valleys_.lines) note_rises(line);
    result_.places.insert(result_.places.end(), crossed_.begin(), crossed_.end());
    return std::move(result_);
  }

 private:
  void look_at(HalfedgeId h) {
    const VertexId a = tin_.origin(h), b = tin_.target(h);
    const bool drawn = has(tin_.kind(h), EdgeKind::Valley), valley = flow_.is_valley(h);
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
    const HalfedgeId twin = tin_.twin(h);
    if (!twin.valid()) return;
    const Fall here = graph_.fall[h.index()], there = graph_.fall[twin.index()];
    if (!((here == Fall::Out && there == Fall::In) || (here == Fall::In && there == Fall::Out))) return;
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

  const SurfaceFlow& flow_;
  const FlowGraph& graph_;
  const Tin& tin_;
  const MetricScale& scale_;
  Consistency result_;
  std::vector<Inconsistency> crossed_;
  ValleyLines valleys_;
};

}  // namespace

Consistency check_consistency(const SurfaceFlow& flow, const MetricScale& scale) {
  return Checker(flow, scale).run();
}

}  // namespace thalweg
