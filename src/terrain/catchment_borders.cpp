// Borders of catchments.
//
// 1. In each triangle the lines that end pieces of its In sides, each from the piece below or from the corner
//    at which water parts, up to the side; where such a line meets the upper corner, up to it.
// 2. On each edge whose two sides belong to different ground (a ridge, the rim, beside level triangles): the
//    parts of it where they do.
// 3. Nearly all triangles have water that comes to one sink only, as their neighbours' does: nothing to do.
#include "terrain/catchment_borders.hpp"

#include "base/ordered_blocks.hpp"
#include "base/parallel.hpp"

#include <vector>

namespace thalweg {

namespace {

constexpr std::uint32_t kOutside = std::numeric_limits<std::uint32_t>::max();
constexpr std::size_t kBlock = 4096;
constexpr std::size_t kAhead = 8;  // triangles by which pieces are asked for before they are needed

/// A part of an edge whose one side is of one group; `point` is its end.
struct Part {
  double end = 1;
  std::uint32_t group = kOutside;
  std::uint32_t point = 0;
};

/// What is found in a block of triangles.
struct Slot {
  std::vector<BorderSegment> segments;
  std::vector<Part> left, right, parts;
};

/// What all blocks share.
struct Grounds {
  const FlowGraph& graph;
  std::span<const std::uint32_t> group_of_sink;
  std::span<const std::uint32_t> group;  ///< by node
  std::span<HalfedgeId> side_of_piece;
};

class BorderFinder {
 public:
  BorderFinder(const Grounds& grounds, Slot& slot)
      : graph_(grounds.graph),
        mesh_(graph_.mesh),
        group_of_sink_(grounds.group_of_sink),
        group_(grounds.group),
        side_of_piece_(grounds.side_of_piece),
        slot_(slot) {
    slot_.segments.clear();
  }

  /// Asks for the pieces that `look_at` needs.
  void ask_for(TriangleId t) const {
    if (group_of(t) != kSeveral) return;
    for (std::size_t side = 0; side < 3; ++side) {
      const FlowTarget target = graph_.target[3 * t.index() + side];
      if (target.many()) prefetch(graph_.pieces.at(target.index()));
    }
  }

  void look_at(TriangleId t) {
    if (has_no_border(t)) return;
    const std::uint32_t group = group_of(t);
    for (std::size_t side = 0; side < 3; ++side) {
      const HalfedgeId h = Tin::halfedge(t, side);
      if (group == kSeveral) add_lines_at(h);
      const HalfedgeId twin = mesh_.twin(h);
      if (twin.valid() && twin < h) continue;
      if (!twin.valid() || group == kSeveral || group != group_of(Tin::triangle_of(twin))) add_edge(h);
    }
  }

 private:
  static constexpr std::uint32_t kSeveral =
      kOutside - 1;  // as a group no more than a guess: one looks closer

  /// True only if all water of the triangle, and beyond the sides that are its to tell, comes to one sink.
  [[nodiscard]] bool has_no_border(TriangleId t) const {
    const std::uint32_t sink = graph_.only_sink[t.index()];
    bool same = sink != FlowGraph::kSeveralSinks;
    for (std::size_t side = 0; side < 3; ++side) {  // without a jump
      const HalfedgeId h = Tin::halfedge(t, side), twin = mesh_.twin(h);
      const TriangleId beyond = twin.valid() ? Tin::triangle_of(twin) : t;
      same &= twin.valid() & ((twin < h) | (graph_.only_sink[beyond.index()] == sink));
    }
    return same;
  }

  [[nodiscard]] std::uint32_t group_of(TriangleId t) const {
    const std::uint32_t sink = graph_.only_sink[t.index()];
    return sink < group_of_sink_.size() ? group_of_sink_[sink] : kSeveral;
  }

  void add_lines_at(HalfedgeId h) {
    const TriangleShape shape = graph_.shape[h.index() / 3];
    const Fall fall = shape.fall(h.index() % 3);
    if (fall == Fall::In && graph_.target[h.index()].many()) add_lines(h);
    if (fall == Fall::Out && shape.corner_is_low == 0 && graph_.beyond(h).many()) add_line_to_top(h);
  }

