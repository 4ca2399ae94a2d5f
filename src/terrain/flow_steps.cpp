// Where the water of each vertex goes, and where it ends.
//
// 1. On a plateau: as resolve_flats says. Else the steepest of all edges that fall, and of all triangles
// whose
//    line of flow from the vertex lies inside (water enters over both sides at the vertex). If a triangle is
//    the steepest, the pieces of its far side tell what the line comes to.
// 2. Rounding could name something that is not lower where all is level but for the last digits; then the
//    lowest neighbour is next. So from each vertex the next one is lower, or of smaller rank, and chains end.
// 3. The rim by itself: runs of level rim edges, and the rim vertices of one boundary pit, are one; each
// falls
//    to its lowest neighbour on the rim, or is an outlet.
#include "base/parallel.hpp"
#include "base/union_find.hpp"
#include "terrain/flow_graph.hpp"

#include <thalweg/base/error.hpp>

#include <algorithm>
#include <cmath>
#include <tuple>

namespace thalweg {

namespace {

constexpr std::size_t kBlock = 8192;

double squared_slope(const Tin& tin, VertexId from, VertexId to) {
  const double x = tin.point(to).x - tin.point(from).x, y = tin.point(to).y - tin.point(from).y;
  const double z = tin.height(to) - tin.height(from);
  return z * z / (x * x + y * y);
}

double squared_slope(const Tin& tin, TriangleId t) {
  const Triangle& c = tin.triangle(t);
  const Point2 o = tin.point(c[0]);
  const double x1 = tin.point(c[1]).x - o.x, y1 = tin.point(c[1]).y - o.y;
  const double x2 = tin.point(c[2]).x - o.x, y2 = tin.point(c[2]).y - o.y;
  const double z1 = tin.height(c[1]) - tin.height(c[0]), z2 = tin.height(c[2]) - tin.height(c[0]);
  const double x = z1 * y2 - z2 * y1, y = x1 * z2 - x2 * z1, area = x1 * y2 - x2 * y1;
  return (x * x + y * y) / (area * area);
}

class StepFinder {
 public:
  explicit StepFinder(FlowGraph& graph) : graph_(graph), tin_(graph.tin) {}

  void find(VertexId v, bool given) const {
    VertexStep& step = graph_.step[v.index()];
    if (given || graph_.flats.pit[v.index()] != kNoPit || tin_.outgoing(v).empty()) return;
    step = graph_.flats.rank[v.index()] > 0
               ? VertexStep{.kind = Step::Edge, .neighbour = graph_.flats.toward[v.index()]}
               : steepest(v);
    graph_.next[v.index()] = node_of(v, step);
    if (step.kind == Step::Leave || is_below(v, graph_.next[v.index()])) return;
    step = {.kind = Step::Edge, .neighbour = lowest_neighbour(v)};
    graph_.next[v.index()] = graph_.node_of(step.neighbour);
  }

 private:
  struct Best {
    double slope = -1;
    Point2 end;
    VertexStep step;
  };

  static void offer(Best& best, double slope, Point2 end, const VertexStep& step) {
    if (slope < best.slope || (slope == best.slope && best.end < end)) return;
    best = {slope, end, step};
  }

  void offer_edge(Best& best, VertexId v, VertexId w, HalfedgeId edge) const {
    if (!(tin_.height(w) < tin_.height(v))) return;
    const bool leaves = tin_.on_rim(edge) && graph_.drains(edge);
    offer(best, squared_slope(tin_, v, w), tin_.point(w),
          {.kind = leaves ? Step::Leave : Step::Edge, .neighbour = w});
  }

  VertexStep steepest(VertexId v) const {
    Best best;
    for (const HalfedgeId out : tin_.outgoing(v)) {
      const HalfedgeId in = Tin::previous(out);
      offer_edge(best, v, tin_.target(out), out);
      if (tin_.on_rim(in)) offer_edge(best, v, tin_.origin(in), in);
      if (graph_.fall[out.index()] != Fall::In || graph_.fall[in.index()] != Fall::In) continue;
      const TriangleId t = Tin::triangle_of(out);
      const Strip strip = graph_.strip_of(t);  // two In sides: it splits the far side
      offer(best, squared_slope(tin_, t), std::min(tin_.point(tin_.target(out)), tin_.point(tin_.origin(in))),
            {.kind = Step::Cross, .across = strip.split, .at = strip.at});
    }
    return best.step;
  }

