// Which area drains to each channel and vertex first, and to each sink.
//
// Areas are added in the order of triangles, so sums do not depend on threads.
#include "base/ordered_blocks.hpp"
#include "terrain/flow_graph.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace thalweg {

namespace {

constexpr std::size_t kBlock = 4096;

double area_of(const FlowMesh& mesh, TriangleId t) {
  const Triangle& c = mesh.triangle(t);
  const Point2 a = mesh.point(c[0]), b = mesh.point(c[1]), d = mesh.point(c[2]);
  return ((b.x - a.x) * (d.y - a.y) - (b.y - a.y) * (d.x - a.x)) / 2;
}

struct Part {
  FlowNode node = kNoNode;
  double area = 0;
};

/// Lists the parts of triangles.
class Divider {
 public:
  Divider(const FlowGraph& graph, std::vector<Part>& parts) : graph_(graph), parts_(parts) {}

  void divide(TriangleId t) {
    const double area = area_of(graph_.mesh, t);
    if (graph_.level(t)) {
      parts_.push_back({graph_.node_of(graph_.low_corner(t)), area});
      return;
    }
    const Strip strip = graph_.strip_of(t);
    if (strip.corner_is_low) {
      if (strip.at > 0) add_strips(Tin::previous(strip.split), 0, 1, area * strip.at);
      if (strip.at < 1) add_strips(Tin::next(strip.split), 1, 0, area * (1 - strip.at));
    } else {
      const double top = 1 - strip.at;
      add_strips(strip.split, 0, top, area * top);
      add_strips(strip.split, 1, top, area * (1 - top));
    }
  }

 private:
  /// The strips of a triangle between a corner and the line that splits it, by what they come to. Shares from
  /// `from` (at the corner) to `to` (at the line), in either direction: a strip's area is the difference of
  /// squares.
  void add_strips(HalfedgeId h, double from, double to, double area) {
    const double whole = to - from;
    if (whole == 0) return;
    const FlowTarget target = graph_.beyond(h);
    if (target.many == 0) {
      parts_.push_back({target.index, area});
      return;
    }
    const double least = std::min(from, to), most = std::max(from, to);
    double begin = 0;
    for (const FlowPiece* piece = &graph_.pieces[target.index];; ++piece) {
      const double low = std::max(begin, least), high = std::min(piece->end, most);
      begin = piece->end;
      if (low < high) {
        const double p = (low - from) / whole, q = (high - from) / whole;
        parts_.push_back({piece->node, area * std::abs((q - p) * (q + p))});
      }
      if (piece->last != 0) return;
    }
  }

  const FlowGraph& graph_;
  std::vector<Part>& parts_;
};

}  // namespace

void measure_grounds(FlowGraph& graph, const Progress& progress) {
  graph.ground.assign(graph.node_count(), 0);
  for_each_block_in_order<std::vector<Part>>(
      graph.mesh.triangle_count(), kBlock, progress,
      [&](std::size_t begin, std::size_t end, std::vector<Part>& parts) {
        parts.clear();
        Divider divider(graph, parts);
        for (std::size_t t = begin; t < end; ++t) divider.divide(TriangleId{t});
      },
      [&](std::size_t /*begin*/, std::size_t /*end*/, const std::vector<Part>& parts) {
        for (const Part& part : parts) graph.ground[part.node] += part.area;
      });
  for (std::size_t node = 0; node < graph.ground.size(); ++node) {
    const double area = graph.ground[node];
    if (area > 0) graph.sinks[graph.sink_of_node(static_cast<FlowNode>(node))].area += area;
  }
}

}  // namespace thalweg
