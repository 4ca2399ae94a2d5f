// Borders of catchments.
//
// 1. From each low corner at which water parts between two groups the line of flow that divides them is
//    followed upwards, to a vertex or to an edge over which no water comes to it.
// 2. On each edge whose two sides belong to different ground (a ridge, the rim, beside level triangles): the
//    parts of it where they do, which end where such lines end.
// 3. Where all water comes to one group there is nothing to do but to see that.
#include "terrain/catchment_borders.hpp"

#include "base/ordered_blocks.hpp"
#include "base/parallel.hpp"
#include "terrain/uphill.hpp"

#include <thalweg/base/error.hpp>

#include <algorithm>
#include <array>
#include <tuple>
#include <vector>

namespace thalweg {

namespace {

constexpr std::size_t kBlock = 4096;
constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

/// Where a line ends on a side; seen uphill shares of the side grow to the left.
struct LineEnd {
  HalfedgeId side;
  double share = 0;
  std::uint32_t left = kOutside, right = kOutside;
  std::uint32_t point = 0;
  std::uint32_t next = kNone;  ///< end of a line in the same triangle
};

/// A part of an edge whose one side is of one group; `point` is its end.
struct Part {
  double end = 1;
  std::uint32_t group = kOutside;
  std::uint32_t point = 0;
};

/// What is found in a block of triangles.
struct Lines {
  std::vector<BorderSegment> segments;
  std::vector<BorderPoint> points;
  std::vector<LineEnd> ends;
};

/// What all blocks share.
struct Grounds {
  const FlowGraph& graph;
  std::span<const std::uint32_t> group;  ///< by node
};

/// Follows the lines that divide groups.
class LineFinder {
 public:
  LineFinder(const Grounds& grounds, Lines& lines)
      : graph_(grounds.graph), mesh_(graph_.mesh), group_(grounds.group), lines_(lines) {
    lines_.segments.clear();
    lines_.points.clear();
    lines_.ends.clear();
  }

  void look_at(std::size_t begin, std::size_t end) {
    // Without a jump: at which corners water parts cannot be foreseen. Where the corner is high all is equal.
    candidates_.resize(end - begin);
    std::size_t count = 0;
    for (std::size_t t = begin; t < end; ++t) {
      const TriangleShape shape = graph_.shape[t];
      if (shape.level() || shape.has_along()) continue;
      candidates_[count] = TriangleId{t};
      count += group_left_of(t, shape) != group_right_of(t, shape) ? 1 : 0;
    }
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t t = candidates_[i].index();
      const TriangleShape shape = graph_.shape[t];
      follow(Tin::halfedge(candidates_[i], shape.split), group_left_of(t, shape), group_right_of(t, shape));
    }
  }

 private:
  [[nodiscard]] std::uint32_t group_left_of(std::size_t t, TriangleShape shape) const {
    const std::array<unsigned, 2> side = {shape.split, kNextSide[shape.split]};
    return group_[graph_.target[3 * t + side[shape.corner_is_low]]];
  }
  [[nodiscard]] std::uint32_t group_right_of(std::size_t t, TriangleShape shape) const {
    const std::array<unsigned, 2> side = {shape.split, kPreviousSide[shape.split]};
    return group_[graph_.target[3 * t + side[shape.corner_is_low]]];
  }

  // From the corner across `h`, a split In side.
  void follow(HalfedgeId h, std::uint32_t left, std::uint32_t right) {
    std::uint32_t from = mesh_.apex(h).value();
    double share = graph_.strips[h.index() / 3].at;
    const auto go_to = [&](std::uint32_t to) { lines_.segments.push_back({from, to, left, right}); };
    for (;;) {
      // A line that comes to an end of the side comes to a vertex, and goes no further.
      if (!(share > 0)) return go_to(mesh_.origin(h).value());
      if (!(share < 1)) return go_to(mesh_.target(h).value());
      const auto to = static_cast<std::uint32_t>(mesh_.vertex_count() + lines_.points.size());
      lines_.points.push_back({share, h});
      go_to(to);
      from = to;
      const HalfedgeId side = mesh_.twin(h);
      if (!side.valid() || !graph_.hands_on(side)) {
        lines_.ends.push_back({h, share, left, right, to});
        return;
      }
      const TriangleId t = Tin::triangle_of(side);
      const TriangleShape shape = graph_.shape[t.index()];
      const double at = graph_.strips[t.index()].at, top = 1 - at;
      if (shape.corner_is_low != 0) {
        h = Tin::halfedge(t, shape.split);
        share = (side == Tin::previous(h) ? Uphill::before_corner(at) : Uphill::after_corner(at))(share);
      } else if (share == top) {
        return go_to(mesh_.apex(side).value());
      } else {
        const bool below = share < top;
        h = below ? Tin::next(side) : Tin::previous(side);
        share = (below ? Uphill::below_top(top) : Uphill::above_top(top))(share);
      }
    }
  }