  FlowNode node_of(VertexId v, const VertexStep& step) const {
    if (step.kind == Step::Cross) return graph_.node_beyond(step.across, step.at);
    if (step.kind != Step::Edge) return kNoNode;
    HalfedgeId h = tin_.find_halfedge(v, step.neighbour);
    if (!h.valid()) h = tin_.find_halfedge(step.neighbour, v);
    const bool runs_down =
        graph_.channel[h.index()] != 0 && !tin_.on_rim(h) && graph_.low_end(h) == step.neighbour;
    return runs_down ? graph_.node_of_channel(h) : graph_.node_of(step.neighbour);
  }

  bool is_below(VertexId v, FlowNode node) const {
    if (node == kNoNode) return false;
    if (!graph_.is_vertex(node) && tin_.on_rim(HalfedgeId{node})) return true;  // leaves
    const VertexId end = graph_.is_vertex(node) ? graph_.vertex_of(node) : graph_.low_end(HalfedgeId{node});
    return std::tuple(tin_.height(end), graph_.flats.rank[end.index()]) <
           std::tuple(tin_.height(v), graph_.flats.rank[v.index()]);
  }

  VertexId lowest_neighbour(VertexId v) const {
    VertexId lowest = v;
    const auto offer_vertex = [&](VertexId w) {
      if (std::tuple(tin_.height(w), tin_.point(w)) < std::tuple(tin_.height(lowest), tin_.point(lowest))) {
        lowest = w;
      }
    };
    for (const HalfedgeId out : tin_.outgoing(v)) {
      offer_vertex(tin_.target(out));
      offer_vertex(tin_.origin(Tin::previous(out)));
    }
    return lowest;
  }

  FlowGraph& graph_;
  const Tin& tin_;
};

/// Where the rim leads by itself.
class RimOutlets {
 public:
  explicit RimOutlets(FlowGraph& graph) : graph_(graph), tin_(graph.tin), runs_(tin_.vertex_count()) {
    std::vector<VertexId> of_pit(graph.flats.pits.size());
    for (std::size_t i = 0; i < tin_.halfedge_count(); ++i) {
      const HalfedgeId h{i};
      if (!tin_.on_rim(h)) continue;
      const VertexId a = tin_.origin(h), b = tin_.target(h);
      rim_.push_back(h);
      if (tin_.height(a) == tin_.height(b)) runs_.unite(a.value(), b.value());
      if (const std::uint32_t pit = graph.flats.pit[a.index()]; pit != kNoPit) {
        if (!of_pit[pit].valid()) of_pit[pit] = a;
        runs_.unite(a.value(), of_pit[pit].value());
      }
    }
    boundary_pit_ = std::move(of_pit);
  }

  void fill() {
    const std::size_t n = tin_.vertex_count();
    std::vector<VertexId> falls_to(n), first(n);
    for (const HalfedgeId h : rim_) {
      for (const auto& [v, w] :
           {std::pair(tin_.origin(h), tin_.target(h)), std::pair(tin_.target(h), tin_.origin(h))}) {
        const std::uint32_t run = runs_.find(v.value());
        if (!first[run].valid() || tin_.point(v) < tin_.point(first[run])) first[run] = v;
        if (!(tin_.height(w) < tin_.height(v))) continue;
        VertexId& lowest = falls_to[run];
        if (!lowest.valid() ||
            std::tuple(tin_.height(w), tin_.point(w)) < std::tuple(tin_.height(lowest), tin_.point(lowest))) {
          lowest = w;
        }
      }
    }
    std::vector<std::uint32_t> sink_of_run(n, SinkId::kInvalid);
    std::vector<std::uint32_t> chain;
    for (const HalfedgeId h : rim_) {
      std::uint32_t run = runs_.find(tin_.origin(h).value());
      chain.clear();
      while (sink_of_run[run] == SinkId::kInvalid && falls_to[run].valid()) {
        chain.push_back(run);
        run = runs_.find(falls_to[run].value());
      }
      if (sink_of_run[run] == SinkId::kInvalid) {
        sink_of_run[run] = static_cast<std::uint32_t>(graph_.sinks.size());
        graph_.sinks.push_back({.kind = Sink::Kind::Outlet, .vertex = first[run]});
      }
      for (const std::uint32_t passed : chain) sink_of_run[passed] = sink_of_run[run];
    }
    graph_.rim_sink.assign(n, SinkId::kInvalid);
    for (const HalfedgeId h : rim_) {
      for (const VertexId v : {tin_.origin(h), tin_.target(h)}) {
        graph_.rim_sink[v.index()] = sink_of_run[runs_.find(v.value())];
      }
    }
  }

