// Falls, channels, and how a triangle hands on what it takes in.
//
// A triangle that is not level takes in water over one or two sides (In), and hands it on over the others
// (Out, or Along where a side runs down the slope: no water comes to it from inside, so it counts as one over
// which nothing runs). The line of flow through the one corner between two sides of the same sort splits it:
//     two Out sides: the corner is the lowest; water left and right of the line runs over different sides;
//     two In sides: the corner is the highest; water left and right of the line came over different sides.
// Lines of flow are parallel, so between the line and an end of the side shares of the sides' ways map
// affinely.
#include "terrain/flow_graph.hpp"

#include "base/parallel.hpp"

#include <thalweg/base/assert.hpp>
#include <thalweg/geometry/slope.hpp>

#include <algorithm>
#include <tuple>

namespace thalweg {

namespace {

constexpr std::size_t kBlock = 8192;

struct Gradient {
  double x = 0;
  double y = 0;
};

// Of any length: the direction in which the triangle rises.
Gradient rise_of(const Tin& tin, TriangleId t) {
  const Triangle& c = tin.triangle(t);
  const Point2 o = tin.point(c[0]);
  const double x1 = tin.point(c[1]).x - o.x, y1 = tin.point(c[1]).y - o.y;
  const double x2 = tin.point(c[2]).x - o.x, y2 = tin.point(c[2]).y - o.y;
  const double z1 = tin.height(c[1]) - tin.height(c[0]), z2 = tin.height(c[2]) - tin.height(c[0]);
  return {z1 * y2 - z2 * y1, x1 * z2 - x2 * z1};
}

double share_along(const Tin& tin, const Gradient& g, HalfedgeId h, Point2 p) {
  const Point2 o = tin.point(tin.origin(h)), d = tin.point(tin.target(h));
  const double whole = g.x * (d.y - o.y) - g.y * (d.x - o.x);
  const double part = g.x * (p.y - o.y) - g.y * (p.x - o.x);
  const double share = part / whole;
  return share >= 0 && share <= 1 ? share : share > 1 ? 1 : share < 0 ? 0 : 0.5;
}

Fall fall_over(const Tin& tin, HalfedgeId h) {
  const VertexId a = tin.origin(h), b = tin.target(h), c = tin.apex(h);
  const int sign =
      fall_across(tin.point(a), tin.height(a), tin.point(b), tin.height(b), tin.point(c), tin.height(c));
  return sign > 0 ? Fall::Out : sign < 0 ? Fall::In : Fall::Along;
}

}  // namespace

VertexId FlowGraph::lower(VertexId a, VertexId b) const {
  const auto key = [&](VertexId v) { return std::tuple(tin.height(v), flats.rank[v.index()], tin.point(v)); };
  return key(b) < key(a) ? b : a;
}

VertexId FlowGraph::low_corner(TriangleId t) const {
  const Triangle& corner = tin.triangle(t);
  return lower(lower(corner[0], corner[1]), corner[2]);
}

std::uint32_t FlowGraph::sink_of_node(FlowNode node) const {
  if (is_vertex(node)) return sink[vertex_of(node).index()];
  const HalfedgeId h{node};
  const VertexId end = low_end(h);
  return tin.on_rim(h) ? rim_sink[end.index()] : sink[end.index()];
}

Strip FlowGraph::strip_of(TriangleId t) const {
  std::size_t in = 0, in_side = 0, out_side = 0;
  for (std::size_t side = 0; side < 3; ++side) {
    if (fall[3 * t.index() + side] == Fall::In) {
      ++in;
      in_side = side;
    } else {
      out_side = side;
    }
  }
  THALWEG_ASSERT(in == 1 || in == 2);
  Strip strip{.split = Tin::halfedge(t, in == 1 ? in_side : out_side), .corner_is_low = in == 1};
  if (strip.corner_is_low && fall[Tin::next(strip.split).index()] == Fall::Along) {
    strip.at = 1;
  } else if (strip.corner_is_low && fall[Tin::previous(strip.split).index()] == Fall::Along) {
    strip.at = 0;
  } else {
    // Never at an end, whatever rounding says: then both sides have pieces, and lines end where others begin.
    constexpr double kLeast = 0x1p-50;
    const double at = share_along(tin, rise_of(tin, t), strip.split, tin.point(tin.apex(strip.split)));
    strip.at = std::clamp(at, kLeast, 1 - kLeast);
  }
  return strip;
}

double FlowGraph::share_of(TriangleId t, const Strip& strip, Point2 p) const {
  return share_along(tin, rise_of(tin, t), strip.split, p);
}

std::span<const FlowPiece> FlowGraph::taken_in(HalfedgeId h, FlowPiece& single) const {
  const std::uint32_t count = pieces_count[h.index()];
  if (count > 0) return std::span(pieces).subspan(pieces_first[h.index()], count);
  single = {.node = pieces_first[h.index()]};
  return {&single, 1};
}

std::span<const FlowPiece> FlowGraph::passed_on(HalfedgeId h, FlowPiece& single) const {
  if (channel[h.index()] == 0) return taken_in(tin.twin(h), single);
  single = {.node = node_of_channel(h)};
  return {&single, 1};
}

FlowNode FlowGraph::node_beyond(HalfedgeId h, double at) const {
  FlowPiece single;
  const std::span<const FlowPiece> all = passed_on(h, single);
  const double along_twin = 1 - at;
  const auto piece = std::partition_point(all.begin(), all.end() - 1,
                                          [&](const FlowPiece& p) { return p.end <= along_twin; });
  return piece->node;
}

void find_falls(FlowGraph& graph, const Progress& progress) {
  const Tin& tin = graph.tin;
  graph.fall.assign(tin.halfedge_count(), Fall::Level);
  for_each_block(tin.triangle_count(), kBlock, progress, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Triangle& c = tin.triangle(TriangleId{i});
      if (tin.height(c[0]) == tin.height(c[1]) && tin.height(c[1]) == tin.height(c[2])) continue;
      for (std::size_t side = 0; side < 3; ++side) {
        graph.fall[3 * i + side] = fall_over(tin, Tin::halfedge(TriangleId{i}, side));
      }
    }
  });
  graph.channel.assign(tin.halfedge_count(), 0);
  for_each_block(tin.halfedge_count(), 3 * kBlock, progress, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const HalfedgeId h{i}, twin = tin.twin(h);
      const bool here = graph.drains(h), there = twin.valid() && graph.drains(twin);
      const bool goes_on = twin.valid() && (here ? graph.fall[twin.index()] : graph.fall[i]) == Fall::In;
      graph.channel[i] = (here || there) && !goes_on ? 1 : 0;
    }
  });
}