  const FlowGraph& graph_;
  const FlowMesh& mesh_;
  std::span<const std::uint32_t> group_;
  Lines& lines_;
  std::vector<TriangleId> candidates_;
};

/// The ends of lines by triangle, as lists.
struct LineEnds {
  std::vector<LineEnd> ends;
  LargeVector<std::uint32_t> first;  ///< by triangle; kNone: none
};

/// Borders along the edges of a block of triangles.
struct Slot {
  std::vector<BorderSegment> segments;
  std::vector<Part> left, right, parts;
  std::vector<LineEnd> ends;
};

class EdgeFinder {
 public:
  EdgeFinder(const Grounds& grounds, const LineEnds& ends, Slot& slot)
      : graph_(grounds.graph), mesh_(graph_.mesh), group_(grounds.group), ends_(ends), slot_(slot) {
    slot_.segments.clear();
  }

  void look_at(std::size_t begin, std::size_t end) {
    // Without jumps, as above.
    candidates_.resize(3 * (end - begin) + 1);
    std::size_t count = 0;
    for (std::size_t t = begin; t < end; ++t) {
      const unsigned sides = graph_.meeting_sides[t];
      for (std::size_t side = 0; side < 3; ++side) {
        candidates_[count] = Tin::halfedge(TriangleId{t}, side);
        count += sides >> side & 1U;
      }
    }
    std::size_t left = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const HalfedgeId h = candidates_[i];
      candidates_[left] = h;
      left += is_ridge_in_one_ground(h, mesh_.twin(h)) ? 0 : 1;
    }
    for (std::size_t i = 0; i < left; ++i) add_edge(candidates_[i], mesh_.twin(candidates_[i]));
  }

 private:
  /// True for most ridges.
  [[nodiscard]] bool is_ridge_in_one_ground(HalfedgeId h, HalfedgeId twin) const {
    if (!twin.valid() || graph_.fall(h) != Fall::In || graph_.fall(twin) != Fall::In) return false;
    const bool ends_here = ends_.first[h.index() / 3] != kNone;
    const bool ends_beyond = ends_.first[twin.index() / 3] != kNone;
    const bool one_group = group_[graph_.target[h.index()]] == group_[graph_.target[twin.index()]];
    return !ends_here & !ends_beyond & one_group;
  }

  /// Fills `ends` with those on h, by share; of those at the same place each comes where the ground of the
  /// one before it ends. `group`: where h begins.
  void list_ends(HalfedgeId h, std::uint32_t group, std::vector<LineEnd>& ends) const {
    ends.clear();
    for (std::uint32_t i = ends_.first[h.index() / 3]; i != kNone; i = ends_.ends[i].next) {
      if (ends_.ends[i].side == h) ends.push_back(ends_.ends[i]);
    }
    std::sort(ends.begin(), ends.end(), [](const LineEnd& a, const LineEnd& b) {
      return std::tie(a.share, a.point) < std::tie(b.share, b.point);
    });
    for (auto here = ends.begin(); here != ends.end(); ++here) {
      const auto fits = [&](const LineEnd& e) { return e.share != here->share || e.right == group; };
      const auto found = std::find_if(here, ends.end(), fits);
      if (found != ends.end() && found->share == here->share) std::iter_swap(here, found);
      group = here->left;
    }
  }

  // The groups along h of its triangle's ground.
  void list_parts(HalfedgeId h, std::vector<Part>& parts) const {
    parts.clear();
    const std::uint32_t target = mesh_.target(h).value();
    const auto all_of = [&](FlowNode node) { parts.push_back({1, group_[node], target}); };
    const TriangleId t = Tin::triangle_of(h);
    switch (graph_.fall(h)) {
      case Fall::Level:
        return all_of(graph_.node_of(graph_.low_corner(t)));
      case Fall::Out:
        return all_of(graph_.node_of_channel(h));  // others are not looked at
      case Fall::Along: {  // as the water at its low end, which is the corner of the Out side
        const HalfedgeId split = graph_.strip_of(t).split;
        const HalfedgeId out = h == Tin::next(split) ? Tin::previous(split) : Tin::next(split);
        return all_of(graph_.target[out.index()]);
      }
      case Fall::In:
        break;
    }
    std::uint32_t group = group_[graph_.target[h.index()]];
    list_ends(h, group, slot_.ends);
    for (const LineEnd& end : slot_.ends) {
      parts.push_back({end.share, group, end.point});
      group = end.left;
    }
    parts.push_back({1, group, target});
  }

