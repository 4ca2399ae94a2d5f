// Which area drains to each channel and vertex first, and to each sink.
//
// Areas are added in the order of triangles, so sums do not depend on threads.
#include "base/ordered_blocks.hpp"
#include "base/parallel.hpp"
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

/// A triangle on one side of the line that splits it: its shares of a side's way from `from`, at a corner, to
/// `to`, at the line, in either direction.
struct Half {
  TriangleId triangle;
  FlowTarget target;
  double from, to, area;
};

/// Lists the parts of triangles.
class Divider {
 public:
  Divider(FlowGraph& graph, std::vector<Part>& parts) : graph_(graph), parts_(parts) {}

  void divide(std::size_t begin, std::size_t end) {
    for (; begin < end; begin += kBatch) {
      halves_.clear();
      for (std::size_t t = begin; t < std::min(end, begin + kBatch); ++t) add_halves(TriangleId{t});
      for (const Half& half : halves_) divide(half);
    }
  }

 private:
  static constexpr std::size_t kBatch = 64;  // pieces are asked for so much before they are needed

  void add(TriangleId t, FlowTarget target, double from, double to, double area) {
    if (target.many()) __builtin_prefetch(graph_.pieces.at(target.index()));
    halves_.push_back({t, target, from, to, area});
  }

  void add_halves(TriangleId t) {
    const double area = area_of(graph_.mesh, t);
    if (graph_.level(t)) return add(t, FlowTarget::node(graph_.node_of(graph_.low_corner(t))), 0, 1, area);
    const Strip strip = graph_.strip_of(t);
    if (strip.corner_is_low) {
      if (strip.at > 0) add(t, graph_.beyond(Tin::previous(strip.split)), 0, 1, area * strip.at);
      if (strip.at < 1) add(t, graph_.beyond(Tin::next(strip.split)), 1, 0, area * (1 - strip.at));
    } else {
      const double top = 1 - strip.at;
      const FlowTarget target = graph_.beyond(strip.split);
      add(t, target, 0, top, area * top);
      add(t, target, 1, top, area * (1 - top));
    }
  }

  /// A strip's area is the difference of squares.
  void divide(const Half& half) {
    if (!half.target.many()) {
      parts_.push_back({half.target.index(), half.area});
      note(half.triangle, half.target.index());
      return;
    }
    const double from = half.from, whole = half.to - half.from;
    const double least = std::min(from, half.to), most = std::max(from, half.to);
    const FlowPiece* piece = graph_.pieces.at(half.target.index());
    while (piece->end <= least && piece->last == 0) ++piece;
    double low = least, p = (low - from) / whole;
    for (;; ++piece) {
      note(half.triangle, piece->node);
      const double high = std::min(piece->end, most);
      if (low < high) {
        const double q = (high - from) / whole;
        parts_.push_back({piece->node, half.area * std::abs((q - p) * (q + p))});
        low = high;
        p = q;
      }
      if (piece->last != 0 || piece->end >= most) return;
    }
  }

  void note(TriangleId t, FlowNode node) {
    std::uint32_t& known = graph_.only_sink[t.index()];
    const std::uint32_t sink = graph_.sink_of_node[node];
    known = known == SinkId::kInvalid || known == sink ? sink : FlowGraph::kSeveralSinks;
  }

  FlowGraph& graph_;
  std::vector<Part>& parts_;
  std::vector<Half> halves_;
};

}  // namespace

void measure_grounds(FlowGraph& graph, const Progress& progress) {
  graph.sink_of_node.resize(graph.node_count());
  for_each_block(graph.node_count(), kBlock, progress, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto node = static_cast<FlowNode>(i);
      const bool vertex = graph.is_vertex(node);
      const bool leaves = !vertex && graph.channel_of(node).on_rim;
      const VertexId v = vertex ? graph.vertex_of(node) : graph.channel_of(node).low;
      graph.sink_of_node[i] = leaves ? graph.rim_sink[v.index()] : graph.sink[v.index()];
    }
  });
  graph.ground.assign(graph.node_count(), 0);
  graph.only_sink.assign(graph.mesh.triangle_count(), SinkId::kInvalid);
  for_each_block_in_order<std::vector<Part>>(
      graph.mesh.triangle_count(), kBlock, progress,
      [&](std::size_t begin, std::size_t end, std::vector<Part>& parts) {
        parts.clear();
        Divider(graph, parts).divide(begin, end);
      },
      [&](std::size_t /*begin*/, std::size_t /*end*/, const std::vector<Part>& parts) {
        for (const Part& part : parts) graph.ground[part.node] += part.area;
      });
  for (std::size_t node = 0; node < graph.ground.size(); ++node) {
    const double area = graph.ground[node];
    if (area > 0) graph.sinks[graph.sink_of_node[node]].area += area;
  }
}

}  // namespace thalweg
