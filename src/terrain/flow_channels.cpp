// Channels.
//
// 1. An edge is a channel if a triangle drains into it and none beyond takes the water in. Channels are
//    numbered by halfedge.
// 2. Whether triangles hand water round in a cycle. Let w be the lowest corner of a triangle, by height,
//    then (x, y). Over a side at w it hands water to one whose lowest corner is no higher. In a cycle of
//    such steps alone all have the same w and turn about it; but then the surface falls all the way round,
//    which it cannot. So a cycle has a step over a side opposite of w (which takes an obtuse angle, where
//    two Out sides meet: find_falls lists such triangles), and one of these is at the lowest w of the
//    cycle. From each such step all is looked through to which water is handed on before it comes to a
//    lower corner: a few triangles.
// 3. If that comes back, or takes long, triangles are passed in an order in which each comes after those that
//    it hands water to: each counts how many it waits for. What is left then waits for itself in a cycle: an
//    edge of one is made a channel, and so on.
#include "base/parallel.hpp"
#include "terrain/flow_graph.hpp"

#include <algorithm>
#include <atomic>
#include <vector>

namespace thalweg {

namespace {

constexpr std::size_t kBlock = 8192;

/// Marks channels and inflow; of each block of triangles the halfedges that stand for a channel.
std::vector<std::vector<HalfedgeId>> mark_channels(FlowGraph& graph, const Progress& progress) {
  const FlowMesh& mesh = graph.mesh;
  std::vector<std::vector<HalfedgeId>> found(mesh.triangle_count() / kBlock + 1);
  for_each_block(mesh.triangle_count(), kBlock, progress, [&](std::size_t begin, std::size_t end) {
    std::vector<HalfedgeId> here(3 * (end - begin));
    std::size_t count = 0;
    for (std::size_t t = begin; t < end; ++t) {
      const TriangleShape shape = graph.shape[t];
      unsigned channels = 0, meet = 0, inflow = 0;
      for (std::size_t side = 0; side < 3; ++side) {
        const HalfedgeId h = Tin::halfedge(TriangleId{t}, side), twin = mesh.twin(h);
        const Fall fall = shape.fall(side), beyond = twin.valid() ? graph.fall(twin) : Fall::Level;
        const bool drains = (fall >= Fall::Out) | (beyond >= Fall::Out);
        const bool goes_on = (fall == Fall::In) | (beyond == Fall::In);
        const bool channel = drains & !goes_on;
        channels |= (channel ? 1U : 0U) << side;
        here[count] = h;  // without a jump: which edges are channels cannot be foreseen
        count += (channel & (h < twin)) ? 1 : 0;  // no twin is greater than any
        const bool runs_out = fall == Fall::Out, comes_in = beyond == Fall::Out;
        const bool one_ground = ((runs_out | comes_in) & goes_on) | (runs_out & comes_in);
        meet |= ((!one_ground & (h < twin)) ? 1U : 0U) << side;
        inflow |= (((fall == Fall::In) & comes_in) ? 1U : 0U) << side;
      }
      graph.inflow_sides[t] = static_cast<std::uint8_t>(inflow);
      graph.channel_sides[t] = static_cast<std::uint8_t>(channels);
      graph.meeting_sides[t] = static_cast<std::uint8_t>(meet);
    }
    found[begin / kBlock].assign(here.begin(), here.begin() + static_cast<std::ptrdiff_t>(count));
  });
  return found;
}

}  // namespace

void find_channels(FlowGraph& graph, const Progress& progress) {
  const FlowMesh& mesh = graph.mesh;
  graph.channel_sides.resize(mesh.triangle_count());
  graph.inflow_sides.resize(mesh.triangle_count());
  graph.meeting_sides.resize(mesh.triangle_count());
  graph.target.resize(mesh.halfedge_count());
  const std::vector<std::vector<HalfedgeId>> found = mark_channels(graph, progress);
  std::vector<std::size_t> first;
  std::size_t total = 0;
  for (const std::vector<HalfedgeId>& of_block : found) {
    first.push_back(total);
    total += of_block.size();
  }
  graph.channels.resize(total);
  for_each_block(found.size(), 1, progress, [&](std::size_t block, std::size_t /*end*/) {
    std::size_t number = first[block];
    for (const HalfedgeId h : found[block]) {
      const HalfedgeId twin = mesh.twin(h);
      const auto target = static_cast<FlowNode>(number);
      if (graph.drains(h)) graph.target[h.index()] = target;
      if (twin.valid() && graph.drains(twin)) graph.target[twin.index()] = target;
      graph.channels[number++] = {h, graph.low_end(h), !twin.valid()};
    }
  });
}

namespace {

/// By triangle: how many of those that it hands water to are not passed.
using Waiting = RawVector<std::uint8_t>;

std::uint8_t count_awaited(const FlowGraph& graph, TriangleId t) {
  unsigned count = 0;
  for (std::size_t side = 0; side < 3; ++side) {
    count += graph.hands_on(Tin::halfedge(t, side)) ? 1 : 0;
  }
  return static_cast<std::uint8_t>(count);
}

/// Passes all triangles from `start`, which waits for none, upwards, but those that wait for others.
void pass_from(TriangleId start, const FlowGraph& graph, Waiting& waiting) {
  std::vector<TriangleId> ready = {start};
  while (!ready.empty()) {
    const TriangleId t = ready.back();
    ready.pop_back();
    for (std::size_t side = 0; side < 3; ++side) {
      if ((graph.inflow_sides[t.index()] >> side & 1U) == 0) continue;
      const TriangleId up = Tin::triangle_of(graph.mesh.twin(Tin::halfedge(t, side)));
      if (--waiting[up.index()] == 0) ready.push_back(up);
    }
  }
}

/// Looks for cycles that begin with given steps.
class CycleSearch {
 public:
  explicit CycleSearch(const FlowGraph& graph) : graph_(graph), mesh_(graph.mesh) {}

