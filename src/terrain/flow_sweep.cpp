// Which area drains to each channel and vertex first, and to each sink.
//
// 1. From both sides of each channel a strip of all water that comes to it first is followed upwards. Where
//    it meets a high corner it parts; above a low corner it is a part of the side. Strips never meet, so
//    channels are done side by side, and each sums up its ground by itself: sums do not depend on threads.
// 2. Water on a level triangle comes to its low corner.
#include "base/parallel.hpp"
#include "terrain/flow_graph.hpp"
#include "terrain/uphill.hpp"

#include <array>
#include <cmath>
#include <vector>

namespace thalweg {

namespace {

constexpr std::size_t kBlock = 4096;

/// Follows the strips of one channel after another.
class Sweep {
 public:
  explicit Sweep(FlowGraph& graph) : graph_(graph) {}

  /// The ground of the channel.
  double run(FlowNode channel) {
    node_ = channel;
    area_ = 0;
    const HalfedgeId h = graph_.channel_of(channel).edge, twin = graph_.mesh.twin(h);
    if (graph_.fall(h) == Fall::Out) climb(h);
    if (twin.valid() && graph_.fall(twin) == Fall::Out) climb(twin);
    return area_;
  }

 private:
  /// Water that runs over `side` out of its triangle, between two shares of the way along its twin.
  struct Stream {
    HalfedgeId side;
    double low, high;
  };

  void climb(HalfedgeId side) {
    streams_.push_back({side, 0, 1});
    while (!streams_.empty()) {
      const Stream stream = streams_.back();
      streams_.pop_back();
      const Inflow& inflow = graph_.inflows[stream.side.index() / 3];
      inflow.shape.corner_is_low != 0 ? climb_beside_corner(stream, inflow) : climb_below_top(stream, inflow);
    }
  }

  // The area of a strip is the difference of squares of its distances from the corner.
  static double difference(double p, double q) { return std::abs((q - p) * (q + p)); }

  // Without jumps: on which side of the corner a strip comes cannot be foreseen. As Uphill; at the ends of
  // the side the sums are exact.
  void climb_beside_corner(const Stream& stream, const Inflow& inflow) {
    const TriangleStrip& triangle = graph_.strips[stream.side.index() / 3];
    const std::size_t side = stream.side.index() % 3, split = inflow.shape.split;
    const bool before = side == kPreviousSide[split];
    const double begin = before ? 0 : triangle.at, share = before ? triangle.at : 1 - triangle.at;
    const double p = before ? stream.low : 1 - stream.low, q = before ? stream.high : 1 - stream.high;
    area_ += triangle.area * share * difference(p, q);
    if ((before ? 1 - stream.high : stream.low) == 0) graph_.target[stream.side.index()] = node_;
    enter(stream.side.index() - side + split, inflow.up[0], begin + stream.low * share,
          begin + stream.high * share);
  }

  void climb_below_top(const Stream& stream, const Inflow& inflow) {
    const TriangleStrip& triangle = graph_.strips[stream.side.index() / 3];
    const std::size_t side = stream.side.index() % 3, first = stream.side.index() - side;
    const double top = 1 - triangle.at;
    if (stream.low < top) {
      const Uphill uphill = Uphill::below_top(top);
      const double low = uphill(stream.low), high = stream.high >= top ? 1 : uphill(stream.high);
      area_ += triangle.area * top * difference(low, high);
      enter(first + kNextSide[side], inflow.up[0], low, high);
    }
    if (stream.high <= top) return;
    const Uphill uphill = Uphill::above_top(top);
    const double low = uphill(stream.low), high = stream.high == 1 ? 1 : uphill(stream.high);
    area_ += triangle.area * (1 - top) * difference(1 - low, 1 - high);
    enter(first + kPreviousSide[side], inflow.up[1], low, high);
    if (stream.low > top) return;
    const VertexId corner = graph_.mesh.apex(stream.side);
    const VertexStep& step = graph_.step[corner.index()];
    if (step.kind == VertexStep::Kind::Cross && step.edge == stream.side) graph_.next[corner.index()] = node_;
  }

  /// Comes to an In side from below, between two shares of its way, and goes on at `up`, if that is valid.
  void enter(std::size_t in_side, HalfedgeId up, double low, double high) {
    if (!(low < high)) return;
    if (low == 0) graph_.target[in_side] = node_;
    if (up.valid()) streams_.push_back({up, low, high});
  }

  FlowGraph& graph_;
  FlowNode node_ = kNoNode;
  double area_ = 0;
  std::vector<Stream> streams_;
};

}  // namespace

void sweep_grounds(FlowGraph& graph, const Progress& progress) {
  graph.next.assign(graph.mesh.vertex_count(), kNoNode);
  graph.ground.resize(graph.node_count());
  for_each_block(graph.node_count(), kBlock, progress, [&](std::size_t begin, std::size_t end) {
    Sweep sweep(graph);
    for (std::size_t i = begin; i < end; ++i) {
      const auto node = static_cast<FlowNode>(i);
      graph.ground[i] = graph.is_vertex(node) ? 0 : sweep.run(node);
    }
  });
  for (std::size_t t = 0; t < graph.mesh.triangle_count(); ++t) {
    if (!graph.level(TriangleId{t})) continue;
    graph.ground[graph.node_of(graph.low_corner(TriangleId{t}))] += graph.strips[t].area;
  }
}

void add_up_sinks(FlowGraph& graph, const Progress& progress) {
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
  for (std::size_t node = 0; node < graph.ground.size(); ++node) {
    const double area = graph.ground[node];
    if (area > 0) graph.sinks[graph.sink_of_node[node]].area += area;
  }
}

}  // namespace thalweg
