#pragma once

/// The flow of a TIN as arrays: what each edge passes on, and where each vertex sends its water.

#include "terrain/flats.hpp"

#include <thalweg/terrain/surface_flow.hpp>

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace thalweg {

/// How a triangle falls across its side.
enum class Fall : std::int8_t { Level = 0, In = 1, Out = 2, Along = 3 };

/// What water comes to first: a channel (its edge's lower halfedge), a vertex, or a sink; one number for all.
using FlowNode = std::uint32_t;
constexpr FlowNode kNoNode = std::numeric_limits<FlowNode>::max();

/// A part of an edge all of whose water comes to one channel or vertex.
struct FlowPiece {
  double end = 1;  ///< share of the halfedge's way, from its origin
  FlowNode node = kNoNode;
  /// Where the line that ends the piece comes from, downhill: a piece of the edge below (its index), or
  /// kFromCorner: the corner across.
  std::uint32_t from = kFromCorner;
  static constexpr std::uint32_t kFromCorner = std::numeric_limits<std::uint32_t>::max();
};

/// One line of flow through a triangle that is not level, and what lies on both sides of it. Water enters
/// over `in_left` and `in_right` (seen downhill) or over one side only, and leaves likewise.
struct Strip {
  HalfedgeId split;           ///< the side that the line meets; across lies the corner where it ends
  double at = 0.5;            ///< where it meets that side, as share of the halfedge's way
  bool corner_is_low = true;  ///< the corner is where two outflow sides meet (else: two inflow sides)
};

enum class Step : std::uint8_t {
  Stay,   ///< a pit or a given outlet, or in no triangle
  Leave,  ///< over the rim, at the vertex itself
  Edge,   ///< along an edge to a neighbour
  Cross   ///< across a triangle
};

struct VertexStep {
  Step kind = Step::Stay;
  HalfedgeId across;   ///< Cross: the side opposite of the vertex
  double at = 0;       ///< where it is met
  VertexId neighbour;  ///< Edge
};

struct FlowGraph {
  const Tin& tin;
  Flats flats;
  std::vector<Fall> fall;             ///< by halfedge
  std::vector<std::uint8_t> channel;  ///< by halfedge; both sides agree
  std::size_t broken_cycles = 0;
  /// Pieces of each halfedge with Fall::In. `pieces_count` 0: one piece, whose node is `pieces_first`.
  std::vector<std::uint32_t> pieces_first;
  std::vector<std::uint32_t> pieces_count;
  std::vector<FlowPiece> pieces;
  std::vector<VertexStep> step;         ///< by vertex
  std::vector<FlowNode> next;           ///< by vertex: what its water comes to first, kNoNode: see sink
  std::vector<std::uint32_t> sink;      ///< by vertex
  std::vector<std::uint32_t> rim_sink;  ///< by vertex on the rim: of what leaves there
  std::vector<Sink> sinks;
  /// By node: the area of the ground whose water comes to that channel or vertex first.
  std::vector<double> ground;

  explicit FlowGraph(const Tin& t) : tin(t) {}

  [[nodiscard]] bool drains(HalfedgeId h) const {
    return fall[h.index()] == Fall::Out || fall[h.index()] == Fall::Along;
  }
  [[nodiscard]] bool level(TriangleId t) const { return fall[3 * t.index()] == Fall::Level; }
  [[nodiscard]] FlowNode node_of(VertexId v) const {
    return static_cast<FlowNode>(tin.halfedge_count() + v.index());
  }
  [[nodiscard]] FlowNode node_of_channel(HalfedgeId h) const {
    const HalfedgeId twin = tin.twin(h);
    return twin.valid() && twin < h ? twin.value() : h.value();
  }
  [[nodiscard]] bool is_vertex(FlowNode node) const { return node >= tin.halfedge_count(); }
  [[nodiscard]] VertexId vertex_of(FlowNode node) const { return VertexId{node - tin.halfedge_count()}; }
  /// Of two vertices of one edge that to which water runs along it.
  [[nodiscard]] VertexId lower(VertexId a, VertexId b) const;
  [[nodiscard]] VertexId low_end(HalfedgeId h) const { return lower(tin.origin(h), tin.target(h)); }
  /// The corner to which water on a level triangle goes.
  [[nodiscard]] VertexId low_corner(TriangleId t) const;
  [[nodiscard]] std::uint32_t sink_of_node(FlowNode node) const;
  /// How flow divides in a triangle. Pre: it is not level.
  [[nodiscard]] Strip strip_of(TriangleId t) const;
  /// The line of flow through a point of a triangle, as where it would meet `split`'s line.
  [[nodiscard]] double share_of(TriangleId t, const Strip& strip, Point2 p) const;
  /// The pieces of what runs over h out of its triangle, along h's twin; a channel is one piece.
  /// Pre: drains(h). `single` is filled where a span of one is needed.
  [[nodiscard]] std::span<const FlowPiece> passed_on(HalfedgeId h, FlowPiece& single) const;
  /// The same for a halfedge with Fall::In, along h.
  [[nodiscard]] std::span<const FlowPiece> taken_in(HalfedgeId h, FlowPiece& single) const;
  /// What water comes to that runs over h at the share `at` of its way. Pre: drains(h).
  [[nodiscard]] FlowNode node_beyond(HalfedgeId h, double at) const;
};

/// The parts of a FlowGraph, in this order.
void find_falls(FlowGraph& graph, const Progress& progress);
void find_pieces(FlowGraph& graph, Progress& progress);
void find_steps(FlowGraph& graph, std::span<const VertexId> outlets, const Progress& progress);
void find_sinks(FlowGraph& graph, std::span<const VertexId> outlets);
void measure_grounds(FlowGraph& graph);

}  // namespace thalweg
