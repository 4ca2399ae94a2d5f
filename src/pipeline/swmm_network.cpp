// Reaches as links.
//
// 1. Each reach is a link from its upper vertex to the vertex where its water comes next. A way across
//    triangles that meets a channel between its ends goes on to the channel's lower end; if nothing else
//    comes to that channel's upper end, the channel is no link of its own.
//    Nor does what comes to a channel's upper end always go along it: then the channel begins at a node of
//    its own.
// 2. Pits at which links end spill along a link of their own; over the rim, to an outfall of its own.
// 3. Vertices with one link in and one out are inside of a conduit, all others are nodes.
#include "pipeline/swmm_network.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

namespace thalweg {

namespace {

constexpr std::uint32_t kNone = 0xffffffffU;

struct Link {
  VertexId from,
      to;  // `to` is invalid where water leaves over the rim between vertices, or a pit spills there
  std::vector<FlowPoint> points;
  HalfedgeId channel;   // invalid: across triangles, or over a spill
  double offset_m = 0;  // of the beginning above its node
  bool spill = false;
  bool own = true;  // what comes to `from` goes on here; else only ground beside the channel drains to it
};

class Tracer {
 public:
  Tracer(const LoadedTin& loaded, const SwmmView& view)
      : loaded_(loaded),
        tin_(loaded.tin),
        view_(view),
        metres_(loaded.plane.metres_per_unit()),
        vertical_metres_(loaded.plane.vertical_metres_per_unit()),
        out_(tin_.vertex_count(), kNone),
        in_(tin_.vertex_count(), 0),
        node_of_(tin_.vertex_count(), kNone),
        on_rim_(tin_.rim_vertices()) {}

  SwmmNetwork run() {
    list_links();
    list_spills();
    for (std::uint32_t i = 0; i < links_.size(); ++i) {
      if (!links_[i].own || is_node(links_[i].from)) add_conduit(i);
    }
    return std::move(network_);
  }

 private:
  [[nodiscard]] FlowPoint point_of(VertexId v) const {
    return {.xy = tin_.point(v), .z = tin_.height(v), .along = 0, .edge = {}, .vertex = v};
  }
  [[nodiscard]] HalfedgeId representative(HalfedgeId h) const {
    const HalfedgeId twin = tin_.twin(h);
    return twin.valid() ? std::min(h, twin) : h;
  }
  /// The plateau of a pit is one node.
  [[nodiscard]] VertexId settled(VertexId v) const {
    const Sink& sink = view_.flow.sinks()[view_.flow.sink_of(v).index()];
    const bool pit = sink.kind == Sink::Kind::Pit || sink.kind == Sink::Kind::Lake;
    return pit && out_[v.index()] == kNone && tin_.height(v) == tin_.height(sink.vertex) ? sink.vertex : v;
  }

  /// Where the water of a way across triangles comes next; invalid: it leaves.
  [[nodiscard]] VertexId end_of(const Reach& reach) const {
    const FlowPoint& last = reach.points.back();
    if (last.vertex.valid()) return last.vertex;
    if (!tin_.twin(last.edge).valid()) return {};
    const VertexId a = tin_.origin(last.edge), b = tin_.target(last.edge);
    if (tin_.height(a) != tin_.height(b)) return tin_.height(a) < tin_.height(b) ? a : b;
    return view_.flow.path_from(reach.points.front().vertex).points[reach.points.size()].vertex;
  }

  /// Whether water from a vertex first runs along the edge to `next`.
  [[nodiscard]] bool goes_along(VertexId v, VertexId next) const {
    const FlowPath leg = view_.flow.leg_from(v);
    return leg.points.size() > 1 && leg.points[1].vertex == next;
  }

  void list_links() {
    std::set<HalfedgeId> entered;  // channels between whose ends a way across triangles comes
    std::vector<std::uint8_t> reached(tin_.vertex_count(), 0);
    for (const Reach& reach : view_.network) {
      const bool across = !reach.channel.valid();
      Link link{reach.points.front().vertex, across ? end_of(reach) : reach.points.back().vertex,
                reach.points, reach.channel};
      if (across && !reach.points.back().vertex.valid()) {
        entered.insert(representative(reach.points.back().edge));
        if (link.to.valid()) link.points.push_back(point_of(link.to));
      }
      if (link.to.valid()) reached[link.to.index()] = 1;
      links_.push_back(std::move(link));
    }
    for (std::size_t s = 0; s < view_.flow.sinks().size(); ++s) {
      if (view_.spilling.overflow[s].valid()) reached[view_.spilling.overflow[s].index()] = 1;
    }
    for (Link& link : links_) link.own = !link.channel.valid() || goes_along(link.from, link.to);
    std::erase_if(links_, [&](const Link& link) {
      return link.channel.valid() && (!link.own || reached[link.from.index()] == 0) &&
             entered.contains(representative(link.channel));
    });
    for (std::uint32_t i = 0; i < links_.size(); ++i) {
      if (links_[i].own) out_[links_[i].from.index()] = i;
    }
    for (Link& link : links_) {
      if (!link.to.valid()) continue;
      link.to = settled(link.to);
      ++in_[link.to.index()];
    }
  }