  /// A vertex on the rim of each boundary pit.
  [[nodiscard]] const std::vector<VertexId>& boundary_pits() const { return boundary_pit_; }

 private:
  FlowGraph& graph_;
  const Tin& tin_;
  UnionFind runs_;
  std::vector<HalfedgeId> rim_;
  std::vector<VertexId> boundary_pit_;
};

}  // namespace

void find_steps(FlowGraph& graph, std::span<const VertexId> outlets, const Progress& progress) {
  const std::size_t n = graph.tin.vertex_count();
  std::vector<std::uint8_t> given(n, 0);
  for (const VertexId v : outlets) given[v.index()] = 1;
  graph.step.assign(n, {});
  graph.next.assign(n, kNoNode);
  const StepFinder finder(graph);
  for_each_block(n, kBlock, progress, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) finder.find(VertexId{v}, given[v] != 0);
  });
}

void find_sinks(FlowGraph& graph, std::span<const VertexId> outlets) {
  const Tin& tin = graph.tin;
  const std::size_t n = tin.vertex_count();
  std::vector<std::uint32_t> of_pit;
  for (const PitSite& pit : graph.flats.pits) {
    of_pit.push_back(static_cast<std::uint32_t>(graph.sinks.size()));
    if (pit.kind == PitKind::Boundary) continue;
    const Sink::Kind kind = pit.kind == PitKind::Lake ? Sink::Kind::Lake : Sink::Kind::Pit;
    graph.sinks.push_back({.kind = kind, .vertex = pit.vertex, .vertices = pit.vertices});
  }
  graph.sink.assign(n, SinkId::kInvalid);
  for (const VertexId v : outlets) {
    if (graph.sink[v.index()] != SinkId::kInvalid) continue;  // named twice
    graph.sink[v.index()] = static_cast<std::uint32_t>(graph.sinks.size());
    graph.sinks.push_back({.kind = Sink::Kind::Given, .vertex = v});
  }
  RimOutlets rim(graph);
  rim.fill();
  for (std::size_t v = 0; v < n; ++v) {
    const std::uint32_t pit = graph.flats.pit[v];
    if (pit == kNoPit) continue;
    const bool boundary = graph.flats.pits[pit].kind == PitKind::Boundary;
    graph.sink[v] = boundary ? graph.rim_sink[rim.boundary_pits()[pit].index()] : of_pit[pit];
  }
  std::vector<std::size_t> chain;
  for (std::size_t start = 0; start < n; ++start) {
    if (tin.outgoing(VertexId{start}).empty()) continue;
    std::uint32_t end = SinkId::kInvalid;
    chain.clear();
    for (std::size_t v = start; end == SinkId::kInvalid;) {
      end = graph.sink[v];
      if (end != SinkId::kInvalid) break;
      chain.push_back(v);
      const FlowNode next = graph.next[v];
      if (next == kNoNode) {
        end = graph.rim_sink[v];
      } else if (graph.is_vertex(next)) {
        v = graph.vertex_of(next).index();
      } else if (tin.on_rim(HalfedgeId{next})) {
        end = graph.rim_sink[graph.low_end(HalfedgeId{next}).index()];
      } else {
        v = graph.low_end(HalfedgeId{next}).index();
      }
    }
    for (const std::size_t v : chain) graph.sink[v] = end;
  }
}

}  // namespace thalweg
