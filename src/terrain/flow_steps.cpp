// Where the water of each vertex goes, and where it ends.
//
// 1. On a plateau: as resolve_flats says. Else the steepest way down that find_falls found. If it crosses a
//    triangle, sweep_grounds has told what the line comes to beyond the side across.
// 2. Rounding could name something that is not lower where all is level but for the last digits; then the
//    lowest neighbour is next. So from each vertex the next one is lower, or of smaller rank, and chains end.
// 3. The rim by itself: runs of level rim edges, and the rim vertices of one boundary pit, are one; each
//    falls to its lowest neighbour on the rim, or is an outlet.
#include "base/parallel.hpp"
#include "base/union_find.hpp"
#include "terrain/flow_graph.hpp"

#include <algorithm>
#include <tuple>

namespace thalweg {

namespace {

using Kind = VertexStep::Kind;

constexpr std::size_t kBlock = 8192;

class StepFinder {
 public:
  explicit StepFinder(FlowGraph& graph) : graph_(graph), mesh_(graph.mesh) {}

  void find(VertexId v) const {
    VertexStep& step = graph_.step[v.index()];
    FlowNode& next = graph_.next[v.index()];
    next = kNoNode;
    if (step.kind == Kind::Stay) return;
    const bool falls = step.squared_slope >= 0;
    if (step.kind == Kind::Edge && falls && mesh_.on_rim(step.edge) && graph_.fall(step.edge) == Fall::Out) {
      step.kind = Kind::Leave;
      return;
    }
    if (step.kind == Kind::Cross) {
      next = graph_.target[step.edge.index()];
      if (is_below(v, next)) return;
      step = to_lowest_neighbour(v);
    }
    next = node_along(v, step);
  }

 private:
  [[nodiscard]] FlowNode node_along(VertexId v, const VertexStep& step) const {
    const VertexId neighbour = graph_.neighbour(v, step);
    if (graph_.is_channel(step.edge) && !mesh_.on_rim(step.edge)) {
      const FlowNode channel = graph_.node_of_channel(step.edge);
      if (graph_.channel_of(channel).low == neighbour) return channel;
    }
    return graph_.node_of(neighbour);
  }

  [[nodiscard]] bool is_below(VertexId v, FlowNode node) const {
    VertexId end;
    if (graph_.is_vertex(node)) {
      end = graph_.vertex_of(node);
    } else {
      const Channel& channel = graph_.channel_of(node);
      if (channel.on_rim) return true;  // leaves
      end = channel.low;
    }
    return mesh_.height(end) < mesh_.height(v);
  }

  [[nodiscard]] VertexStep to_lowest_neighbour(VertexId v) const {
    const auto key = [&](VertexId w) { return std::tuple(mesh_.height(w), mesh_.point(w)); };
    VertexId lowest = v;
    VertexStep step{.kind = Kind::Edge};
    mesh_.for_each_neighbour(v, graph_.step[v.index()].edge, [&](VertexId w, HalfedgeId edge) {
      if (!(key(w) < key(lowest))) return;
      lowest = w;
      step.edge = edge;
    });
    return step;
  }

  FlowGraph& graph_;
  const FlowMesh& mesh_;
};

/// Where the rim leads by itself. Runs are named by the places of their vertices in `vertices_`.
class RimOutlets {
 public:
  explicit RimOutlets(FlowGraph& graph)
      : graph_(graph), mesh_(graph.mesh), place_(number_vertices()), runs_(vertices_.size()) {
    boundary_pit_.resize(graph.flats.pits.size());
    for (const HalfedgeId h : graph_.rim) {
      const VertexId a = mesh_.origin(h), b = mesh_.target(h);
      if (mesh_.height(a) == mesh_.height(b)) runs_.unite(place_[a.index()], place_[b.index()]);
      if (const std::uint32_t pit = graph.flats.pit[a.index()]; pit != kNoPit) {
        if (!boundary_pit_[pit].valid()) boundary_pit_[pit] = a;
        runs_.unite(place_[a.index()], place_[boundary_pit_[pit].index()]);
      }
    }
  }

  void fill() {
    const std::size_t n = vertices_.size();
    std::vector<VertexId> falls_to(n), first(n);
    for (const HalfedgeId h : graph_.rim) {
      for (const auto& [v, w] :
           {std::pair(mesh_.origin(h), mesh_.target(h)), std::pair(mesh_.target(h), mesh_.origin(h))}) {
        const std::uint32_t run = run_of(v);
        if (!first[run].valid() || mesh_.point(v) < mesh_.point(first[run])) first[run] = v;
        if (!(mesh_.height(w) < mesh_.height(v))) continue;
        VertexId& lowest = falls_to[run];
        if (!lowest.valid() || std::tuple(mesh_.height(w), mesh_.point(w)) <
                                   std::tuple(mesh_.height(lowest), mesh_.point(lowest))) {
          lowest = w;
        }
      }
    }
    std::vector<std::uint32_t> sink_of_run(n, SinkId::kInvalid);
    std::vector<std::uint32_t> chain;
    for (const HalfedgeId h : graph_.rim) {
      std::uint32_t run = run_of(mesh_.origin(h));
      chain.clear();
      while (sink_of_run[run] == SinkId::kInvalid && falls_to[run].valid()) {
        chain.push_back(run);
        run = run_of(falls_to[run]);
      }
      if (sink_of_run[run] == SinkId::kInvalid) {
        sink_of_run[run] = static_cast<std::uint32_t>(graph_.sinks.size());
        graph_.sinks.push_back({.kind = Sink::Kind::Outlet, .vertex = mesh_.given(first[run])});
      }
      for (const std::uint32_t passed : chain) sink_of_run[passed] = sink_of_run[run];
    }
    graph_.rim_sink = std::move(place_);
    for (std::uint32_t i = 0; i < n; ++i) graph_.rim_sink[vertices_[i].index()] = sink_of_run[runs_.find(i)];
  }

