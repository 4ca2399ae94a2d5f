// Channels, and to which of them the parts of each side lead.
//
// 1. An edge is a channel if a triangle drains into it and none beyond takes the water in. Channels are
//    numbered by halfedge.
// 2. The pieces of a triangle's In sides follow from those of the sides over which it hands water on. So
//    triangles are done in an order in which each comes after those that it hands water to: each counts how
//    many it waits for. Parts of the triangles are done side by side; what is handed over from one to another
//    is counted between two rounds.
// 3. What is left then waits for itself in a cycle: an edge of one is made a channel, and so on.
#include "base/parallel.hpp"
#include "terrain/flow_graph.hpp"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <array>
#include <bit>
#include <utility>
#include <vector>

namespace thalweg {

namespace {

constexpr std::size_t kBlock = 8192;

/// Marks channels; of each block of triangles the halfedges that stand for one.
std::vector<std::vector<HalfedgeId>> mark_channels(FlowGraph& graph, const Progress& progress) {
  const FlowMesh& mesh = graph.mesh;
  std::vector<std::vector<HalfedgeId>> found(mesh.triangle_count() / kBlock + 1);
  for_each_block(mesh.triangle_count(), kBlock, progress, [&](std::size_t begin, std::size_t end) {
    std::vector<HalfedgeId> here(3 * (end - begin));
    std::size_t count = 0;
    for (std::size_t t = begin; t < end; ++t) {
      const TriangleShape shape = graph.shape[t];
      unsigned channels = 0;
      for (std::size_t side = 0; side < 3; ++side) {
        const HalfedgeId h = Tin::halfedge(TriangleId{t}, side), twin = mesh.twin(h);
        const Fall fall = shape.fall(side), beyond = twin.valid() ? graph.fall(twin) : Fall::Level;
        const bool drains = (fall >= Fall::Out) | (beyond >= Fall::Out);
        const bool goes_on = (fall == Fall::In) | (beyond == Fall::In);
        const bool channel = drains & !goes_on;
        channels |= (channel ? 1U : 0U) << side;
        here[count] = h;  // without a jump: which edges are channels cannot be foreseen
        count += (channel & (h < twin)) ? 1 : 0;  // no twin is greater than any
      }
      graph.channel_sides[t] = static_cast<std::uint8_t>(channels);
    }
    found[begin / kBlock].assign(here.begin(), here.begin() + static_cast<std::ptrdiff_t>(count));
  });
  return found;
}

}  // namespace

void find_channels(FlowGraph& graph, const Progress& progress) {
  const FlowMesh& mesh = graph.mesh;
  graph.channel_sides.resize(mesh.triangle_count());
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
      const FlowTarget target = FlowTarget::node(static_cast<FlowNode>(number));
      if (graph.drains(h)) graph.target[h.index()] = target;
      if (twin.valid() && graph.drains(twin)) graph.target[twin.index()] = target;
      graph.channels[number++] = {h, graph.low_end(h), !twin.valid()};
    }
  });
}

namespace {

/// What a triangle waits for: the sides over which it hands water on into triangles that are not done.
class Awaited {
 public:
  Awaited() = default;
  /// `sides`: those over which water is handed on, a bit each.
  explicit Awaited(unsigned sides) : count_(std::popcount(sides) & 3U), sides_(sides & 7U) {}
  [[nodiscard]] bool some() const { return count_ != 0; }
  [[nodiscard]] bool never() const { return sides_ == 0; }
  /// Whether the side was added, and no channel made of it.
  [[nodiscard]] bool has(std::size_t side) const { return (sides_ >> side & 1U) != 0; }
  void make_channel(std::size_t side) {
    --count_;
    sides_ &= ~(1U << side) & 7U;
  }
  /// True if that was the last one.
  bool finish_one() { return --count_ == 0; }

 private:
  std::uint8_t count_ : 2 = 0;
  std::uint8_t sides_ : 3 = 0;
};
using Waiting = RawVector<Awaited>;

/// Triangles of one part are done by one thread.
constexpr std::size_t kPart = 1U << 16U;

/// Those with Fall::Out or Fall::Along, a bit each.
unsigned draining_sides(TriangleShape shape) {
  const unsigned drains = shape.falls >> 1U;
  return (drains & 1U) | (drains >> 1U & 2U) | (drains >> 2U & 4U);
}

Waiting list_awaited(const FlowGraph& graph, const Progress& progress) {
  Waiting waiting(graph.mesh.triangle_count());
  for_each_block(waiting.size(), kBlock, progress, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      waiting[t] = Awaited(draining_sides(graph.shape[t]) & ~unsigned{graph.channel_sides[t]});
    }
  });
  return waiting;
}

