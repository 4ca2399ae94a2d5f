#pragma once

/// How water runs on a TIN: down the steepest line of each triangle, and along valley edges.
///
/// The model. On a triangle that is not level water runs in a straight line against the gradient. At an edge
/// it goes on into the next triangle if that one falls away from the edge. If it does not (both triangles
/// drain into the edge: a valley edge; or the other is level, or there is none), the edge is a *channel*:
/// water runs along it to its lower end. From a vertex it takes the steepest way: across a triangle or along
/// an edge. Plateaus: from a vertex without a lower neighbour along level edges to the nearest that has one,
/// by number of edges, then (x, y); water on a level triangle goes to its corner that is nearest so. It ends
/// in a pit (all of its plateau is one), at a given outlet, or where it leaves over the rim. What leaves is
/// counted for the outlet to which the rim falls from there.
///
/// Exact: whether a triangle drains over a side (fall_across), so what is a valley edge, a ridge edge, a
/// channel; plateaus and their ranks; which outlet or pit follows upon which. Rounded, to some 1e-16 of an
/// edge: where a line of flow meets an edge, so which side of a divide a point nearer to it than that is on;
/// and slopes, where a vertex has several ways down that are equally steep to the last digit.
///
/// Laws: (1) A path ends: edges are crossed in an order without cycles (an edge that would close one is made
/// a channel; `broken_cycles` counts them; no terrain seen so far has any), so every path comes to a vertex
/// or leaves; and from a vertex it comes to a lower one, or to one of its own plateau with a smaller rank. So
/// no path loops. (2) Every vertex has exactly one sink. (3) The areas of all sinks sum to the area of the
/// TIN.

#include <thalweg/base/progress.hpp>
#include <thalweg/mesh/tin.hpp>
#include <thalweg/terrain/pits.hpp>

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace thalweg {

using SinkId = Id<struct SinkTag>;

/// Where water ends.
struct Sink {
  enum class Kind : std::uint8_t {
    Pit,     ///< an interior pit
    Lake,    ///< a pit that holds an edge of kind Lake
    Outlet,  ///< where the rim is lowest
    Given    ///< an outlet or a station that the caller named
  };
  Kind kind = Kind::Pit;
  VertexId vertex;             ///< of a plateau: its first vertex by (x, y)
  std::uint32_t vertices = 1;  ///< of the plateau
  double area = 0;             ///< of all that drains here, in square units of the plane
};

/// A point of a path.
struct FlowPoint {
  Point2 xy;
  double z = 0;
  double along = 0;  ///< the point lies at this share of the way from origin to target ...
  HalfedgeId edge;   ///< ... of this edge (invalid: on none) ...
  VertexId vertex;   ///< ... or is this vertex
};

struct FlowPath {
  std::vector<FlowPoint> points;  ///< the first one has neither edge nor vertex, unless it started there
  SinkId sink;
};

struct FlowGraph;

class SurfaceFlow {
 public:
  /// The TIN must outlive this. `outlets`: water that reaches one of these vertices leaves.
  /// Pre: the TIN is valid, heights are finite. Throws: Error{SizeLimit} from 2^29 vertices on;
  /// Error{Cancelled}. Complexity: linear, plus one step for each crossing of an edge by a line that divides
  /// the grounds of two channels; on all threads. The answers do not depend on their number.
  SurfaceFlow(const Tin& tin, std::span<const VertexId> outlets, Progress& progress);
  /// The same water, which ends at `stations` too: they draw none to them on plateaus. Those in pits, and
  /// outlets, stay what they are.
  SurfaceFlow(const Tin& tin, std::span<const VertexId> outlets, std::span<const VertexId> stations,
              Progress& progress);
  ~SurfaceFlow();
  SurfaceFlow(SurfaceFlow&&) noexcept;
  SurfaceFlow& operator=(SurfaceFlow&&) = delete;
  SurfaceFlow(const SurfaceFlow&) = delete;
  SurfaceFlow& operator=(const SurfaceFlow&) = delete;

  [[nodiscard]] std::span<const Sink> sinks() const;
  /// Where water ends that starts at v. Invalid for vertices in no triangle.
  [[nodiscard]] SinkId sink_of(VertexId v) const;
  /// True if both triangles of the interior edge drain into it, at least one of them not just along it, and
  /// it is not level: a valley edge of the surface.
  [[nodiscard]] bool is_valley(HalfedgeId h) const;
  /// True if both triangles of the interior edge fall away from it: a ridge edge of the surface.
  [[nodiscard]] bool is_ridge(HalfedgeId h) const;
  [[nodiscard]] std::size_t broken_cycles() const;
  /// The path of water from a vertex, or from a point of a triangle. Complexity: linear in its length.
  [[nodiscard]] FlowPath path_from(VertexId v) const;
  [[nodiscard]] FlowPath path_from(TriangleId t, Point2 p) const;
  /// The beginning of a vertex's path: until it meets a channel or another vertex. Its sink is not filled.
  [[nodiscard]] FlowPath leg_from(VertexId v) const;

  /// For the other parts of the module.
  [[nodiscard]] const FlowGraph& graph() const { return *graph_; }

 private:
  std::unique_ptr<FlowGraph> graph_;
};

}  // namespace thalweg