namespace {

/// Fills the pieces of all In sides, each after those that it hands its water to.
class PieceFinder {
 public:
  explicit PieceFinder(FlowGraph& graph)
      : graph_(graph), tin_(graph.tin), state_(tin_.halfedge_count(), kNew) {
    graph_.pieces_first.assign(tin_.halfedge_count(), kNoNode);
    graph_.pieces_count.assign(tin_.halfedge_count(), 0);
  }

  void run(Progress& progress) {
    for (std::size_t i = 0; i < tin_.halfedge_count(); ++i) {
      if (i % (1U << 14U) == 0) {
        progress.advance(static_cast<double>(i) / static_cast<double>(tin_.halfedge_count()));
      }
      if (graph_.fall[i] != Fall::In || state_[i] == kDone) continue;
      resolve(HalfedgeId{i}, progress);
    }
  }

 private:
  static constexpr std::uint8_t kNew = 0, kWaiting = 1, kDone = 2;

  void resolve(HalfedgeId h, const Progress& progress) {
    waiting_.assign(1, h);
    state_[h.index()] = kWaiting;
    for (std::size_t steps = 1; !waiting_.empty(); ++steps) {
      if (steps % (1U << 16U) == 0) progress.check();
      const HalfedgeId top = waiting_.back();
      if (const HalfedgeId missing = first_missing(top); missing.valid()) {
        state_[missing.index()] = kWaiting;
        waiting_.push_back(missing);
        continue;
      }
      build(top);
      state_[top.index()] = kDone;
      waiting_.pop_back();
    }
  }

  // An In side that has to come before h; channels where the order would close a cycle.
  HalfedgeId first_missing(HalfedgeId h) {
    for (const HalfedgeId x : {Tin::next(h), Tin::previous(h)}) {
      if (!graph_.drains(x) || graph_.channel[x.index()] != 0) continue;
      const HalfedgeId beyond = tin_.twin(x);
      if (state_[beyond.index()] == kNew) return beyond;
      if (state_[beyond.index()] == kDone) continue;
      graph_.channel[x.index()] = graph_.channel[beyond.index()] = 1;
      ++graph_.broken_cycles;
    }
    return {};
  }

  // Appends what lies in [from, to] of the pieces of x, stretched to [begin, end] of the side that is built.
  void append(HalfedgeId x, double from, double to, double begin, double end) {
    if (!(from < to) || !(begin < end)) return;
    FlowPiece single;
    const std::span<const FlowPiece> all = graph_.passed_on(x, single);
    const double stretch = (end - begin) / (to - from);
    const auto first_index =
        all.data() == &single ? FlowPiece::kFromCorner : graph_.pieces_first[tin_.twin(x).index()];
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (all[i].end <= from && i + 1 < all.size()) continue;
      const bool last = i + 1 == all.size() || all[i].end >= to;
      const double stop = last ? end : std::clamp(begin + (all[i].end - from) * stretch, begin, end);
      const std::uint32_t parent =
          last ? FlowPiece::kFromCorner : first_index + static_cast<std::uint32_t>(i);
      if (!fresh_.empty() && fresh_.back().node == all[i].node) {
        fresh_.back().end = stop;
        fresh_.back().from = parent;
      } else {
        fresh_.push_back({stop, all[i].node, parent});
      }
      if (last) break;
    }
  }

  void build(HalfedgeId h) {
    const Strip strip = graph_.strip_of(Tin::triangle_of(h));
    fresh_.clear();
    if (strip.corner_is_low) {
      append(Tin::previous(h), 0, 1, 0, strip.at);
      append(Tin::next(h), 0, 1, strip.at, 1);
    } else {
      const double top = 1 - strip.at;  // along the twin of the Out side
      if (h == Tin::next(strip.split)) {
        append(strip.split, 0, top, 0, 1);
      } else {
        append(strip.split, top, 1, 0, 1);
      }
    }
    THALWEG_ASSERT(!fresh_.empty());
    if (fresh_.size() == 1) {
      graph_.pieces_first[h.index()] = fresh_.front().node;
      return;
    }
    graph_.pieces_first[h.index()] = static_cast<std::uint32_t>(graph_.pieces.size());
    graph_.pieces_count[h.index()] = static_cast<std::uint32_t>(fresh_.size());
    graph_.pieces.insert(graph_.pieces.end(), fresh_.begin(), fresh_.end());
  }

  FlowGraph& graph_;
  const Tin& tin_;
  std::vector<std::uint8_t> state_;
  std::vector<HalfedgeId> waiting_;
  std::vector<FlowPiece> fresh_;
};

}  // namespace

void find_pieces(FlowGraph& graph, Progress& progress) {
  PieceFinder(graph).run(progress);
}

}  // namespace thalweg