  [[nodiscard]] std::uint32_t point_of_piece(std::uint32_t piece) const {
    return static_cast<std::uint32_t>(mesh_.vertex_count()) + piece;
  }

  // A line that comes to an end of the side comes to a vertex, and goes no further.
  [[nodiscard]] std::uint32_t end_of_piece(HalfedgeId h, const FlowPiece& piece, std::uint32_t index) const {
    if (piece.end > 0 && piece.end < 1) return point_of_piece(index);
    return (piece.end > 0 ? mesh_.target(h) : mesh_.origin(h)).value();
  }

  void add_segment(std::uint32_t from, std::uint32_t to, std::uint32_t left, std::uint32_t right) {
    if (left == right || from == to) return;
    if (left != kOutside) slot_.segments.push_back({left, from, to});
    if (right != kOutside) slot_.segments.push_back({right, to, from});
  }

  // Seen uphill the shares of an In side grow to the left.
  void add_lines(HalfedgeId h) {
    std::uint32_t i = graph_.target[h.index()].index();
    const FlowPiece* piece = graph_.pieces.at(i);
    for (std::uint32_t right = group_[piece->node]; piece->last == 0; ++i, ++piece) {
      const std::uint32_t left = group_[piece[1].node];
      if (left != right) {
        side_of_piece_[i] = h;
        const std::uint32_t from = piece->from;
        add_segment(from == FlowPiece::kFromCorner ? mesh_.apex(h).value() : point_of_piece(from),
                    end_of_piece(h, *piece, i), left, right);
      }
      right = left;
    }
  }

  // Where two In sides meet at the end of a piece of the Out side h.
  void add_line_to_top(HalfedgeId h) {
    const double top = 1 - graph_.split_at[h.index() / 3];
    std::uint32_t i = graph_.beyond(h).index();
    for (const FlowPiece* piece = graph_.pieces.at(i); piece->last == 0; ++i, ++piece) {
      if (piece->end != top) continue;
      add_segment(point_of_piece(i), mesh_.apex(h).value(), group_[piece[1].node], group_[piece->node]);
    }
  }

  // The groups along h of its triangle's ground.
  void list_parts(HalfedgeId h, std::vector<Part>& parts) const {
    parts.clear();
    const auto all_of = [&](FlowNode node) { parts.push_back({1, group_[node], mesh_.target(h).value()}); };
    const TriangleId t = Tin::triangle_of(h);
    switch (graph_.fall(h)) {
      case Fall::Level:
        return all_of(graph_.node_of(graph_.low_corner(t)));
      case Fall::Out:
        return all_of(graph_.node_of_channel(h));  // others are not looked at
      case Fall::Along: {
        const HalfedgeId split = graph_.strip_of(t).split;
        FlowPiece single;
        const FlowPiece* piece = graph_.pieces_of(graph_.target[split.index()], single);
        while (h == Tin::next(split) && piece->last == 0) ++piece;
        return all_of(piece->node);
      }
      case Fall::In:
        break;
    }
    const FlowTarget target = graph_.target[h.index()];
    if (!target.many()) return all_of(target.index());
    std::uint32_t i = target.index();
    for (const FlowPiece* piece = graph_.pieces.at(i);; ++i, ++piece) {
      const bool last = piece->last != 0;
      const std::uint32_t group = group_[piece->node];
      const Part part{last ? 1 : piece->end, group,
                      last ? mesh_.target(h).value() : end_of_piece(h, *piece, i)};
      if (!parts.empty() && parts.back().group == group) {
        parts.back() = part;
      } else {
        parts.push_back(part);
      }
      if (last) return;
    }
  }

