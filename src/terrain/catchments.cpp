// Catchments as polygons.
//
// 1. Borders: in each triangle the lines that end pieces of its In sides, each from the piece below or from
// the
//    corner at which water parts, up to the side; where such a line meets the upper corner, up to it. On each
//    edge whose two sides belong to different ground (a ridge, the rim, beside level triangles): the parts of
//    it where they do.
// 2. Every border gives a directed segment to the ground on its left, the reverse one to that on its right.
//    Ends are vertices and ends of pieces, by number, so segments chain without a look at coordinates; where
//    a ground touches itself at a point the next segment is the first clockwise from the one that comes in.
// 3. A chain that meets a point again closes a ring there. Rings that run clockwise are holes of the smallest
//    ring around them.
#include "terrain/flow_graph.hpp"

#include <thalweg/terrain/catchments.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <tuple>
#include <unordered_map>
#include <utility>

namespace thalweg {

namespace {

constexpr std::uint32_t kOutside = std::numeric_limits<std::uint32_t>::max();

struct Segment {
  std::uint32_t group = 0;
  std::uint32_t from = 0;
  std::uint32_t to = 0;
};

/// A part of an edge whose one side is of one group; `point` is its end.
struct Part {
  double end = 1;
  std::uint32_t group = kOutside;
  std::uint32_t point = 0;
};

class Outliner {
 public:
  Outliner(const SurfaceFlow& flow, std::span<const std::uint32_t> group_of_sink)
      : graph_(flow.graph()), tin_(graph_.tin), group_of_sink_(group_of_sink) {}

  std::vector<Catchment> run(Progress& progress) {
    progress.start_phase("outline catchments");
    side_of_piece_.resize(graph_.pieces.size());
    for (std::size_t i = 0; i < tin_.halfedge_count(); ++i) {
      if (i % (1U << 16U) == 0)
        progress.advance(0.5 * static_cast<double>(i) / static_cast<double>(tin_.halfedge_count()));
      const HalfedgeId h{i};
      if (graph_.fall[i] == Fall::In) add_lines(h);
      if (graph_.fall[i] == Fall::Out) add_line_to_top(h);
      if (tin_.represents_edge(h)) add_edge(h);
    }
    std::sort(segments_.begin(), segments_.end(), [](const Segment& a, const Segment& b) {
      return std::tie(a.group, a.from, a.to) < std::tie(b.group, b.from, b.to);
    });
    progress.advance(0.7);
    chain(progress);
    progress.advance(1);
    return std::move(catchments_);
  }

 private:
  [[nodiscard]] std::uint32_t group_of(FlowNode node) const {
    return group_of_sink_[graph_.sink_of_node(node)];
  }
  [[nodiscard]] std::uint32_t point_of_piece(std::uint32_t piece) const {
    return static_cast<std::uint32_t>(tin_.vertex_count()) + piece;
  }

  void add_segment(std::uint32_t from, std::uint32_t to, std::uint32_t left, std::uint32_t right) {
    if (left == right || from == to) return;
    if (left != kOutside) segments_.push_back({left, from, to});
    if (right != kOutside) segments_.push_back({right, to, from});
  }

  // Seen uphill the shares of an In side grow to the left.
  void add_lines(HalfedgeId h) {
    const std::uint32_t first = graph_.pieces_first[h.index()], count = graph_.pieces_count[h.index()];
    for (std::uint32_t i = first; i < first + count; ++i) {
      side_of_piece_[i] = h;
      if (i + 1 == first + count) break;
      const std::uint32_t right = group_of(graph_.pieces[i].node), left = group_of(graph_.pieces[i + 1].node);
      if (left == right) continue;
      const std::uint32_t from = graph_.pieces[i].from;
      add_segment(from == FlowPiece::kFromCorner ? tin_.apex(h).value() : point_of_piece(from),
                  point_of_piece(i), left, right);
    }
  }

  void add_line_to_top(HalfedgeId h) {
    if (graph_.channel[h.index()] != 0) return;
    const HalfedgeId twin = tin_.twin(h);
    const std::uint32_t first = graph_.pieces_first[twin.index()], count = graph_.pieces_count[twin.index()];
    if (count == 0) return;
    const Strip strip = graph_.strip_of(Tin::triangle_of(h));
    if (strip.corner_is_low) return;
    for (std::uint32_t i = first; i + 1 < first + count; ++i) {
      if (graph_.pieces[i].end != 1 - strip.at) continue;
      add_segment(point_of_piece(i), tin_.apex(h).value(), group_of(graph_.pieces[i + 1].node),
                  group_of(graph_.pieces[i].node));
    }
  }

