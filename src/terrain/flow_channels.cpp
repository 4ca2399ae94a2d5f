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
#include <array>
#include <atomic>
#include <vector>

namespace thalweg {

namespace {

constexpr std::size_t kBlock = 8192;

/// What is to be known of a side of a triangle: one bit each.
constexpr unsigned kChannel = 1, kInflow = 1U << 3U, kMeeting = 1U << 6U, kStands = 1U << 9U;

/// By how the triangle falls over the side, times 8, how the one beyond does, times 2 (none: Level), and 1 if
/// the halfedge stands for the edge; so that there is no jump: all that cannot be foreseen.
constexpr std::array<std::uint16_t, 32> tabulate_sides() {
  std::array<std::uint16_t, 32> table{};
  for (unsigned entry = 0; entry < table.size(); ++entry) {
    const Fall fall{static_cast<std::uint8_t>(entry >> 3U)},
        beyond{static_cast<std::uint8_t>(entry >> 1U & 3U)};
    const bool stands = (entry & 1U) != 0;
    const bool goes_on = fall == Fall::In || beyond == Fall::In;
    const bool channel = (fall >= Fall::Out || beyond >= Fall::Out) && !goes_on;
    const bool runs_out = fall == Fall::Out, comes_in = beyond == Fall::Out;
    const bool one_ground = ((runs_out || comes_in) && goes_on) || (runs_out && comes_in);
    table[entry] = static_cast<std::uint16_t>(
        (channel ? kChannel : 0U) | (fall == Fall::In && comes_in ? kInflow : 0U) |
        (stands && !one_ground ? kMeeting : 0U) | (stands && channel ? kStands : 0U));
  }
  return table;
}

/// Marks channels and inflow; of each block of triangles the halfedges that stand for a channel.
std::vector<std::vector<HalfedgeId>> mark_channels(FlowGraph& graph, const Progress& progress) {
  static constexpr std::array<std::uint16_t, 32> kSides = tabulate_sides();
  const FlowMesh& mesh = graph.mesh;
  std::vector<std::vector<HalfedgeId>> found(mesh.triangle_count() / kBlock + 1);
  for_each_block(mesh.triangle_count(), kBlock, progress, [&](std::size_t begin, std::size_t end) {
    std::vector<HalfedgeId> here(3 * (end - begin));
    std::size_t count = 0;
    for (std::size_t t = begin; t < end; ++t) {
      const unsigned falls = graph.shape[t].falls;
      unsigned sides = 0;
      for (unsigned side = 0; side < 3; ++side) {
        const HalfedgeId h = Tin::halfedge(TriangleId{t}, side), twin = mesh.twin(h);
        const unsigned fall = falls >> (2 * side) & 3U;
        const unsigned beyond = twin.valid() ? static_cast<unsigned>(graph.fall(twin)) : 0U;
        const unsigned entry = kSides[fall << 3U | beyond << 1U | (h < twin ? 1U : 0U)];
        here[count] = h;
        count += entry / kStands;
        sides |= entry << side;
      }
      graph.channel_sides[t] = static_cast<std::uint8_t>(sides & 7U);
      graph.inflow_sides[t] = static_cast<std::uint8_t>(sides >> 3U & 7U);
      graph.meeting_sides[t] = static_cast<std::uint8_t>(sides >> 6U & 7U);
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
