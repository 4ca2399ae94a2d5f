#pragma once

/// Constrained orders of triangles, and sight, over a constrained Delaunay triangulation.

#include <thalweg/mesh/ground_mode.hpp>
#include <thalweg/mesh/tin.hpp>
#include <thalweg/order/definition.hpp>

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

namespace thalweg {

/// Why three vertices form no triangle of any triangulation; the first that applies.
enum class TriangleFault : std::uint8_t {
  None,      ///< it is a valid triangle
  Flat,      ///< the corners are collinear or repeated
  Occupied,  ///< another vertex lies in the closed triangle
  Crossed,   ///< a constraint edge runs through it
  Outside    ///< it lies off the ground (mode Polygon, or a corner that is in no triangle)
};

struct TriangleValidity {
  TriangleFault fault = TriangleFault::None;
  VertexId by;     ///< Occupied: the lowest such vertex; Crossed: the lower end of the first such edge
  VertexId other;  ///< Crossed: the higher end of that edge
};

/// Scratch memory of queries: one a thread, reused from query to query.
class OrderWorkspace {
 public:
  OrderWorkspace();
  ~OrderWorkspace();
  OrderWorkspace(OrderWorkspace&&) noexcept;
  OrderWorkspace& operator=(OrderWorkspace&&) noexcept;

 private:
  friend class ConstrainedOrder;
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// Answers queries about orders over one ground.
///
/// Laws (tests): (1) of the same triangle, std >= pathcon >= sees-triang >= sees-vtx >= sees-opp >= sees-3vtx
/// >= empty-quad and sees-triang >= conf-edge >= sees-opp (Lemma 1); (2) triangles of the ground have order 0
/// under all but Std (Property 1); (3) without constraint edges all but EmptyQuad are equal (Property 2); (4)
/// at most 1 under SeesVtx exactly if under SeesTriang, under SeesOpp exactly if under ConfEdge (Lemmas 5 and
/// 6). Exact for any input: the disc is never perturbed, a vertex on its rim belongs to it by the rule of
/// in_circle_perturbed.
/// Not laws, against the paper's Observation 1 and Lemma 2: Property 4 fails for ConfEdge as for Pathcon;
/// Sees3vtx and EmptyQuad are equal in simple polygons only (scenes property-4-conf-edge, lemma-2-hole).
/// Thread-safe: queries only read the ground; each thread brings its own workspace. The ground must outlive
/// this.
///
/// Cost, with f the faces of the ground that meet the disc (under Pathcon, ConfEdge and SeesOpp: as far as no
/// constraint edge parts them from the triangle), q the vertices that Pathcon counts, m the constraint edges
/// met, n = q + m; in brackets the paper's bound (Table 1). Most discs of low order meet ten to twenty faces:
/// a flood, and a short walk for each line of sight. Where they meet more:
/// Std, Pathcon [n log n]: O(f); Std over a polygon: the vertices in the disc's box.
/// SeesOpp, Sees3vtx, EmptyQuad [n log n]: what each corner sees through the side across, a face for each two
/// neighbours in sight; past 4096 faces O(f + n log n).
/// SeesVtx [n log n]: with a limit up to 64 what all corners see, in the same way, and a look at the side for
/// each vertex that only its ends see; else as SeesTriang, of those that see a corner.
/// SeesTriang [n^2]: the light from each side, a face for each way along which it comes; past 4096 faces (and
/// 16 f, without a limit) O(f + n log n), and O(n log n) at most for each vertex that sees a corner only past
/// an edge that ends there, or none: no less is known to tell if it sees a side.
/// ConfEdge [n^2]: with a limit the light from the two shorter sides, and what each vertex there, up to 64 a
/// side, sees through the longest; else O(f + n log n), and O(n log n) at most for each vertex that does not
/// see its opposite corner. Limits of 0 and 1 cost SeesTriang what SeesVtx, and ConfEdge what SeesOpp costs.
/// Up to 256 vertices pairs are tested instead of angular sweeps: O(f) and a walk along each line of sight.
/// Over a simple polygon without vertices inside, with more than 256 in the disc (Table 2 in brackets):
/// Pathcon, SeesOpp, Sees3vtx, EmptyQuad [n]: O(f), each face entered once by each view; SeesVtx, SeesTriang
/// [n]: the same, and O(n log n) at most to cut what a side sees; ConfEdge [n log n]: O(n log n), one sweep
/// over the directions in which each side is crossed. Measured on combs, spirals and tunnels of up to 300,000
/// corners: tests/bench/order/sweeps.md.
class ConstrainedOrder {
 public:
  /// Pre: `ground` is a triangulation of all its vertices and constraint edges; it covers the convex hull in
  /// mode Hull. Complexity: linear.
  explicit ConstrainedOrder(const Tin& ground, GroundMode mode = GroundMode::Hull);
  ~ConstrainedOrder();
  ConstrainedOrder(ConstrainedOrder&&) noexcept;
  ConstrainedOrder& operator=(ConstrainedOrder&&) noexcept;