  /// From pits at which links end to where their water goes on.
  void list_spills() {
    pit_at_.assign(tin_.vertex_count(), kNone);
    for (std::uint32_t p = 0; p < view_.table.pits.size(); ++p) {
      const Pit& pit = view_.table.pits[p];
      if (in_[pit.vertex.index()] == 0) continue;
      pit_at_[pit.vertex.index()] = p;
      const VertexId overflow = view_.spilling.overflow[pit.sink.index()];
      if (!overflow.valid()) continue;
      const bool leaves = on_rim_[overflow.index()];
      Link link{pit.vertex,
                leaves ? VertexId{} : settled(overflow),
                {point_of(pit.vertex), point_of(pit.spill_vertex)},
                {}};
      if (overflow != pit.spill_vertex) link.points.push_back(point_of(overflow));
      link.offset_m = (pit.spill_height - pit.height) * vertical_metres_;
      link.spill = true;
      if (!leaves) ++in_[link.to.index()];
      out_[pit.vertex.index()] = static_cast<std::uint32_t>(links_.size());
      links_.push_back(std::move(link));
    }
  }

  [[nodiscard]] bool is_node(VertexId v) const {
    const std::uint32_t out = out_[v.index()];
    return in_[v.index()] != 1 || out == kNone || links_[out].spill || pit_at_[v.index()] != kNone;
  }

  std::uint32_t node_at(VertexId v) {
    const bool pit = pit_at_[v.index()] != kNone;
    const bool outfall = !pit && out_[v.index()] == kNone;
    std::uint32_t& known = node_of_[v.index()];
    if (known != kNone && !outfall) return known;
    const auto node = static_cast<std::uint32_t>(network_.nodes.size());
    const bool more = known != kNone;
    if (!more) known = node;
    SwmmNode made{.at = point_of(v)};
    if (pit) made.pit = pit_at_[v.index()];
    made.kind = pit ? SwmmNode::Kind::Storage : outfall ? SwmmNode::Kind::Outfall : SwmmNode::Kind::Junction;
    made.name = fmt::format("{}{}", pit ? "P" : outfall ? "O" : "J", v.value());
    if (more) made.name += fmt::format("_{}", node);
    network_.nodes.push_back(std::move(made));
    return node;
  }

  /// The upper end of a channel that its vertex does not feed.
  std::size_t add_head(const Link& link) {
    const bool forward = tin_.origin(link.channel) == link.from;
    FlowPoint at = link.points.front();
    at.vertex = {};
    at.edge = link.channel;
    at.along = forward ? 0 : 1;
    network_.nodes.push_back(
        {.kind = SwmmNode::Kind::Junction, .name = fmt::format("H{}", link.channel.value()), .at = at});
    return network_.nodes.size() - 1;
  }

  void add_conduit(std::uint32_t first) {
    SwmmConduit conduit{.offset_m = links_[first].offset_m};
    conduit.from = links_[first].own ? node_at(links_[first].from) : add_head(links_[first]);
    for (std::uint32_t i = first;;) {
      const Link& link = links_[i];
      append(conduit, link);
      if (!link.to.valid()) {
        conduit.to = static_cast<std::uint32_t>(network_.nodes.size());
        network_.nodes.push_back({.kind = SwmmNode::Kind::Outfall,
                                  .name = fmt::format("R{}", link.from.value()),
                                  .at = link.points.back()});
        break;
      }
      if (is_node(link.to)) {
        conduit.to = node_at(link.to);
        break;
      }
      i = out_[link.to.index()];
    }
    network_.nodes[conduit.to].conduits_m += conduit.length_m;
    network_.conduits.push_back(std::move(conduit));
  }

  void append(SwmmConduit& conduit, const Link& link) {
    double length = 0;
    for (std::size_t i = 1; i < link.points.size(); ++i) {
      const Point2 a = link.points[i - 1].xy, b = link.points[i].xy;
      length += std::hypot(b.x - a.x, b.y - a.y) * metres_;
    }
    conduit.length_m += length;
    conduit.points.insert(conduit.points.end(), link.points.begin() + (conduit.points.empty() ? 0 : 1),
                          link.points.end());
    if (!link.channel.valid() || !tin_.twin(link.channel).valid()) return;
    const bool along = tin_.origin(link.channel) == link.from;
    const double here = rise_from(link.channel), there = rise_from(tin_.twin(link.channel));
    conduit.left += length * (along ? here : there);
    conduit.right += length * (along ? there : here);
    conduit.sides_m += length;
  }

  /// The slope of the triangle to the left of h, away from h.
  [[nodiscard]] double rise_from(HalfedgeId h) const {
    const Point2 a = tin_.point(tin_.origin(h)), b = tin_.point(tin_.target(h)), c = tin_.point(tin_.apex(h));
    const double za = tin_.height(tin_.origin(h)), zb = tin_.height(tin_.target(h));
    const double length = std::hypot(b.x - a.x, b.y - a.y);
    const double ux = (b.x - a.x) / length, uy = (b.y - a.y) / length;
    const double along = (c.x - a.x) * ux + (c.y - a.y) * uy, across = (c.y - a.y) * ux - (c.x - a.x) * uy;
    const double foot = za + (zb - za) * along / length;
    return (tin_.height(tin_.apex(h)) - foot) * vertical_metres_ / (across * metres_);
  }

  const LoadedTin& loaded_;
  const Tin& tin_;
  const SwmmView& view_;
  double metres_, vertical_metres_;
  std::vector<Link> links_;
  std::vector<std::uint32_t> out_;     // by vertex: its link
  std::vector<std::uint32_t> in_;      // by vertex: how many links end there
  std::vector<std::uint32_t> pit_at_;  // by vertex: the pit of which it is the node
  std::vector<std::uint32_t> node_of_;
  std::vector<bool> on_rim_;  // by vertex: what spills there leaves
  SwmmNetwork network_;
};

}  // namespace

SwmmNetwork find_swmm_network(const LoadedTin& loaded, const SwmmView& view) {
  return Tracer(loaded, view).run();
}

}  // namespace thalweg