  // The groups along h of its triangle's ground.
  void list_parts(HalfedgeId h, std::vector<Part>& parts) const {
    parts.clear();
    const auto all_of = [&](FlowNode node) { parts.push_back({1, group_of(node), tin_.target(h).value()}); };
    FlowPiece single;
    switch (graph_.fall[h.index()]) {
      case Fall::Level:
        return all_of(graph_.node_of(graph_.low_corner(Tin::triangle_of(h))));
      case Fall::Out:
        return all_of(graph_.node_of_channel(h));  // others are not looked at
      case Fall::Along: {
        const Strip strip = graph_.strip_of(Tin::triangle_of(h));
        const std::span<const FlowPiece> pieces = graph_.taken_in(strip.split, single);
        return all_of(h == Tin::next(strip.split) ? pieces.back().node : pieces.front().node);
      }
      case Fall::In:
        break;
    }
    const std::uint32_t first = graph_.pieces_first[h.index()];
    const std::span<const FlowPiece> pieces = graph_.taken_in(h, single);
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      const std::uint32_t group = group_of(pieces[i].node);
      const bool last = i + 1 == pieces.size();
      const Part part{last ? 1 : pieces[i].end, group,
                      last ? tin_.target(h).value() : point_of_piece(first + static_cast<std::uint32_t>(i))};
      if (!parts.empty() && parts.back().group == group) {
        parts.back() = part;
      } else {
        parts.push_back(part);
      }
    }
  }

  void add_edge(HalfedgeId h) {
    const HalfedgeId twin = tin_.twin(h);
    if (twin.valid()) {
      const Fall here = graph_.fall[h.index()], there = graph_.fall[twin.index()];
      const bool out = here == Fall::Out || there == Fall::Out, in = here == Fall::In || there == Fall::In;
      if (graph_.channel[h.index()] == 0 && out && in) return;  // all that comes goes on
      if (here == Fall::Out && there == Fall::Out) return;
    }
    list_parts(h, left_);
    right_.clear();
    if (twin.valid()) {
      list_parts(twin, parts_);
      for (std::size_t i = parts_.size(); i-- > 0;) {  // the end of a part is the end of the one before it
        right_.push_back({i == 0 ? 1 : 1 - parts_[i - 1].end, parts_[i].group,
                          i == 0 ? tin_.target(h).value() : parts_[i - 1].point});
      }
    } else {
      right_.push_back({1, kOutside, tin_.target(h).value()});
    }
    std::uint32_t at = tin_.origin(h).value();
    for (std::size_t i = 0, j = 0; i < left_.size() && j < right_.size();) {
      const bool end_left = i + 1 < left_.size() && (j + 1 == right_.size() || left_[i].end <= right_[j].end);
      const std::uint32_t to = end_left ? left_[i].point : right_[j].point;
      add_segment(at, to, left_[i].group, right_[j].group);
      at = to;
      end_left ? ++i : ++j;
    }
  }

  [[nodiscard]] FlowPoint point(std::uint32_t number) const {
    if (number < tin_.vertex_count()) {
      const VertexId v{number};
      return {.xy = tin_.point(v), .z = tin_.height(v), .edge = {}, .along = 0, .vertex = v};
    }
    const std::uint32_t piece = number - static_cast<std::uint32_t>(tin_.vertex_count());
    const HalfedgeId h = side_of_piece_[piece];
    const Point2 a = tin_.point(tin_.origin(h)), b = tin_.point(tin_.target(h));
    const double share = graph_.pieces[piece].end;
    return {.xy = {a.x + share * (b.x - a.x), a.y + share * (b.y - a.y)},
            .z = 0,
            .edge = h,
            .along = share,
            .vertex = {}};
  }