  [[nodiscard]] const Tin& ground() const;
  [[nodiscard]] GroundMode mode() const;
  /// True if nothing blocks: no constraint edge and no polygon's rim. Then all definitions but EmptyQuad
  /// agree.
  [[nodiscard]] bool unconstrained() const;

  /// Whether the three vertices form a triangle that a triangulation may hold. Any order and orientation.
  /// Pre: ids in range. Complexity: the faces of the ground that it overlaps.
  [[nodiscard]] TriangleValidity validity(const Triangle& triangle, OrderWorkspace& workspace) const;
  /// The same as a yes or no; stops at the first fault.
  [[nodiscard]] bool is_valid(const Triangle& triangle, OrderWorkspace& workspace) const;

  /// The order of a triangle. Pre: it is valid; any orientation.
  [[nodiscard]] std::size_t order(const Triangle& triangle, OrderDefinition definition,
                                  OrderWorkspace& workspace) const;
  /// Whether its order is at most k; stops as soon as more than k vertices are certain. Pre: as `order`.
  [[nodiscard]] bool at_most(const Triangle& triangle, OrderDefinition definition, std::size_t k,
                             OrderWorkspace& workspace) const;
  /// Its order if that is at most k. Pre: as `order`.
  [[nodiscard]] std::optional<std::size_t> order_up_to(const Triangle& triangle, OrderDefinition definition,
                                                       std::size_t k, OrderWorkspace& workspace) const;
  /// The vertices that are counted, ascending. Pre: as `order`.
  [[nodiscard]] std::vector<VertexId> counted(const Triangle& triangle, OrderDefinition definition,
                                              OrderWorkspace& workspace) const;

  /// Whether p sees q: pq is a constraint edge, or the open segment meets no constraint edge, ends included,
  /// save that an edge which ends in p or q may touch it there; in mode Polygon it must also stay on the
  /// ground. Complexity: the faces that the segment crosses, and the degrees of the vertices that it passes
  /// through.
  [[nodiscard]] bool sees(VertexId p, VertexId q) const;

 private:
  struct Parts;
  void count(const Triangle& triangle, OrderDefinition definition, std::size_t limit,
             OrderWorkspace& workspace) const;
  struct Limits {
    std::size_t counted, faces;
  };
  bool count_by_flood(const Triangle& corners, TriangleId start, OrderDefinition definition,
                      const Limits& limits, OrderWorkspace& workspace) const;
  [[nodiscard]] bool views_help(OrderDefinition definition, std::size_t limit) const;
  bool count_by_views(const Triangle& corners, OrderDefinition definition, std::size_t limit,
                      OrderWorkspace& workspace) const;
  bool count_by_sides(const Triangle& corners, OrderDefinition definition, const Limits& limits,
                      OrderWorkspace& workspace) const;
  void count_in_box(const Triangle& corners, std::size_t limit, std::vector<VertexId>& counted) const;

  std::unique_ptr<Parts> parts_;
};

}  // namespace thalweg