  /// False only if no cycle has the triangle's step over the side opposite of its lowest corner, and that as
  /// its lowest one.
  [[nodiscard]] bool may_begin_cycle(TriangleId t) {
    const TriangleShape shape = graph_.shape[t.index()];
    if (shape.corner_is_low == 0) return false;  // then the lowest corner is on the only Out side
    const HalfedgeId split = Tin::halfedge(t, shape.split);
    const VertexId lowest = lowest_corner(t);
    if (lowest == mesh_.apex(split)) return false;
    const HalfedgeId over = lowest == mesh_.origin(split) ? Tin::next(split) : Tin::previous(split);
    return graph_.hands_on(over) && may_return(over, lowest);
  }

 private:
  static constexpr std::size_t kMostSteps = 256;

  [[nodiscard]] bool is_lower(VertexId v, VertexId w) const {
    const double p = mesh_.height(v), q = mesh_.height(w);
    return p != q ? p < q : mesh_.point(v) < mesh_.point(w);
  }
  [[nodiscard]] VertexId lowest_corner(TriangleId t) const {
    const Triangle& c = mesh_.triangle(t);
    const VertexId v = is_lower(c[1], c[0]) ? c[1] : c[0];
    return is_lower(c[2], v) ? c[2] : v;
  }

  /// Whether water that runs over `over` may come back to its triangle without coming below `lowest`.
  [[nodiscard]] bool may_return(HalfedgeId over, VertexId lowest) {
    reached_.assign(1, Tin::triangle_of(mesh_.twin(over)));
    for (std::size_t next = 0; next < reached_.size(); ++next) {
      const TriangleId t = reached_[next];
      if (t == Tin::triangle_of(over) || next == kMostSteps) return true;
      if (is_lower(lowest_corner(t), lowest)) continue;
      for (std::size_t side = 0; side < 3; ++side) {
        const HalfedgeId h = Tin::halfedge(t, side);
        if (!graph_.hands_on(h)) continue;
        const TriangleId beyond = Tin::triangle_of(mesh_.twin(h));
        if (std::find(reached_.begin(), reached_.end(), beyond) == reached_.end()) reached_.push_back(beyond);
      }
    }
    return false;
  }

  const FlowGraph& graph_;
  const FlowMesh& mesh_;
  std::vector<TriangleId> reached_;
};

/// False only if there is none.
bool may_have_cycle(const FlowGraph& graph, const Progress& progress) {
  std::atomic<bool> may{false};
  for_each_block(graph.obtuse.size(), kBlock, progress, [&](std::size_t begin, std::size_t end) {
    CycleSearch search(graph);
    for (std::size_t i = begin; i < end && !may.load(std::memory_order_relaxed); ++i) {
      if (search.may_begin_cycle(graph.obtuse[i])) may = true;
    }
  });
  return may;
}

/// Makes a channel of an edge of a cycle to which one comes from `t`, over sides that are awaited; returns
/// the triangle that waited for it, perhaps for one in another cycle too.
TriangleId break_cycle(FlowGraph& graph, Waiting& waiting, TriangleId t) {
  std::vector<std::uint8_t> passed(waiting.size(), 0);
  for (;;) {
    passed[t.index()] = 1;
    HalfedgeId over;
    for (std::size_t side = 0; side < 3; ++side) {
      const HalfedgeId h = Tin::halfedge(t, side);
      if (graph.hands_on(h) && waiting[Tin::triangle_of(graph.mesh.twin(h)).index()] != 0) over = h;
    }
    const HalfedgeId twin = graph.mesh.twin(over);
    const TriangleId next = Tin::triangle_of(twin);
    if (passed[next.index()] == 0) {
      t = next;
      continue;
    }
    for (const HalfedgeId h : {over, twin}) {
      graph.channel_sides[h.index() / 3] |= static_cast<std::uint8_t>(1U << (h.index() % 3));
    }
    const HalfedgeId least = std::min(over, twin);
    graph.meeting_sides[least.index() / 3] |= static_cast<std::uint8_t>(1U << (least.index() % 3));
    graph.inflow_sides[next.index()] &= static_cast<std::uint8_t>(~(1U << (twin.index() % 3)));
    graph.target[over.index()] = static_cast<FlowNode>(graph.node_count());
    graph.channels.push_back({least, graph.low_end(over), false});
    ++graph.broken_cycles;
    --waiting[t.index()];
    return t;
  }
}

}  // namespace

void break_cycles(FlowGraph& graph, const Progress& progress) {
  if (!may_have_cycle(graph, progress)) return;
  const std::size_t count = graph.mesh.triangle_count();
  Waiting waiting(count);
  std::vector<TriangleId> start;
  for (std::size_t t = 0; t < count; ++t) {
    waiting[t] = count_awaited(graph, TriangleId{t});
    if (waiting[t] == 0) start.emplace_back(t);
  }
  progress.check();
  for (const TriangleId t : start) pass_from(t, graph, waiting);
  for (std::size_t t = 0; t < count; ++t) {
    while (waiting[t] != 0) {
      const TriangleId freed = break_cycle(graph, waiting, TriangleId{t});
      if (waiting[freed.index()] == 0) pass_from(freed, graph, waiting);
    }
  }
}

}  // namespace thalweg