  void add_edge(HalfedgeId h, HalfedgeId twin) {
    std::vector<Part>&left = slot_.left, &right = slot_.right, &parts = slot_.parts;
    list_parts(h, left);
    right.clear();
    const std::uint32_t end = mesh_.target(h).value();
    if (twin.valid()) {
      list_parts(twin, parts);
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
      if (left[i].group != right[j].group && at != to) {
        slot_.segments.push_back({at, to, left[i].group, right[j].group});
      }
      at = to;
      end_left ? ++i : ++j;
    }
  }

  const FlowGraph& graph_;
  const FlowMesh& mesh_;
  std::span<const std::uint32_t> group_;
  const LineEnds& ends_;
  Slot& slot_;
  std::vector<HalfedgeId> candidates_;
};

/// Adds a block's lines, whose points begin where those of the blocks before it end.
void add_lines(const FlowGraph& graph, Lines& lines, CatchmentBorders& borders, LineEnds& ends) {
  const std::size_t n = graph.mesh.vertex_count(), known = borders.points.size();
  if (n + known + lines.points.size() > kNone) {
    throw Error(ErrorCode::SizeLimit,
                "the borders of catchments have more than 4294967295 points; split the area");
  }
  const auto shift = static_cast<std::uint32_t>(known);
  const auto renumber = [&](std::uint32_t point) { return point < n ? point : point + shift; };
  for (const BorderSegment& s : lines.segments) {
    borders.segments.push_back({renumber(s.from), renumber(s.to), s.left, s.right});
  }
  borders.points.insert(borders.points.end(), lines.points.begin(), lines.points.end());
  for (LineEnd& end : lines.ends) {
    std::uint32_t& first = ends.first[end.side.index() / 3];
    end.point += shift;
    end.next = first;
    first = static_cast<std::uint32_t>(ends.ends.size());
    ends.ends.push_back(end);
  }
}

}  // namespace

FlowPoint CatchmentBorders::point(const FlowGraph& graph, std::uint32_t number) const {
  const FlowMesh& mesh = graph.mesh;
  if (number < mesh.vertex_count()) {
    const VertexId v{number};
    return {.xy = mesh.point(v), .z = mesh.height(v), .along = 0, .edge = {}, .vertex = mesh.given(v)};
  }
  const auto [share, side] = points[number - mesh.vertex_count()];
  const Point2 a = mesh.point(mesh.origin(side)), b = mesh.point(mesh.target(side));
  // Several lines may end beside a vertex nearer than coordinates can tell: there, in whatever order.
  constexpr double kAtEnd = 1e-12;
  const Point2 between = {a.x + share * (b.x - a.x), a.y + share * (b.y - a.y)};
  return {.xy = share < kAtEnd       ? a
                : 1 - share < kAtEnd ? b
                                     : between,
          .z = 0,
          .along = share,
          .edge = mesh.given(side),
          .vertex = {}};
}

bool CatchmentBorders::is_before(const FlowGraph& graph, std::uint32_t p, std::uint32_t q) const {
  const std::size_t n = graph.mesh.vertex_count();
  if (p < n && q < n) return graph.mesh.given(VertexId{p}) < graph.mesh.given(VertexId{q});
  if (p < n || q < n) return p < n;
  const BorderPoint &a = points[p - n], &b = points[q - n];
  return std::tuple(graph.mesh.given(a.side), a.share, p) < std::tuple(graph.mesh.given(b.side), b.share, q);
}

CatchmentBorders find_borders(const FlowGraph& graph, std::span<const std::uint32_t> group_of_sink,
                              const Progress& progress) {
  RawVector<std::uint32_t> group(graph.node_count());
  for_each_block(group.size(), kBlock, progress, [&](std::size_t begin, std::size_t end) {
    for (std::size_t node = begin; node < end; ++node) {
      const std::uint32_t sink = graph.sink_of_node[node];
      group[node] = sink == SinkId::kInvalid ? kOutside : group_of_sink[sink];
    }
  });
  const std::size_t triangles = graph.mesh.triangle_count();
  const Grounds grounds{graph, group};
  CatchmentBorders borders;
  LineEnds ends{{}, LargeVector<std::uint32_t>(triangles, kNone)};
  for_each_block_in_order<Lines>(
      triangles, kBlock, progress,
      [&](std::size_t begin, std::size_t end, Lines& lines) {
        LineFinder(grounds, lines).look_at(begin, end);
      },
      [&](std::size_t /*begin*/, std::size_t /*end*/, Lines& lines) {
        add_lines(graph, lines, borders, ends);
      });
  for_each_block_in_order<Slot>(
      triangles, kBlock, progress,
      [&](std::size_t begin, std::size_t end, Slot& slot) {
        EdgeFinder(grounds, ends, slot).look_at(begin, end);
      },
      [&](std::size_t /*begin*/, std::size_t /*end*/, const Slot& slot) {
        borders.segments.insert(borders.segments.end(), slot.segments.begin(), slot.segments.end());
      });
  return borders;
}

}  // namespace thalweg