  /// A vertex on the rim of each boundary pit.
  [[nodiscard]] const std::vector<VertexId>& boundary_pits() const { return boundary_pit_; }

 private:
  /// By the TIN's numbers of halfedges, so that outlets have the same order whatever those of the mesh.
  LargeVector<std::uint32_t> number_vertices() {
    if (!mesh_.same()) {
      std::sort(graph_.rim.begin(), graph_.rim.end(),
                [&](HalfedgeId g, HalfedgeId h) { return mesh_.given(g) < mesh_.given(h); });
    }
    LargeVector<std::uint32_t> place(mesh_.vertex_count(), SinkId::kInvalid);
    for (const HalfedgeId h : graph_.rim) {
      for (const VertexId v : {mesh_.origin(h), mesh_.target(h)}) {
        if (place[v.index()] != SinkId::kInvalid) continue;
        place[v.index()] = static_cast<std::uint32_t>(vertices_.size());
        vertices_.push_back(v);
      }
    }
    return place;
  }

  [[nodiscard]] std::uint32_t run_of(VertexId v) { return runs_.find(place_[v.index()]); }

  FlowGraph& graph_;
  const FlowMesh& mesh_;
  std::vector<VertexId> vertices_;
  LargeVector<std::uint32_t> place_;  // by vertex
  UnionFind runs_;
  std::vector<VertexId> boundary_pit_;
};

/// Where each vertex' chain of steps ends; those with a sink are left as they are.
void follow_chains(FlowGraph& graph) {
  std::vector<VertexId> chain;
  for (std::size_t start = 0; start < graph.mesh.vertex_count(); ++start) {
    std::uint32_t end = SinkId::kInvalid;
    chain.clear();
    for (VertexId v{start};;) {
      end = graph.sink[v.index()];
      if (end != SinkId::kInvalid) break;
      const VertexStep::Kind kind = graph.step[v.index()].kind;
      if (kind == Kind::Stay) break;  // in no triangle
      chain.push_back(v);
      const FlowNode next = graph.next[v.index()];
      if (kind == Kind::Leave) {
        end = graph.rim_sink[v.index()];
        break;
      }
      if (graph.is_vertex(next)) {
        v = graph.vertex_of(next);
        continue;
      }
      const Channel& channel = graph.channel_of(next);
      v = channel.low;
      if (!channel.on_rim) continue;
      end = graph.rim_sink[v.index()];
      break;
    }
    for (const VertexId v : chain) graph.sink[v.index()] = end;
  }
}

}  // namespace

void find_steps(FlowGraph& graph, const Progress& progress) {
  graph.next.resize(graph.mesh.vertex_count());
  const StepFinder finder(graph);
  for_each_block(graph.mesh.vertex_count(), kBlock, progress, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) finder.find(VertexId{v});
  });
}

void find_sinks(FlowGraph& graph, std::span<const VertexId> outlets) {
  const std::size_t n = graph.mesh.vertex_count();
  std::vector<std::uint32_t> of_pit;
  for (const PitSite& pit : graph.flats.pits) {
    of_pit.push_back(static_cast<std::uint32_t>(graph.sinks.size()));
    if (pit.kind == PitKind::Boundary) continue;
    const Sink::Kind kind = pit.kind == PitKind::Lake ? Sink::Kind::Lake : Sink::Kind::Pit;
    graph.sinks.push_back({.kind = kind, .vertex = graph.mesh.given(pit.vertex), .vertices = pit.vertices});
  }
  graph.sink.assign(n, SinkId::kInvalid);
  for (const VertexId v : outlets) {
    if (graph.sink[v.index()] != SinkId::kInvalid) continue;  // named twice
    graph.sink[v.index()] = static_cast<std::uint32_t>(graph.sinks.size());
    graph.sinks.push_back({.kind = Sink::Kind::Given, .vertex = graph.mesh.given(v)});
  }
  RimOutlets rim(graph);
  rim.fill();
  for (std::size_t v = 0; v < n; ++v) {
    const std::uint32_t pit = graph.flats.pit[v];
    if (pit == kNoPit) continue;
    const bool boundary = graph.flats.pits[pit].kind == PitKind::Boundary;
    graph.sink[v] = boundary ? graph.rim_sink[rim.boundary_pits()[pit].index()] : of_pit[pit];
  }
  follow_chains(graph);
}

}  // namespace thalweg
