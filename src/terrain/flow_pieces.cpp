// Channels, and to which of them the parts of each side lead.
//
// 1. An edge is a channel if a triangle drains into it and none beyond takes the water in. Channels are
//    numbered by halfedge.
// 2. The pieces of a triangle's In sides follow from those of the sides over which it hands water on. So
//    triangles are done in an order in which each comes after those that it hands water to; each counts how
//    many it waits for.
// 3. What is left then waits for itself in a cycle: an edge of one is made a channel, and so on.
#include "base/parallel.hpp"
#include "terrain/flow_graph.hpp"

#include <thalweg/base/assert.hpp>
#include <thalweg/base/error.hpp>

#include <algorithm>
#include <array>

namespace thalweg {

namespace {

constexpr std::size_t kBlock = 24576;  // a multiple of three: whole triangles

// An edge is counted where its first halfedge is.
void mark_channels(FlowGraph& graph, std::vector<std::size_t>& count, const Progress& progress) {
  const FlowMesh& mesh = graph.mesh;
  for_each_block(mesh.halfedge_count(), kBlock, progress, [&](std::size_t begin, std::size_t end) {
    std::size_t here = 0;
    for (std::size_t i = begin; i < end; ++i) {
      const HalfedgeId h{i}, twin = mesh.twin(h);
      const Fall fall = graph.fall[i], beyond = twin.valid() ? graph.fall[twin.index()] : Fall::Level;
      const bool drains = (fall >= Fall::Out) | (beyond >= Fall::Out);
      const bool goes_on = (fall == Fall::In) | (beyond == Fall::In);
      const bool channel = drains & !goes_on;
      graph.channel[i] = channel ? 1 : 0;
      here += channel && (!twin.valid() || h < twin) ? 1 : 0;
    }
    count[begin / kBlock] = here;
  });
}

}  // namespace

void find_channels(FlowGraph& graph, const Progress& progress) {
  const FlowMesh& mesh = graph.mesh;
  graph.channel.resize(mesh.halfedge_count());
  graph.target.resize(mesh.halfedge_count());
  std::vector<std::size_t> first(mesh.halfedge_count() / kBlock + 1, 0);
  mark_channels(graph, first, progress);
  std::size_t total = 0;
  for (std::size_t& number : first) total += std::exchange(number, total);
  graph.channels.resize(total);
  for_each_block(mesh.halfedge_count(), kBlock, progress, [&](std::size_t begin, std::size_t end) {
    std::size_t number = first[begin / kBlock];
    for (std::size_t i = begin; i < end; ++i) {
      const HalfedgeId h{i}, twin = mesh.twin(h);
      if (graph.channel[i] == 0 || !mesh.represents_edge(h)) continue;
      const FlowTarget target{.index = static_cast<std::uint32_t>(number)};
      if (graph.drains(h)) graph.target[i] = target;
      if (twin.valid() && graph.drains(twin)) graph.target[twin.index()] = target;
      graph.channels[number++] = {h, graph.low_end(h)};
    }
  });
}

namespace {

class PieceFinder {
 public:
  explicit PieceFinder(FlowGraph& graph)
      : graph_(graph), mesh_(graph.mesh), waits_for_(mesh_.triangle_count(), 0) {
    graph_.pieces.reserve(kPiecesAVertex * mesh_.vertex_count());
  }

  void run(Progress& progress) {
    const std::size_t count = mesh_.triangle_count();
    for_each_block(count, kBlock, progress, [&](std::size_t begin, std::size_t end) {
      for (std::size_t t = begin; t < end; ++t) waits_for_[t] = count_awaited(TriangleId{t});
    });
    for (std::size_t t = 0; t < count; ++t) {
      if (t % (1U << 13U) == 0) progress.advance(static_cast<double>(t) / static_cast<double>(count));
      if (waits_for_[t] == 0) finish_from(TriangleId{t}, progress);
    }
    for (std::size_t t = 0; t < count; ++t) {
      while (waits_for_[t] != kDone) {
        const TriangleId freed = break_cycle(TriangleId{t});
        if (waits_for_[freed.index()] == 0) finish_from(freed, progress);
      }
    }
  }

 private:
  static constexpr std::uint8_t kDone = 0xff;
  static constexpr std::size_t kPiecesAVertex = 6;  // measured: 5 on random points and lattices

  /// The sides over which the triangle hands water on into a triangle.
  [[nodiscard]] std::uint8_t count_awaited(TriangleId t) const {
    std::uint8_t count = 0;
    if (graph_.level(t)) return kDone;
    for (std::size_t side = 0; side < 3; ++side) count += passes_on(Tin::halfedge(t, side)) ? 1 : 0;
    return count;
  }

  [[nodiscard]] bool passes_on(HalfedgeId h) const { return graph_.drains(h) && graph_.channel[h.index()] == 0; }

