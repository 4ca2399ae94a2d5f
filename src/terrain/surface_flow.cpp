// The flow of a TIN, put together, and paths on it.
//
// A path is a walk over the same shares by which pieces are mapped, so it comes to the channel that the
// pieces name, but for points nearer to a divide than rounding.
#include "terrain/flow_graph.hpp"

#include <thalweg/base/error.hpp>

#include <algorithm>
#include <array>
#include <string>

namespace thalweg {

namespace {

double area_of(const Tin& tin, TriangleId t) {
  const Triangle& c = tin.triangle(t);
  const Point2 a = tin.point(c[0]), b = tin.point(c[1]), d = tin.point(c[2]);
  return ((b.x - a.x) * (d.y - a.y) - (b.y - a.y) * (d.x - a.x)) / 2;
}

/// The strips of a triangle between a corner and the line that splits it, by what they come to. Shares from
/// `from` (at the corner) to `to` (at the line), in either direction: a strip's area is the difference of
/// squares.
void add_strips(std::span<const FlowPiece> pieces, double from, double to, double area,
                std::vector<double>& ground) {
  const double whole = to - from;
  if (whole == 0) return;
  double begin = 0;
  for (const FlowPiece& piece : pieces) {
    const double low = std::max(begin, std::min(from, to)), high = std::min(piece.end, std::max(from, to));
    begin = piece.end;
    if (!(low < high)) continue;
    const double p = (low - from) / whole, q = (high - from) / whole;
    ground[piece.node] += area * std::abs((q - p) * (q + p));
  }
}

Point2 between(Point2 a, Point2 b, double share) {
  return {a.x + share * (b.x - a.x), a.y + share * (b.y - a.y)};
}

/// Follows water down.
class Walk {
 public:
  explicit Walk(const FlowGraph& graph) : graph_(graph), tin_(graph.tin) {}

  FlowPath from(VertexId v) {
    arrive(v);
    run();
    return std::move(path_);
  }

  FlowPath leg(VertexId v) {
    arrive(v);
    leave_vertex();
    while (side_.valid() && graph_.channel[side_.index()] == 0) cross_side();
    path_.sink = {};
    return std::move(path_);
  }

  FlowPath from(TriangleId t, Point2 p) {
    path_.points.push_back({.xy = p, .z = height_in(t, p)});
    if (graph_.level(t)) {
      arrive(graph_.low_corner(t));
    } else {
      const Strip strip = graph_.strip_of(t);
      const double share = graph_.share_of(t, strip, p);
      strip.corner_is_low ? enter(strip.split, share) : reach(strip.split, share);
    }
    run();
    return std::move(path_);
  }

 private:
  [[nodiscard]] double height_in(TriangleId t, Point2 p) const {
    const Triangle& c = tin_.triangle(t);
    const Point2 o = tin_.point(c[0]);
    const double x1 = tin_.point(c[1]).x - o.x, y1 = tin_.point(c[1]).y - o.y;
    const double x2 = tin_.point(c[2]).x - o.x, y2 = tin_.point(c[2]).y - o.y;
    const double area = x1 * y2 - x2 * y1, x = p.x - o.x, y = p.y - o.y;
    const double z0 = tin_.height(c[0]);
    const double z = z0 + (x * y2 - x2 * y) / area * (tin_.height(c[1]) - z0) +
                     (x1 * y - x * y1) / area * (tin_.height(c[2]) - z0);
    const auto [low, high] = std::minmax({z0, tin_.height(c[1]), tin_.height(c[2])});
    return std::clamp(z, low, high);
  }

  void arrive(VertexId v) {
    path_.points.push_back({.xy = tin_.point(v), .z = tin_.height(v), .edge = {}, .along = 0, .vertex = v});
    vertex_ = v;
    side_ = {};
  }

  // The path is at the share `at` of h, and runs over h out of its triangle.
  void reach(HalfedgeId h, double at) {
    const double za = tin_.height(tin_.origin(h)), zb = tin_.height(tin_.target(h));
    const double before = path_.points.empty() ? std::max(za, zb) : path_.points.back().z;
    path_.points.push_back({.xy = between(tin_.point(tin_.origin(h)), tin_.point(tin_.target(h)), at),
                            .z = std::min(before, za + at * (zb - za)),
                            .edge = h,
                            .along = at,
                            .vertex = {}});
    side_ = h;
    at_ = at;
  }

  // The path is at the share `at` of h, and runs over h into its triangle.
  void enter(HalfedgeId h, double at) {
    const Strip strip = graph_.strip_of(Tin::triangle_of(h));
    if (strip.corner_is_low) {
      const bool first = at < strip.at || strip.at >= 1;
      first ? reach(Tin::previous(h), 1 - at / strip.at)
            : reach(Tin::next(h), 1 - (at - strip.at) / (1 - strip.at));
      return;
    }
    const double top = 1 - strip.at;
    reach(strip.split, h == Tin::next(strip.split) ? 1 - at * top : 1 - (top + at * (1 - top)));
  }

  void run() {
    while (side_.valid() ? cross_side() : leave_vertex()) {
    }
  }

