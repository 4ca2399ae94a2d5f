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
constexpr std::array<unsigned, 3> kNext = {1, 2, 0}, kPrevious = {2, 0, 1};

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
  struct Strip {
    HalfedgeId side;
    double low, high;
  };

  void climb(HalfedgeId side) {
    strips_.push_back({side, 0, 1});
    while (!strips_.empty()) {
      const Strip strip = strips_.back();
      strips_.pop_back();
      const Inflow& inflow = graph_.inflows[strip.side.index() / 3];
      inflow.shape.corner_is_low != 0 ? climb_beside_corner(strip, inflow) : climb_below_top(strip, inflow);
    }
  }

  // The area of a strip is the difference of squares of its distances from the corner.
  static double difference(double p, double q) { return std::abs((q - p) * (q + p)); }

  // Without jumps: on which side of the corner a strip comes cannot be foreseen. As Uphill; at the ends of
  // the side the sums are exact.
  void climb_beside_corner(const Strip& strip, const Inflow& inflow) {
    const TriangleStrip& triangle = graph_.strips[strip.side.index() / 3];
    const std::size_t side = strip.side.index() % 3, split = inflow.shape.split;
    const bool before = side == kPrevious[split];
    const double begin = before ? 0 : triangle.at, share = before ? triangle.at : 1 - triangle.at;
    const double p = before ? strip.low : 1 - strip.low, q = before ? strip.high : 1 - strip.high;
    area_ += triangle.area * share * difference(p, q);
    if ((before ? 1 - strip.high : strip.low) == 0) graph_.target[strip.side.index()] = node_;
    enter(strip.side.index() - side + split, inflow.up[0], begin + strip.low * share,
          begin + strip.high * share);
  }

  void climb_below_top(const Strip& strip, const Inflow& inflow) {
    const TriangleStrip& triangle = graph_.strips[strip.side.index() / 3];
    const std::size_t side = strip.side.index() % 3, first = strip.side.index() - side;
    const double top = 1 - triangle.at;
    if (strip.low < top) {
      const Uphill uphill = Uphill::below_top(top);
      const double low = uphill(strip.low), high = strip.high >= top ? 1 : uphill(strip.high);
      area_ += triangle.area * top * difference(low, high);
      enter(first + kNext[side], inflow.up[0], low, high);
    }
    if (strip.high <= top) return;
    const Uphill uphill = Uphill::above_top(top);
    const double low = uphill(strip.low), high = strip.high == 1 ? 1 : uphill(strip.high);
    area_ += triangle.area * (1 - top) * difference(1 - low, 1 - high);
    enter(first + kPrevious[side], inflow.up[1], low, high);
    if (strip.low > top) return;
    const VertexId corner = graph_.mesh.apex(strip.side);
    const VertexStep& step = graph_.step[corner.index()];
    if (step.kind == VertexStep::Kind::Cross && step.edge == strip.side) graph_.next[corner.index()] = node_;
  }

  /// Comes to an In side from below, between two shares of its way, and goes on at `up`, if that is valid.
  void enter(std::size_t in_side, HalfedgeId up, double low, double high) {
    if (!(low < high)) return;
    if (low == 0) graph_.target[in_side] = node_;
    if (up.valid()) strips_.push_back({up, low, high});
  }

  FlowGraph& graph_;
  FlowNode node_ = kNoNode;
  double area_ = 0;
  std::vector<Strip> strips_;
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