  void add_edge(HalfedgeId h) {
    const HalfedgeId twin = mesh_.twin(h);
    if (twin.valid()) {
      const Fall here = graph_.fall(h), there = graph_.fall(twin);
      const bool out = here == Fall::Out || there == Fall::Out, in = here == Fall::In || there == Fall::In;
      if (!graph_.is_channel(h) && out && in) return;  // all that comes goes on
      if (here == Fall::Out && there == Fall::Out) return;
    }
    std::vector<Part>&left = slot_.left, &right = slot_.right, &parts = slot_.parts;
    list_parts(h, left);
    right.clear();
    const std::uint32_t end = mesh_.target(h).value();
    if (twin.valid()) {
      list_parts(twin, parts);
      if (left.size() == 1 && parts.size() == 1 && left[0].group == parts[0].group) return;
      for (std::size_t i = parts.size(); i-- > 0;) {  // the end of a part is the end of the one before it
        right.push_back(
            {i == 0 ? 1 : 1 - parts[i - 1].end, parts[i].group, i == 0 ? end : parts[i - 1].point});
      }
    } else {
      right.push_back({1, kOutside, end});
    }
    std::uint32_t at = mesh_.origin(h).value();
    for (std::size_t i = 0, j = 0; i < left.size() && j < right.size();) {
      const bool end_left = i + 1 < left.size() && (j + 1 == right.size() || left[i].end <= right[j].end);
      const std::uint32_t to = end_left ? left[i].point : right[j].point;
      add_segment(at, to, left[i].group, right[j].group);
      at = to;
      end_left ? ++i : ++j;
    }
  }

  const FlowGraph& graph_;
  const FlowMesh& mesh_;
  std::span<const std::uint32_t> group_of_sink_;
  std::span<const std::uint32_t> group_;
  std::span<HalfedgeId> side_of_piece_;
  Slot& slot_;
};

}  // namespace

FlowPoint CatchmentBorders::point(const FlowGraph& graph, std::uint32_t number) const {
  const FlowMesh& mesh = graph.mesh;
  if (number < mesh.vertex_count()) {
    const VertexId v{number};
    return {.xy = mesh.point(v), .z = mesh.height(v), .edge = {}, .along = 0, .vertex = mesh.given(v)};
  }
  const std::uint32_t piece = number - static_cast<std::uint32_t>(mesh.vertex_count());
  const HalfedgeId h = side_of_piece[piece];
  const Point2 a = mesh.point(mesh.origin(h)), b = mesh.point(mesh.target(h));
  const double share = graph.pieces.at(piece)->end;
  return {.xy = {a.x + share * (b.x - a.x), a.y + share * (b.y - a.y)},
          .z = 0,
          .edge = mesh.given(h),
          .along = share,
          .vertex = {}};
}

CatchmentBorders find_borders(const FlowGraph& graph, std::span<const std::uint32_t> group_of_sink,
                              const Progress& progress) {
  LargeVector<std::uint32_t> group(graph.node_count());
  for_each_block(group.size(), kBlock, progress, [&](std::size_t begin, std::size_t end) {
    for (std::size_t node = begin; node < end; ++node) {
      const std::uint32_t sink = graph.sink_of_node[node];
      group[node] = sink == SinkId::kInvalid ? kOutside : group_of_sink[sink];
    }
  });
  CatchmentBorders borders;
  borders.segments.reserve(graph.mesh.vertex_count());
  borders.side_of_piece.resize(graph.pieces.end());
  const Grounds grounds{graph, group_of_sink, group, borders.side_of_piece};
  for_each_block_in_order<Slot>(
      graph.mesh.triangle_count(), kBlock, progress,
      [&](std::size_t begin, std::size_t end, Slot& slot) {
        BorderFinder finder(grounds, slot);
        for (std::size_t t = begin; t < end; ++t) {
          if (t + kAhead < end) finder.ask_for(TriangleId{t + kAhead});
          finder.look_at(TriangleId{t});
        }
      },
      [&](std::size_t /*begin*/, std::size_t /*end*/, const Slot& slot) {
        borders.segments.insert(borders.segments.end(), slot.segments.begin(), slot.segments.end());
      });
  return borders;
}

}  // namespace thalweg