/// Finishes triangles of one part, from those that wait for none upwards.
class PieceFinder {
 public:
  PieceFinder(FlowGraph& graph, Waiting& waiting, std::size_t part)
      : graph_(&graph), waiting_(&waiting), part_(part) {}

  /// From all that never waited.
  void start(PieceStore::Writer& writer, const Progress& progress) {
    const std::size_t end = std::min((part_ + 1) * kPart, waiting_->size());
    for (std::size_t t = part_ * kPart; t < end; ++t) {
      if ((*waiting_)[t].never() && !graph_->shape[t].level()) finish_from(TriangleId{t}, writer, progress);
    }
  }
  void finish_from(TriangleId start, PieceStore::Writer& writer, const Progress& progress) {
    ready_.assign(1, start);
    writer_ = &writer;
    for (std::size_t steps = 1; !ready_.empty(); ++steps) {
      if (steps % (1U << 16U) == 0) progress.check();
      const TriangleId t = ready_.back();
      ready_.pop_back();
      finish(t);
    }
  }
  /// Sides of triangles of other parts that are done, if they were waited for.
  std::vector<HalfedgeId> take_outside() { return std::exchange(outside_, {}); }

 private:
  /// What runs over a side out of the triangle comes to; `channels`: of the triangle.
  [[nodiscard]] FlowTarget beyond(HalfedgeId h, unsigned side, unsigned channels) const {
    return graph_->target[((channels >> side & 1U) != 0 ? h : graph_->mesh.twin(h)).index()];
  }

  void finish(TriangleId t) {
    constexpr std::array<unsigned, 3> kNext = {1, 2, 0}, kPrevious = {2, 0, 1};
    const TriangleShape shape = graph_->shape[t.index()];
    const unsigned channels = graph_->channel_sides[t.index()];
    const double at = graph_->split_at[t.index()];
    const unsigned split_side = shape.split, next_side = kNext[split_side], last_side = kPrevious[split_side];
    const HalfedgeId split = Tin::halfedge(t, split_side), after = Tin::halfedge(t, next_side),
                     before = Tin::halfedge(t, last_side);
    if (shape.corner_is_low != 0) {
      writer_->start();
      append(beyond(before, last_side, channels), 0, 1, 0, at);
      append(beyond(after, next_side, channels), 0, 1, at, 1);
      keep(split);
      return;
    }
    const double top = 1 - at;  // along the twin of the Out side
    const FlowTarget target = beyond(split, split_side, channels);
    if (!target.many()) {
      set_next(split, before, target.index());
      set(after, target);
      set(before, target);
      return;
    }
    writer_->start();
    append(target, 0, top, 0, 1);
    keep(after);
    writer_->start();
    append(target, top, 1, 0, 1);
    keep(before);
    const FlowPiece* piece = graph_->pieces.at(target.index());
    while (piece->end < top && piece->last == 0) ++piece;
    while (piece->end <= top && piece->last == 0) ++piece;
    set_next(split, before, piece->node);
  }

  /// What the line of flow from the high corner across `split` comes to, if the corner's water takes it.
  void set_next(HalfedgeId split, HalfedgeId before, FlowNode node) {
    const VertexId v = graph_->mesh.origin(before);
    const VertexStep& step = graph_->step[v.index()];
    if (step.kind == VertexStep::Kind::Cross && step.edge == split) graph_->next[v.index()] = node;
  }

  // Appends what lies in [from, to] of the pieces, stretched to [begin, end] of the side that is built.
  void append(FlowTarget target, double from, double to, double begin, double end) {
    if (!(from < to) || !(begin < end)) return;
    std::uint32_t i = target.index();
    if (!target.many()) return writer_->add(end, i, FlowPiece::kFromCorner);
    const FlowPiece* piece = graph_->pieces.at(i);
    for (; piece->end <= from && piece->last == 0; ++piece) ++i;
    const double stretch = (end - begin) / (to - from);
    for (; piece->last == 0 && piece->end < to; ++i, ++piece) {
      writer_->add(std::clamp(begin + (piece->end - from) * stretch, begin, end), piece->node, i);
    }
    writer_->add(end, piece->node, FlowPiece::kFromCorner);
  }

