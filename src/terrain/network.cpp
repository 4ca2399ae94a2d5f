// The network: channels and vertices are a forest (each sends its water to one other), so areas and orders
// are added up from the leaves down, in one pass over nodes that wait for no other.
#include "base/parallel.hpp"
#include "terrain/flow_graph.hpp"

#include <thalweg/terrain/network.hpp>

#include <algorithm>
#include <cstdint>
#include <utility>

namespace thalweg {

namespace {

/// The halfedge that stands for the edge in the TIN.
HalfedgeId given_edge(const FlowGraph& graph, HalfedgeId h) {
  const HalfedgeId twin = graph.mesh.twin(h);
  return twin.valid() ? std::min(graph.mesh.given(h), graph.mesh.given(twin)) : graph.mesh.given(h);
}

class Accumulator {
 public:
  Accumulator(const SurfaceFlow& flow, const Spilling& spilling, double min_area)
      : flow_(flow),
        graph_(flow.graph()),
        spilling_(spilling),
        min_area_(min_area),
        below_(graph_.node_count()),
        area_(graph_.ground),
        waiting_(graph_.node_count(), 0),
        highest_(graph_.node_count(), 0),
        how_often_(graph_.node_count(), 0) {}

  void run(Progress& progress) {
    const auto count = static_cast<FlowNode>(graph_.node_count());
    for_each_block(count, kBlock, progress, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) below_[i] = below(static_cast<FlowNode>(i));
    });
    for (const HalfedgeId side : graph_.touching) pass_end(side);
    for (const FlowNode next : below_) {
      if (next != kNoNode) ++waiting_[next];
    }
    progress.advance(0.3);
    for (FlowNode node = 0; node < count; ++node) {
      if (waiting_[node] != 0) continue;
      if (node % (1U << 16U) == 0) progress.check();
      for (FlowNode at = node; at != kNoNode;) {
        const FlowNode next = below_[at];
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
  static constexpr std::size_t kBlock = 8192;

  [[nodiscard]] FlowNode below(FlowNode node) const {
    if (graph_.is_vertex(node)) return below(graph_.vertex_of(node));
    const Channel& channel = graph_.channel_of(node);
    return channel.on_rim ? kNoNode : graph_.node_of(channel.low);
  }

  [[nodiscard]] FlowNode below(VertexId v) const {
    const std::uint32_t sink = graph_.sink[v.index()];
    if (graph_.step[v.index()].kind != VertexStep::Kind::Stay || sink == SinkId::kInvalid) {
      return graph_.next[v.index()];
    }
    if (!spilling_.overflow[sink].valid()) return kNoNode;
    const VertexId overflow = graph_.mesh.own(spilling_.overflow[sink]);
    return graph_.flats.on_rim[overflow.index()] == 0 ? graph_.node_of(overflow) : kNoNode;
  }

  /// What comes across triangles exactly to the vertex at which a channel ends is not in the channel.
  void pass_end(HalfedgeId side) {
    const VertexId v = graph_.mesh.target(Tin::next(side));
    const VertexStep& step = graph_.step[v.index()];
    const FlowNode from = graph_.node_of(v), to = below_[from];
    if (step.kind != VertexStep::Kind::Cross || step.edge != side || to == kNoNode || graph_.is_vertex(to))
      return;
    const auto& [edge, low, on_rim] = graph_.channel_of(to);
    if (on_rim) return;  // it leaves there
    const FlowPath leg = flow_.leg_from(graph_.mesh.given(v));
    if (leg.points.back().xy == graph_.mesh.point(low)) below_[from] = graph_.node_of(low);
  }

  void settle(FlowNode node) {
    if (how_often_[node] > 1) ++highest_[node];
    if (highest_[node] != 0 || !(area_[node] >= min_area_ && area_[node] > 0) || graph_.is_vertex(node))
      return;
    if (!graph_.channel_of(node).on_rim) highest_[node] = 1;
  }

  void pass_on(FlowNode from, FlowNode to) {
    area_[to] += area_[from];
    if (highest_[from] == 0 || highest_[from] < highest_[to]) return;
    how_often_[to] =
        highest_[from] > highest_[to] ? 1 : static_cast<std::uint8_t>(std::min(how_often_[to] + 1, 2));
    highest_[to] = highest_[from];
  }

  const SurfaceFlow& flow_;
  const FlowGraph& graph_;
  const Spilling& spilling_;
  double min_area_;
  RawVector<FlowNode> below_;  // by node: what it sends its water to
  RawVector<double> area_;
  LargeVector<std::uint32_t> waiting_;
  LargeVector<std::uint8_t> highest_, how_often_;
};

/// The nodes of which reaches are made: channels, then vertices, each by their numbers in the TIN.
std::vector<FlowNode> list_reaches(const FlowGraph& graph, const Accumulator& sums) {
  std::vector<FlowNode> nodes;
  const auto add = [&](FlowNode node) {
    if (sums.strahler(node) > 0) nodes.push_back(node);
  };
  const auto count = static_cast<FlowNode>(graph.node_count());
  for (FlowNode node = 0; node < count; ++node) {
    if (!graph.is_vertex(node)) add(node);
  }
  const auto channels = static_cast<std::ptrdiff_t>(nodes.size());
  for (std::size_t v = 0; v < graph.mesh.vertex_count(); ++v) add(graph.node_of(VertexId{v}));
  if (graph.mesh.same() && graph.broken_cycles == 0) return nodes;
  const auto given = [&](FlowNode node) {
    return graph.is_vertex(node) ? graph.mesh.given(graph.vertex_of(node)).value()
                                 : given_edge(graph, graph.channel_of(node).edge).value();
  };
  const auto before = [&](FlowNode a, FlowNode b) { return given(a) < given(b); };
  std::sort(nodes.begin(), nodes.begin() + channels, before);
  std::sort(nodes.begin() + channels, nodes.end(), before);
  return nodes;
}

}  // namespace

std::vector<Reach> find_network(const SurfaceFlow& flow, const Spilling& spilling, double min_area,
                                Progress& progress) {
  progress.start_phase("find network");
  const FlowGraph& graph = flow.graph();
  const FlowMesh& mesh = graph.mesh;
  Accumulator sums(flow, spilling, min_area);
  sums.run(progress);
  progress.advance(0.7);
  std::vector<Reach> network;
  const auto vertex_point = [&](VertexId v) {
    return FlowPoint{
        .xy = mesh.point(v), .z = mesh.height(v), .along = 0, .edge = {}, .vertex = mesh.given(v)};
  };
  for (const FlowNode node : list_reaches(graph, sums)) {
    Reach reach{.area = sums.area(node), .strahler = sums.strahler(node)};
    if (graph.is_vertex(node)) {
      const VertexId v = graph.vertex_of(node);
      const VertexStep::Kind kind = graph.step[v.index()].kind;
      if (kind != VertexStep::Kind::Cross && kind != VertexStep::Kind::Edge) continue;
      const FlowNode next = graph.next[v.index()];
      if (kind == VertexStep::Kind::Edge && !graph.is_vertex(next)) continue;  // the channel starts here
      reach.points = flow.leg_from(mesh.given(v)).points;
    } else {
      const auto& [edge, low, on_rim] = graph.channel_of(node);
      if (on_rim) continue;
      const VertexId high = low == mesh.origin(edge) ? mesh.target(edge) : mesh.origin(edge);
      reach.points = {vertex_point(high), vertex_point(low)};
      reach.channel = given_edge(graph, edge);
    }
    reach.sink = spilling.end[graph.sink_of_node[node]];
    network.push_back(std::move(reach));
  }
  progress.advance(1);
  return network;
}

}  // namespace thalweg
