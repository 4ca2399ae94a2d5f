// The network: channels and vertices are a forest (each sends its water to one other), so areas and orders
// are added up from the leaves down, in one pass over nodes that wait for no other.
#include "terrain/flow_graph.hpp"

#include <thalweg/terrain/network.hpp>

#include <algorithm>
#include <cstdint>
#include <utility>

namespace thalweg {

namespace {

class Accumulator {
 public:
  Accumulator(const FlowGraph& graph, const Spilling& spilling, double min_area)
      : graph_(graph),
        spilling_(spilling),
        tin_(graph.tin),
        min_area_(min_area),
        area_(graph.ground),
        waiting_(graph.ground.size(), 0),
        highest_(graph.ground.size(), 0),
        how_often_(graph.ground.size(), 0) {}

  void run(Progress& progress) {
    const std::size_t count = area_.size();
    const auto exists = [&](std::size_t node) {
      return node >= tin_.halfedge_count() ||
             (graph_.channel[node] != 0 && tin_.represents_edge(HalfedgeId{node}));
    };
    for (std::size_t node = 0; node < count; ++node) {
      if (!exists(node)) continue;
      if (const FlowNode next = below(static_cast<FlowNode>(node)); next != kNoNode) ++waiting_[next];
    }
    progress.advance(0.3);
    for (std::size_t node = 0; node < count; ++node) {
      if (waiting_[node] != 0 || !exists(node)) continue;
      if (node % (1U << 16U) == 0) progress.check();
      for (auto at = static_cast<FlowNode>(node); at != kNoNode;) {
        const FlowNode next = below(at);
        settle(at);
        waiting_[at] = kSettled;
        if (next == kNoNode) break;
        pass_on(at, next);
        if (--waiting_[next] != 0) break;
        at = next;
      }
    }
  }

  [[nodiscard]] double area(FlowNode node) const { return area_[node]; }
  [[nodiscard]] unsigned strahler(FlowNode node) const { return highest_[node]; }

 private:
  static constexpr std::uint32_t kSettled = 0xffffffffU;

  [[nodiscard]] FlowNode below(FlowNode node) const {
    if (graph_.is_vertex(node)) return below(graph_.vertex_of(node));
    const HalfedgeId h{node};
    return tin_.on_rim(h) ? kNoNode : graph_.node_of(graph_.low_end(h));
  }

  [[nodiscard]] FlowNode below(VertexId v) const {
    const std::uint32_t sink = graph_.sink[v.index()];
    if (graph_.step[v.index()].kind != Step::Stay || sink == SinkId::kInvalid) return graph_.next[v.index()];
    const VertexId overflow = spilling_.overflow[sink];
    const bool goes_on = overflow.valid() && graph_.flats.on_rim[overflow.index()] == 0;
    return goes_on ? graph_.node_of(overflow) : kNoNode;
  }

  void settle(FlowNode node) {
    if (how_often_[node] > 1) ++highest_[node];
    const bool channel = !graph_.is_vertex(node) && !tin_.on_rim(HalfedgeId{node});
    if (channel && highest_[node] == 0 && area_[node] >= min_area_ && area_[node] > 0) highest_[node] = 1;
  }

  void pass_on(FlowNode from, FlowNode to) {
    area_[to] += area_[from];
    if (highest_[from] == 0 || highest_[from] < highest_[to]) return;
    how_often_[to] =
        highest_[from] > highest_[to] ? 1 : static_cast<std::uint8_t>(std::min(how_often_[to] + 1, 2));
    highest_[to] = highest_[from];
  }

  const FlowGraph& graph_;
  const Spilling& spilling_;
  const Tin& tin_;
  double min_area_;
  std::vector<double> area_;
  std::vector<std::uint32_t> waiting_;
  std::vector<std::uint8_t> highest_, how_often_;
};

}  // namespace

std::vector<Reach> find_network(const SurfaceFlow& flow, const Spilling& spilling, double min_area,
                                Progress& progress) {
  progress.start_phase("find network");
  const FlowGraph& graph = flow.graph();
  const Tin& tin = graph.tin;
  Accumulator sums(graph, spilling, min_area);
  sums.run(progress);
  progress.advance(0.7);
  std::vector<Reach> network;
  const auto vertex_point = [&](VertexId v) {
    return FlowPoint{.xy = tin.point(v), .z = tin.height(v), .edge = {}, .along = 0, .vertex = v};
  };
  for (std::size_t i = 0; i < tin.halfedge_count(); ++i) {
    const HalfedgeId h{i};
    if (graph.channel[i] == 0 || !tin.represents_edge(h) || tin.on_rim(h)) continue;
    const auto node = static_cast<FlowNode>(i);
    if (sums.strahler(node) == 0) continue;
    const VertexId low = graph.low_end(h), high = low == tin.origin(h) ? tin.target(h) : tin.origin(h);
    network.push_back({.points = {vertex_point(high), vertex_point(low)},
                       .channel = h,
                       .area = sums.area(node),
                       .strahler = sums.strahler(node),
                       .sink = spilling.end[graph.sink_of_node(node)]});
  }
  for (std::size_t i = 0; i < tin.vertex_count(); ++i) {
    const VertexId v{i};
    const FlowNode node = graph.node_of(v);
    const VertexStep& step = graph.step[i];
    if (sums.strahler(node) == 0 || (step.kind != Step::Cross && step.kind != Step::Edge)) continue;
    const FlowNode next = graph.next[i];
    if (step.kind == Step::Edge && !graph.is_vertex(next)) continue;  // the channel starts here
    network.push_back({.points = flow.leg_from(v).points,
                       .channel = {},
                       .area = sums.area(node),
                       .strahler = sums.strahler(node),
                       .sink = spilling.end[graph.sink[i]]});
  }
  progress.advance(1);
  return network;
}

}  // namespace thalweg