  void finish_from(TriangleId start, const Progress& progress) {
    ready_.assign(1, start);
    for (std::size_t steps = 1; !ready_.empty(); ++steps) {
      if (steps % (1U << 16U) == 0) progress.check();
      const TriangleId t = ready_.back();
      ready_.pop_back();
      finish(t);
    }
  }

  void finish(TriangleId t) {
    waits_for_[t.index()] = kDone;
    const Strip strip = graph_.strip_of(t);
    const HalfedgeId after = Tin::next(strip.split), before = Tin::previous(strip.split);
    if (strip.corner_is_low) {
      append(before, 0, 1, 0, strip.at);
      append(after, 0, 1, strip.at, 1);
      keep(strip.split);
    } else {
      const double top = 1 - strip.at;  // along the twin of the Out side
      append(strip.split, 0, top, 0, 1);
      keep(after);
      append(strip.split, top, 1, 0, 1);
      keep(before);
    }
  }

  // Appends what lies in [from, to] of the pieces of x, stretched to [begin, end] of the side that is built.
  void append(HalfedgeId x, double from, double to, double begin, double end) {
    if (!(from < to) || !(begin < end)) return;
    const FlowTarget target = graph_.beyond(x);
    if (target.many == 0) return add({.end = end, .node = target.index});
    const double stretch = (end - begin) / (to - from);
    for (std::uint32_t i = target.index;; ++i) {
      const FlowPiece& piece = graph_.pieces[i];
      if (piece.end <= from && piece.last == 0) continue;
      if (piece.last != 0 || piece.end >= to) return add({.end = end, .node = piece.node});
      const double stop = std::clamp(begin + (piece.end - from) * stretch, begin, end);
      add({.end = stop, .node = piece.node, .from = i});
    }
  }

  void add(const FlowPiece& piece) {
    if (!fresh_.empty() && fresh_.back().node == piece.node) {
      fresh_.back() = piece;
    } else {
      fresh_.push_back(piece);
    }
  }

  /// Gives what was appended to the In side h, and counts down the triangle that hands water over it.
  void keep(HalfedgeId h) {
    THALWEG_ASSERT(!fresh_.empty());
    if (fresh_.size() == 1) {
      graph_.target[h.index()] = {.index = fresh_.front().node};
    } else {
      for (std::size_t i = 0; i + 1 < fresh_.size(); ++i) fresh_[i].last = 0;
      graph_.target[h.index()] = {.index = static_cast<std::uint32_t>(graph_.pieces.size()), .many = 1};
      graph_.pieces.insert(graph_.pieces.end(), fresh_.begin(), fresh_.end());
      if (graph_.pieces.size() > kMostPieces) {
        throw Error(ErrorCode::SizeLimit, "the flow parts the TIN's edges into more than 2147483647 pieces; "
                                          "split the area");
      }
    }
    fresh_.clear();
    const HalfedgeId twin = mesh_.twin(h);
    if (!twin.valid() || !passes_on(twin)) return;
    const TriangleId above = Tin::triangle_of(twin);
    if (--waits_for_[above.index()] == 0) ready_.push_back(above);
  }

  /// Makes a channel of an edge of a cycle to which one comes from `t`, over sides that are awaited; returns
  /// the triangle that waited for it. If that still waits, it is for another cycle.
  TriangleId break_cycle(TriangleId t) {
    std::vector<std::uint8_t> passed(mesh_.triangle_count(), 0);
    for (;;) {
      passed[t.index()] = 1;
      HalfedgeId over;
      for (std::size_t side = 0; side < 3; ++side) {
        const HalfedgeId h = Tin::halfedge(t, side);
        if (passes_on(h) && waits_for_[Tin::triangle_of(mesh_.twin(h)).index()] != kDone) over = h;
      }
      const TriangleId next = Tin::triangle_of(mesh_.twin(over));
      if (passed[next.index()] == 0) {
        t = next;
        continue;
      }
      make_channel(over);
      --waits_for_[t.index()];
      return t;
    }
  }

  void make_channel(HalfedgeId h) {
    const HalfedgeId twin = mesh_.twin(h);
    graph_.channel[h.index()] = graph_.channel[twin.index()] = 1;
    graph_.target[h.index()] = {
        .index = static_cast<std::uint32_t>(graph_.channels.size() + mesh_.vertex_count())};
    graph_.channels.push_back({std::min(h, twin), graph_.low_end(h)});
    ++graph_.broken_cycles;
  }

  static constexpr std::size_t kMostPieces = (std::size_t{1} << 31U) - 1;

  FlowGraph& graph_;
  const FlowMesh& mesh_;
  LargeVector<std::uint8_t> waits_for_;
  std::vector<TriangleId> ready_;
  std::vector<FlowPiece> fresh_;
};

}  // namespace

void find_pieces(FlowGraph& graph, Progress& progress) {
  PieceFinder(graph).run(progress);
}

}  // namespace thalweg