  // The segment that goes on from `segment`, or the end.
  std::size_t next_of(const Segment& segment) const {
    const auto less = [](const Segment& a, const Segment& b) {
      return std::tie(a.group, a.from) < std::tie(b.group, b.from);
    };
    const Segment key{segment.group, segment.to, 0};
    const auto [begin, end] = std::equal_range(segments_.begin(), segments_.end(), key, less);
    std::size_t best = segments_.size();
    double least = 0;
    const Point2 here = point(segment.to).xy;
    const auto direction = [&](std::uint32_t to) {
      const Point2 p = point(to).xy;
      return std::atan2(p.y - here.y, p.x - here.x);
    };
    for (auto s = begin; s != end; ++s) {
      const auto index = static_cast<std::size_t>(s - segments_.begin());
      if (used_[index]) continue;
      if (end - begin == 1) return index;
      double turn = direction(segment.from) - direction(s->to);  // clockwise
      if (turn <= 0) turn += 2 * std::numbers::pi;
      if (best == segments_.size() || turn < least) {
        best = index;
        least = turn;
      }
    }
    return best;
  }

  void chain(const Progress& progress) {
    used_.assign(segments_.size(), false);
    std::vector<std::uint32_t> path;
    std::unordered_map<std::uint32_t, std::size_t> place;
    for (std::size_t start = 0; start < segments_.size(); ++start) {
      if (start % (1U << 14U) == 0) progress.check();
      if (start == 0 || segments_[start].group != segments_[start - 1].group) {
        if (start > 0) add_catchment(segments_[start - 1].group);
      }
      if (used_[start]) continue;
      path.clear();
      place.clear();
      for (std::size_t s = start; s < segments_.size(); s = next_of(segments_[s])) {
        used_[s] = true;
        const std::uint32_t from = segments_[s].from;
        if (const auto met = place.find(from); met != place.end()) {
          close(path, place, met->second);
        }
        place[from] = path.size();
        path.push_back(from);
      }
      close(path, place, 0);
    }
    if (!segments_.empty()) add_catchment(segments_.back().group);
  }

  void close(std::vector<std::uint32_t>& path, std::unordered_map<std::uint32_t, std::size_t>& place,
             std::size_t begin) {
    CatchmentRing ring;
    for (std::size_t i = begin; i < path.size(); ++i) {
      place.erase(path[i]);
      ring.push_back(point(path[i]));
    }
    path.resize(begin);
    if (ring.size() > 2) rings_.push_back(std::move(ring));
  }

  static double doubled_area(const CatchmentRing& ring) {
    double sum = 0;
    const Point2 o = ring.front().xy;
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Point2 p = ring[i].xy, q = ring[(i + 1) % ring.size()].xy;
      sum += (p.x - o.x) * (q.y - o.y) - (p.y - o.y) * (q.x - o.x);
    }
    return sum;
  }

  static bool holds(const CatchmentRing& ring, Point2 p) {
    bool inside = false;
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Point2 a = ring[i].xy, b = ring[(i + 1) % ring.size()].xy;
      if ((a.y > p.y) == (b.y > p.y)) continue;
      if (p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x)) inside = !inside;
    }
    return inside;
  }

  void add_catchment(std::uint32_t group) {
    Catchment catchment{group, {}};
    std::vector<CatchmentRing> holes;
    std::vector<double> area;
    for (CatchmentRing& ring : rings_) {
      const double doubled = doubled_area(ring);
      if (doubled > 0) {
        catchment.polygons.push_back({std::move(ring), {}});
        area.push_back(doubled);
      } else {
        holes.push_back(std::move(ring));
      }
    }
    for (CatchmentRing& hole : holes) {
      const Point2 p{(hole[0].xy.x + hole[1].xy.x) / 2, (hole[0].xy.y + hole[1].xy.y) / 2};
      std::size_t around = 0;
      bool found = area.size() == 1;
      for (std::size_t i = 0; i < area.size() && area.size() > 1; ++i) {
        if (found && area[i] >= area[around]) continue;
        if (!holds(catchment.polygons[i].outer, p)) continue;
        around = i;
        found = true;
      }
      if (found) catchment.polygons[around].holes.push_back(std::move(hole));
    }
    rings_.clear();
    if (!catchment.polygons.empty()) catchments_.push_back(std::move(catchment));
  }

  const FlowGraph& graph_;
  const Tin& tin_;
  std::span<const std::uint32_t> group_of_sink_;
  std::vector<HalfedgeId> side_of_piece_;
  std::vector<Segment> segments_;
  std::vector<bool> used_;
  std::vector<Part> left_, right_, parts_;
  std::vector<CatchmentRing> rings_;
  std::vector<Catchment> catchments_;
};

}  // namespace

std::vector<Catchment> outline_catchments(const SurfaceFlow& flow,
                                          std::span<const std::uint32_t> group_of_sink, Progress& progress) {
  return Outliner(flow, group_of_sink).run(progress);
}

}  // namespace thalweg