  void keep(HalfedgeId h) {
    set(h, writer_->is_one() ? FlowTarget::node(writer_->node()) : FlowTarget::pieces(writer_->keep()));
  }

  /// Also counts down the triangle that hands water over the In side h.
  void set(HalfedgeId h, FlowTarget target) {
    graph_->target[h.index()] = target;
    const HalfedgeId twin = graph_->mesh.twin(h);
    if (!twin.valid()) return;
    const TriangleId above = Tin::triangle_of(twin);
    if (above.index() / kPart != part_) {
      outside_.push_back(twin);
    } else if (Awaited& awaited = (*waiting_)[above.index()];
               awaited.has(twin.index() % 3) && awaited.finish_one()) {
      ready_.push_back(above);
    }
  }

  FlowGraph* graph_;
  Waiting* waiting_;
  std::size_t part_;
  PieceStore::Writer* writer_ = nullptr;
  std::vector<TriangleId> ready_;
  std::vector<HalfedgeId> outside_;
};

/// Parts side by side; then what waited for other parts, and so on.
class Parts {
 public:
  Parts(FlowGraph& graph, Waiting& waiting)
      : waiting_(waiting), writers_([&graph] { return PieceStore::Writer(graph.pieces); }) {
    for (std::size_t part = 0; part * kPart < waiting.size(); ++part) {
      finders_.emplace_back(graph, waiting, part);
    }
    ready_.resize(finders_.size());
  }

  void start(const Progress& progress) {
    for_each_block(finders_.size(), 1, progress, [&](std::size_t part, std::size_t /*end*/) {
      finders_[part].start(writers_.local(), progress);
    });
    go_on(progress);
  }
  void finish_from(TriangleId t, const Progress& progress) {
    finders_[t.index() / kPart].finish_from(t, writers_.local(), progress);
    go_on(progress);
  }

 private:
  void go_on(const Progress& progress) {
    while (count_outside()) {
      for_each_block(finders_.size(), 1, progress, [&](std::size_t part, std::size_t /*end*/) {
        for (const TriangleId t : std::exchange(ready_[part], {})) {
          finders_[part].finish_from(t, writers_.local(), progress);
        }
      });
    }
  }

  /// Whether some are ready now.
  bool count_outside() {
    bool some = false;
    for (PieceFinder& finder : finders_) {
      for (const HalfedgeId h : finder.take_outside()) {
        const TriangleId t = Tin::triangle_of(h);
        Awaited& awaited = waiting_[t.index()];
        if (!awaited.has(h.index() % 3) || !awaited.finish_one()) continue;
        ready_[t.index() / kPart].push_back(t);
        some = true;
      }
    }
    return some;
  }

  Waiting& waiting_;
  tbb::enumerable_thread_specific<PieceStore::Writer> writers_;
  std::vector<PieceFinder> finders_;
  std::vector<std::vector<TriangleId>> ready_;  // by part
};

/// Makes a channel of an edge of a cycle to which one comes from `t`, over sides that are awaited; returns
/// the triangle that waited for it, perhaps for one in another cycle too.
TriangleId break_cycle(FlowGraph& graph, Waiting& waiting, TriangleId t) {
  std::vector<std::uint8_t> passed(waiting.size(), 0);
  for (;;) {
    passed[t.index()] = 1;
    HalfedgeId over;
    for (std::size_t side = 0; side < 3; ++side) {
      const HalfedgeId h = Tin::halfedge(t, side);
      if (waiting[t.index()].has(side) && waiting[Tin::triangle_of(graph.mesh.twin(h)).index()].some())
        over = h;
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
    graph.target[over.index()] = FlowTarget::node(static_cast<FlowNode>(graph.node_count()));
    graph.channels.push_back({std::min(over, twin), graph.low_end(over), false});
    ++graph.broken_cycles;
    waiting[t.index()].make_channel(over.index() % 3);
    return t;
  }
}

}  // namespace

void find_pieces(FlowGraph& graph, const Progress& progress) {
  graph.next.assign(graph.mesh.vertex_count(), kNoNode);
  Waiting waiting = list_awaited(graph, progress);
  Parts parts(graph, waiting);
  parts.start(progress);
  for (std::size_t t = 0; t < waiting.size(); ++t) {
    while (waiting[t].some()) {
      const TriangleId freed = break_cycle(graph, waiting, TriangleId{t});
      if (!waiting[freed.index()].some()) parts.finish_from(freed, progress);
    }
  }
}

}  // namespace thalweg
