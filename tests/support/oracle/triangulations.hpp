#pragma once

/// All constrained triangulations of a small scene, and what follows from them by definition: which exist at
/// an order, which edges are useful, which edges are fixed.

#include <support/oracle/orders.hpp>

#include <functional>
#include <map>
#include <span>
#include <vector>

namespace thalweg::oracle {

/// Calls visit once for each constrained triangulation (of the convex hull, or of the ground in polygon mode)
/// with the indices of its triangles in `triangles`, in no promised order.
/// Pre: triangles are all valid ones of the scene; the ground is connected.
/// Complexity: the number of triangulations; about 10^4 for ten sites.
void for_each_triangulation(const Scene& scene, const std::vector<Corners>& triangles,
                            const std::function<void(std::span<const int>)>& visit);

/// Everything that enumeration tells about a scene.
struct Enumeration {
  std::vector<Corners> triangles;         ///< all valid ones, sorted
  std::vector<Orders> orders;             ///< of each triangle
  std::vector<std::vector<int>> members;  ///< each triangulation: sorted indices of its triangles
  std::vector<Orders> largest;            ///< each triangulation: the largest order of its triangles

  /// Triangulations whose triangles all have order <= k: T_k, as sorted indices into `members`.
  [[nodiscard]] std::vector<std::size_t> of_order(Definition definition, int k) const;
  /// The smallest k at which each edge is useful; edges in no triangulation are missing.
  [[nodiscard]] std::map<Edge, int> useful_orders(Definition definition) const;
};
Enumeration enumerate(const Oracle& oracle);

/// The constrained Delaunay triangulation by definition: the triangles of path-connected order 0.
std::vector<Corners> delaunay_triangles(const Oracle& oracle);

/// The greedy triangulation of an edge (section 2 of the paper): the constrained Delaunay triangulation in
/// which what the edge crosses is triangulated anew, each triangle on an edge being the one whose circle is
/// empty beyond. Pre: a sees b and no site lies between them.
std::vector<Corners> greedy_triangles(const Oracle& oracle, Edge edge);

/// Edges of a list of triangles, sorted.
std::vector<Edge> edges_of(const std::vector<Corners>& triangles);

/// A convex quadrilateral with two diagonals, both of which first-order triangulations use.
struct Quadrilateral {
  std::array<int, 4> corners;  ///< counter-clockwise from the smallest index
  Edge delaunay;               ///< the diagonal in the constrained Delaunay triangulation
  auto operator<=>(const Quadrilateral&) const = default;
};
/// Section 6 of the paper: the constrained Delaunay edges that can be exchanged at order 1, sorted.
std::vector<Quadrilateral> first_order_quadrilaterals(const Oracle& oracle, Definition definition);

}  // namespace thalweg::oracle
