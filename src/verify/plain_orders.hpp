#pragma once

/// The constrained order of one triangle, counted point by point from the definitions.
///
/// Source: Silveira, van Kreveld, Towards a Definition of Higher Order Constrained Delaunay Triangulations,
/// section 2, with the sight and tie rules of the README.

#include "verify/plain_flood.hpp"
#include "verify/plain_grid.hpp"
#include "verify/plain_mesh.hpp"

#include <thalweg/order/definition.hpp>

#include <cstddef>
#include <optional>
#include <vector>

namespace thalweg::verify {

class PlainOrders {
 public:
  /// `polygon`: constraint edges of kinds boundary and hole bound the ground, and sights stay inside it; so
  /// do the edges of the convex hull, where holes alone are drawn. Pre: the mesh is sound and outlives this
  /// object.
  PlainOrders(const PlainMesh& mesh, OrderDefinition definition, bool polygon);

  /// False under pathcon if the mesh does not cover the ground on which paths go; then nothing can be asked.
  [[nodiscard]] bool known() const { return !flood_ || flood_->covers_ground(); }
  /// Whether at most k vertices count for the counter-clockwise triangle. Pre: it is valid.
  [[nodiscard]] bool at_most(const Corners& t, std::size_t k) const;
  /// The number of vertices that count, but no more than `most`.
  [[nodiscard]] std::size_t count(const Corners& t, std::size_t most) const;

  /// Whether two vertices see each other.
  [[nodiscard]] bool sees(Index p, Index q) const;

 private:
  [[nodiscard]] bool counts(const Corners& t, Index p) const;
  [[nodiscard]] bool sees_side(Index p, Index u, Index v) const;
  [[nodiscard]] bool in_conflict(const Corners& t, Index p, Index u, Index v) const;
  [[nodiscard]] bool triangle_is_empty(Index u, Index v, Index p) const;
  [[nodiscard]] bool looks_inside(Index p, Index q) const;
  template <class F>
  void for_points_inside(const Corners& t, const F& f) const;

  const PlainMesh& mesh_;
  OrderDefinition definition_;
  bool polygon_;
  std::optional<PlainFlood> flood_;  ///< pathcon
  PlainGrid points_;
  PlainGrid edges_;
  std::vector<std::pair<Index, Index>> constraints_;  ///< and what else hides
  std::vector<std::vector<Index>> fans_;              ///< polygon: the triangles at each vertex
};

}  // namespace thalweg::verify
