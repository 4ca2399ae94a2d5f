#pragma once

/// The flow of a TIN as arrays: what each edge passes on, and where each vertex sends its water. Vertices,
/// triangles and halfedges have the numbers of `mesh`, sinks name vertices of the TIN.

#include "base/large_pages.hpp"
#include "terrain/flats.hpp"
#include "terrain/flow_mesh.hpp"

#include <thalweg/terrain/surface_flow.hpp>

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace thalweg {

/// What water comes to first: a channel, by its number, or a vertex; one number for all.
using FlowNode = std::uint32_t;
constexpr FlowNode kNoNode = std::numeric_limits<FlowNode>::max();

/// The sides next to a side of a triangle, without a jump.
constexpr std::array<unsigned, 3> kNextSide = {1, 2, 0}, kPreviousSide = {2, 0, 1};

/// How a triangle falls across its side.
enum class Fall : std::uint8_t { Level = 0, In = 1, Out = 2, Along = 3 };

/// How a triangle falls, and how flow divides in it: see Strip.
struct TriangleShape {
  std::uint16_t falls : 6 = 0;  ///< over each side, two bits
  std::uint16_t split : 2 = 0;  ///< the side that is split
  std::uint16_t corner_is_low : 1 = 0;
  [[nodiscard]] Fall fall(std::size_t side) const { return static_cast<Fall>(falls >> (2 * side) & 3U); }
  [[nodiscard]] bool level() const { return falls == 0; }
  [[nodiscard]] bool has_along() const { return (falls & falls >> 1U & 0b010101U) != 0; }
};

/// One line of flow through a triangle that is not level: it parts the water that comes in over two sides, or
/// goes out over two.
struct Strip {
  HalfedgeId split;           ///< the side that the line meets; across lies the corner where it ends
  double at = 0.5;            ///< where it meets that side, as share of the halfedge's way
  bool corner_is_low = true;  ///< the corner is where two outflow sides meet (else: two inflow sides)
};

/// Where a triangle is split, and its area.
struct TriangleStrip {
  double at = 0.5;  ///< of its strip; of a level triangle of no meaning
  double area = 0;
};

/// An edge along which water runs.
struct Channel {
  HalfedgeId edge;  ///< the lower of its two
  VertexId low;     ///< the end to which water runs
  bool on_rim = false;
};

struct FlowGraph {
  const Tin& tin;
  FlowMesh mesh;
  Flats flats;
  RawVector<TriangleShape> shape;         ///< by triangle
  RawVector<TriangleStrip> strips;        ///< by triangle
  RawVector<std::uint8_t> inflow_sides;   ///< by triangle: a bit a side over which water comes into it
  RawVector<std::uint8_t> channel_sides;  ///< by triangle: a bit a side; both triangles of an edge agree
  /// By triangle: a bit a side that stands for an edge along which grounds may meet: the rim, ridges, beside
  /// level triangles; not where all water goes on, or both sides drain into a channel.
  RawVector<std::uint8_t> meeting_sides;
  /// By number: those that the falls make, by halfedge, then those that break cycles.
  RawVector<Channel> channels;
  std::vector<TriangleId> obtuse;  ///< those with one In side, if the corner across may not be the lowest
  std::size_t broken_cycles = 0;
  /// By halfedge. Of one that drains into a channel: that. Else, with Fall::In: what water comes to at its
  /// origin; with Fall::Out: what water over it comes to at its triangle's corner if that is low, from the
  /// corner if it is high.
  RawVector<FlowNode> target;
  LargeVector<VertexStep> step;         ///< by vertex
  RawVector<FlowNode> next;             ///< by vertex: what its water comes to first, kNoNode: see sink
  LargeVector<std::uint32_t> sink;      ///< by vertex
  std::vector<HalfedgeId> rim;          ///< halfedges without a twin
  LargeVector<std::uint32_t> rim_sink;  ///< by vertex on the rim: of what leaves there
  std::vector<Sink> sinks;
  RawVector<std::uint32_t> sink_of_node;
  /// Split sides below a high corner whose line meets the ground of a channel at its very border, as where it
  /// comes exactly to a vertex; in no order.
  std::vector<HalfedgeId> touching;
  RawVector<double> ground;  ///< by node: the area of the ground whose water comes to it first

  FlowGraph(const Tin& t, const Progress& progress) : tin(t), mesh(t, progress) {}

  [[nodiscard]] Fall fall(HalfedgeId h) const { return shape[h.index() / 3].fall(h.index() % 3); }
  [[nodiscard]] bool drains(HalfedgeId h) const { return fall(h) >= Fall::Out; }
  [[nodiscard]] bool level(TriangleId t) const { return shape[t.index()].level(); }
  [[nodiscard]] bool is_channel(HalfedgeId h) const {
    return (channel_sides[h.index() / 3] >> (h.index() % 3) & 1U) != 0;
  }
  // Channels that the falls make, vertices, channels that break cycles.
  [[nodiscard]] std::size_t node_count() const { return channels.size() + mesh.vertex_count(); }
  [[nodiscard]] std::size_t first_vertex() const { return channels.size() - broken_cycles; }
  [[nodiscard]] FlowNode node_of(VertexId v) const {
    return static_cast<FlowNode>(first_vertex() + v.index());
  }
  [[nodiscard]] bool is_vertex(FlowNode node) const {
    return node >= first_vertex() && node - first_vertex() < mesh.vertex_count();
  }
  [[nodiscard]] VertexId vertex_of(FlowNode node) const { return VertexId{node - first_vertex()}; }
  [[nodiscard]] const Channel& channel_of(FlowNode node) const {
    return channels[node < first_vertex() ? node : node - mesh.vertex_count()];
  }
  [[nodiscard]] FlowNode node_of_channel(HalfedgeId h) const {
    return target[(drains(h) ? h : mesh.twin(h)).index()];
  }
  /// True if water runs over h out of its triangle into the next one.
  [[nodiscard]] bool hands_on(HalfedgeId h) const { return fall(h) == Fall::Out && !is_channel(h); }
  /// Of two vertices of one edge that to which water runs along it.
  [[nodiscard]] VertexId lower(VertexId a, VertexId b) const;
  [[nodiscard]] VertexId low_end(HalfedgeId h) const { return lower(mesh.origin(h), mesh.target(h)); }
  /// The corner to which water on a level triangle goes.
  [[nodiscard]] VertexId low_corner(TriangleId t) const;
  /// The vertex at the other end of the step's edge. Pre: it is along an edge.
  [[nodiscard]] VertexId neighbour(VertexId v, const VertexStep& s) const {
    const VertexId a = mesh.origin(s.edge);
    return a == v ? mesh.target(s.edge) : a;
  }
  /// How flow divides in a triangle. Pre: it is not level.
  [[nodiscard]] Strip strip_of(TriangleId t) const {
    const TriangleShape at = shape[t.index()];
    return {Tin::halfedge(t, at.split), strips[t.index()].at, at.corner_is_low != 0};
  }
  /// The line of flow through a point of a triangle, as where it would meet `split`'s line.
  [[nodiscard]] double share_of(TriangleId t, const Strip& strip, Point2 p) const;
};

/// The parts of a FlowGraph, in this order.
void find_falls(FlowGraph& graph, const Progress& progress);
void find_channels(FlowGraph& graph, const Progress& progress);
void break_cycles(FlowGraph& graph, const Progress& progress);
void sweep_grounds(FlowGraph& graph, const Progress& progress);
void find_steps(FlowGraph& graph, const Progress& progress);
void find_sinks(FlowGraph& graph, std::span<const VertexId> outlets);
void add_up_sinks(FlowGraph& graph, const Progress& progress);

}  // namespace thalweg