  bool cross_side() {
    if (graph_.channel[side_.index()] == 0) {
      enter(tin_.twin(side_), 1 - at_);
      return true;
    }
    const VertexId end = graph_.low_end(side_);
    if (tin_.on_rim(side_)) {
      path_.sink = SinkId{graph_.rim_sink[end.index()]};
      return false;
    }
    arrive(end);
    return true;
  }

  bool leave_vertex() {
    const VertexStep& step = graph_.step[vertex_.index()];
    switch (step.kind) {
      case Step::Edge:
        arrive(step.neighbour);
        return true;
      case Step::Cross:
        reach(step.across, step.at);
        return true;
      case Step::Leave:
        path_.sink = SinkId{graph_.rim_sink[vertex_.index()]};
        return false;
      case Step::Stay:
        break;
    }
    path_.sink = SinkId{graph_.sink[vertex_.index()]};
    return false;
  }

  const FlowGraph& graph_;
  const Tin& tin_;
  FlowPath path_;
  VertexId vertex_;
  HalfedgeId side_;
  double at_ = 0;
};

}  // namespace

void measure_grounds(FlowGraph& graph) {
  const Tin& tin = graph.tin;
  graph.ground.assign(tin.halfedge_count() + tin.vertex_count(), 0);
  FlowPiece single;
  for (std::size_t i = 0; i < tin.triangle_count(); ++i) {
    const TriangleId t{i};
    const double area = area_of(tin, t);
    if (graph.level(t)) {
      graph.ground[graph.node_of(graph.low_corner(t))] += area;
      continue;
    }
    const Strip strip = graph.strip_of(t);
    if (strip.corner_is_low) {
      const HalfedgeId left = Tin::previous(strip.split), right = Tin::next(strip.split);
      if (strip.at > 0) add_strips(graph.passed_on(left, single), 0, 1, area * strip.at, graph.ground);
      if (strip.at < 1) add_strips(graph.passed_on(right, single), 1, 0, area * (1 - strip.at), graph.ground);
    } else {
      const double top = 1 - strip.at;
      const std::span<const FlowPiece> pieces = graph.passed_on(strip.split, single);
      add_strips(pieces, 0, top, area * top, graph.ground);
      add_strips(pieces, 1, top, area * (1 - top), graph.ground);
    }
  }
}

SurfaceFlow::SurfaceFlow(const Tin& tin, std::span<const VertexId> outlets, Progress& progress)
    : graph_(std::make_unique<FlowGraph>(tin)) {
  constexpr std::size_t kMostVertices = std::size_t{1} << 29U;  // so that FlowNodes have 32 bits
  if (tin.vertex_count() >= kMostVertices) {
    throw Error(ErrorCode::SizeLimit,
                "the TIN has " + std::to_string(tin.vertex_count()) +
                    " vertices; flow can be found on fewer than 536870912: split the area");
  }
  progress.start_phase("find flow");
  graph_->flats = resolve_flats(tin, outlets, progress);
  find_falls(*graph_, progress);
  find_pieces(*graph_, progress);
  find_steps(*graph_, outlets, progress);
  find_sinks(*graph_, outlets);
  measure_grounds(*graph_);
  for (std::size_t node = 0; node < graph_->ground.size(); ++node) {
    const double area = graph_->ground[node];
    if (area > 0) graph_->sinks[graph_->sink_of_node(static_cast<FlowNode>(node))].area += area;
  }
  progress.advance(1);
}

SurfaceFlow::~SurfaceFlow() = default;
SurfaceFlow::SurfaceFlow(SurfaceFlow&&) noexcept = default;

std::span<const Sink> SurfaceFlow::sinks() const {
  return graph_->sinks;
}

SinkId SurfaceFlow::sink_of(VertexId v) const {
  const std::uint32_t sink = graph_->sink[v.index()];
  return sink == SinkId::kInvalid ? SinkId{} : SinkId{sink};
}

bool SurfaceFlow::is_valley(HalfedgeId h) const {
  const Tin& tin = graph_->tin;
  const HalfedgeId twin = tin.twin(h);
  if (!twin.valid() || !graph_->drains(h) || !graph_->drains(twin)) return false;
  const bool takes_water = graph_->fall[h.index()] == Fall::Out || graph_->fall[twin.index()] == Fall::Out;
  return takes_water && tin.height(tin.origin(h)) != tin.height(tin.target(h));
}

bool SurfaceFlow::is_ridge(HalfedgeId h) const {
  const HalfedgeId twin = graph_->tin.twin(h);
  return twin.valid() && graph_->fall[h.index()] == Fall::In && graph_->fall[twin.index()] == Fall::In;
}

std::size_t SurfaceFlow::broken_cycles() const {
  return graph_->broken_cycles;
}

FlowPath SurfaceFlow::path_from(VertexId v) const {
  return Walk(*graph_).from(v);
}

FlowPath SurfaceFlow::leg_from(VertexId v) const {
  return Walk(*graph_).leg(v);
}

FlowPath SurfaceFlow::path_from(TriangleId t, Point2 p) const {
  return Walk(*graph_).from(t, p);
}

}  // namespace thalweg
