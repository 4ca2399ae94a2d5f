// The flow of a TIN, put together, and paths on it.
//
// A path is a walk over the same shares by which strips are followed upwards, so it comes to the channel to
// whose ground it belongs, but for points nearer to a divide than rounding.
#include "terrain/flow_graph.hpp"

#include <thalweg/base/error.hpp>
#include <thalweg/geometry/predicates.hpp>

#include <algorithm>
#include <array>
#include <string>

namespace thalweg {

namespace {

Point2 between(Point2 a, Point2 b, double share) {
  return {a.x + share * (b.x - a.x), a.y + share * (b.y - a.y)};
}

/// Follows water down.
class Walk {
 public:
  explicit Walk(const FlowGraph& graph) : graph_(graph), mesh_(graph.mesh) {}

  FlowPath from(VertexId v) {
    arrive(v);
    run();
    return std::move(path_);
  }

  FlowPath leg(VertexId v) {
    arrive(v);
    leave_vertex();
    while (side_.valid() && !graph_.is_channel(side_)) cross_side();
    path_.sink = {};
    return std::move(path_);
  }

  FlowPath from(TriangleId t, Point2 p) {
    if (const VertexId corner = corner_at(t, p); corner.valid()) return from(corner);
    path_.points.push_back({.xy = p, .z = height_in(t, p)});
    if (const HalfedgeId edge = edge_at(t, p); edge.valid()) {
      leave_edge(edge, share_on(edge, p));
    } else if (graph_.level(t)) {
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
    const Triangle& c = mesh_.triangle(t);
    const Point2 o = mesh_.point(c[0]);
    const double x1 = mesh_.point(c[1]).x - o.x, y1 = mesh_.point(c[1]).y - o.y;
    const double x2 = mesh_.point(c[2]).x - o.x, y2 = mesh_.point(c[2]).y - o.y;
    const double area = x1 * y2 - x2 * y1, x = p.x - o.x, y = p.y - o.y;
    const double z0 = mesh_.height(c[0]);
    const double z = z0 + (x * y2 - x2 * y) / area * (mesh_.height(c[1]) - z0) +
                     (x1 * y - x * y1) / area * (mesh_.height(c[2]) - z0);
    const auto [low, high] = std::minmax({z0, mesh_.height(c[1]), mesh_.height(c[2])});
    return std::clamp(z, low, high);
  }

  [[nodiscard]] VertexId corner_at(TriangleId t, Point2 p) const {
    for (const VertexId corner : mesh_.triangle(t)) {
      if (mesh_.point(corner) == p) return corner;
    }
    return {};
  }

  /// The side on which a point lies, or by which it lies so near that where its line of flow meets it is all
  /// rounding: the triangle falls almost along it. None: there is none.
  [[nodiscard]] HalfedgeId edge_at(TriangleId t, Point2 p) const {
    for (std::size_t side = 0; side < 3; ++side) {
      const HalfedgeId h = Tin::halfedge(t, side);
      if (orientation(mesh_.point(mesh_.origin(h)), mesh_.point(mesh_.target(h)), p) == 0) return h;
    }
    if (graph_.level(t)) return {};
    constexpr double kSliver = 1e-9;
    const Strip strip = graph_.strip_of(t);
    if (!strip.corner_is_low) return {};
    const double share = graph_.share_of(t, strip, p);
    if (strip.at > 0 && strip.at < kSliver && share <= strip.at) return Tin::previous(strip.split);
    if (strip.at < 1 && 1 - strip.at < kSliver && share >= strip.at) return Tin::next(strip.split);
    return {};
  }

  /// Where the foot of a point lies on a halfedge's way.
  [[nodiscard]] double share_on(HalfedgeId h, Point2 p) const {
    const Point2 a = mesh_.point(mesh_.origin(h)), b = mesh_.point(mesh_.target(h));
    const double x = b.x - a.x, y = b.y - a.y;
    return std::clamp(((p.x - a.x) * x + (p.y - a.y) * y) / (x * x + y * y), 0.0, 1.0);
  }

  /// The square of a triangle's slope; the same bits whatever the numbers of its corners.
  [[nodiscard]] double steepness(TriangleId t) const {
    Triangle c = mesh_.triangle(t);
    std::sort(c.begin(), c.end(), [&](VertexId a, VertexId b) { return mesh_.point(a) < mesh_.point(b); });
    const Point2 o = mesh_.point(c[0]), p = mesh_.point(c[1]), q = mesh_.point(c[2]);
    const double x1 = p.x - o.x, y1 = p.y - o.y, z1 = mesh_.height(c[1]) - mesh_.height(c[0]);
    const double x2 = q.x - o.x, y2 = q.y - o.y, z2 = mesh_.height(c[2]) - mesh_.height(c[0]);
    const double x = y1 * z2 - y2 * z1, y = z1 * x2 - z2 * x1, area = x1 * y2 - x2 * y1;
    return (x * x + y * y) / (area * area);
  }

  /// From a point of an edge: along it if it is a channel, else into the triangle that takes water in there,
  /// the steeper one of a ridge (of equally steep ones that whose corner across is the first by (x, y)).
  void leave_edge(HalfedgeId h, double at) {
    const HalfedgeId twin = mesh_.twin(h);
    const auto takes_in = [&](HalfedgeId side) { return side.valid() && graph_.fall(side) == Fall::In; };
    if (graph_.is_channel(h)) {
      side_ = h;
      at_ = at;
    } else if (takes_in(h) && !(takes_in(twin) && is_better(twin, h))) {
      enter(h, at);
    } else if (takes_in(twin)) {
      enter(twin, 1 - at);
    } else {
      const VertexId low = graph_.low_corner(Tin::triangle_of(h));  // level on both sides
      arrive(twin.valid() ? graph_.lower(low, graph_.low_corner(Tin::triangle_of(twin))) : low);
    }
  }

  [[nodiscard]] bool is_better(HalfedgeId g, HalfedgeId h) const {
    const double of_g = steepness(Tin::triangle_of(g)), of_h = steepness(Tin::triangle_of(h));
    if (of_g != of_h) return of_g > of_h;
    return mesh_.point(mesh_.target(Tin::next(g))) < mesh_.point(mesh_.target(Tin::next(h)));
  }

  /// Rounding may have left points before a vertex a little lower.
  void arrive(VertexId v) {
    const double z = mesh_.height(v);
    for (auto before = path_.points.rbegin(); before != path_.points.rend() && before->z < z; ++before) {
      before->z = z;
    }
    path_.points.push_back({.xy = mesh_.point(v), .z = z, .along = 0, .edge = {}, .vertex = mesh_.given(v)});
    vertex_ = v;
    side_ = {};
  }

  // The path is at the share `at` of h, and runs over h out of its triangle.
  void reach(HalfedgeId h, double at) {
    const VertexId a = mesh_.origin(h), b = mesh_.target(h);
    const double za = mesh_.height(a), zb = mesh_.height(b);
    const double before = path_.points.empty() ? std::max(za, zb) : path_.points.back().z;
    const Point2 xy = between(mesh_.point(a), mesh_.point(b), at);
    const double inside = std::clamp(za + at * (zb - za), std::min(za, zb), std::max(za, zb));
    const double z = xy == mesh_.point(a) ? za : xy == mesh_.point(b) ? zb : inside;
    path_.points.push_back(
        {.xy = xy, .z = std::min(before, z), .along = at, .edge = mesh_.given(h), .vertex = {}});
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
    if (!graph_.is_channel(side_)) {
      enter(mesh_.twin(side_), 1 - at_);
      return true;
    }
    const VertexId end = graph_.low_end(side_);
    if (mesh_.on_rim(side_) && graph_.fall(side_) == Fall::Out) {
      path_.sink = SinkId{graph_.rim_sink[end.index()]};
      return false;
    }
    arrive(end);
    return true;
  }

  bool leave_vertex() {
    const VertexStep& step = graph_.step[vertex_.index()];
    switch (step.kind) {
      case VertexStep::Kind::Edge:
        arrive(graph_.neighbour(vertex_, step));
        return true;
      case VertexStep::Kind::Cross:
        reach(step.edge, graph_.strips[Tin::triangle_of(step.edge).index()].at);
        return true;
      case VertexStep::Kind::Leave:
        path_.sink = SinkId{graph_.rim_sink[vertex_.index()]};
        return false;
      case VertexStep::Kind::Stay:
        break;
    }
    path_.sink = SinkId{graph_.sink[vertex_.index()]};
    return false;
  }

  const FlowGraph& graph_;
  const FlowMesh& mesh_;
  FlowPath path_;
  VertexId vertex_;
  HalfedgeId side_;
  double at_ = 0;
};

}  // namespace

SurfaceFlow::SurfaceFlow(const Tin& tin, std::span<const VertexId> outlets, Progress& progress)
    : SurfaceFlow(tin, outlets, {}, progress) {}

SurfaceFlow::SurfaceFlow(const Tin& tin, std::span<const VertexId> outlets,
                         std::span<const VertexId> stations, Progress& progress) {
  constexpr std::size_t kMostVertices = std::size_t{1} << 29U;  // so that FlowNodes have 31 bits
  if (tin.vertex_count() >= kMostVertices) {
    throw Error(ErrorCode::SizeLimit,
                "the TIN has " + std::to_string(tin.vertex_count()) +
                    " vertices; flow can be found on fewer than 536870912: split the area");
  }
  progress.start_phase("find flow");
  graph_ = std::make_unique<FlowGraph>(tin, progress);
  FlowGraph& graph = *graph_;
  std::vector<VertexId> given;
  for (const VertexId v : outlets) given.push_back(graph.mesh.own(v));
  find_falls(graph, progress);
  const auto keep_at = [&](VertexId v) { graph.step[v.index()] = {.edge = graph.step[v.index()].edge}; };
  for (const VertexId v : given) keep_at(v);
  graph.flats = resolve_flats(graph.mesh, given, graph.rim, graph.step, progress);
  find_channels(graph, progress);
  break_cycles(graph, progress);
  sweep_grounds(graph, progress);
  find_steps(graph, progress);
  for (const VertexId v : stations) {
    given.push_back(graph.mesh.own(v));
    keep_at(given.back());
  }
  find_sinks(graph, given);
  add_up_sinks(graph, progress);
  progress.advance(1);
}

SurfaceFlow::~SurfaceFlow() = default;
SurfaceFlow::SurfaceFlow(SurfaceFlow&&) noexcept = default;

std::span<const Sink> SurfaceFlow::sinks() const {
  return graph_->sinks;
}

SinkId SurfaceFlow::sink_of(VertexId v) const {
  const std::uint32_t sink = graph_->sink[graph_->mesh.own(v).index()];
  return sink == SinkId::kInvalid ? SinkId{} : SinkId{sink};
}

bool SurfaceFlow::is_valley(HalfedgeId given) const {
  const FlowMesh& mesh = graph_->mesh;
  const HalfedgeId h = mesh.own(given), twin = mesh.twin(h);
  if (!twin.valid() || !graph_->drains(h) || !graph_->drains(twin)) return false;
  const bool takes_water = graph_->fall(h) == Fall::Out || graph_->fall(twin) == Fall::Out;
  return takes_water && mesh.height(mesh.origin(h)) != mesh.height(mesh.target(h));
}

bool SurfaceFlow::is_ridge(HalfedgeId given) const {
  const HalfedgeId h = graph_->mesh.own(given), twin = graph_->mesh.twin(h);
  return twin.valid() && graph_->fall(h) == Fall::In && graph_->fall(twin) == Fall::In;
}

std::size_t SurfaceFlow::broken_cycles() const {
  return graph_->broken_cycles;
}

FlowPath SurfaceFlow::path_from(VertexId v) const {
  return Walk(*graph_).from(graph_->mesh.own(v));
}

FlowPath SurfaceFlow::leg_from(VertexId v) const {
  return Walk(*graph_).leg(graph_->mesh.own(v));
}

FlowPath SurfaceFlow::path_from(TriangleId t, Point2 p) const {
  return Walk(*graph_).from(graph_->mesh.own(t), p);
}

}  // namespace thalweg
