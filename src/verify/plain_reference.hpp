#pragma once

/// Vertical distances to reference points, looked up triangle by triangle.

#include "verify/plain_grid.hpp"
#include "verify/plain_mesh.hpp"

#include <span>

namespace thalweg::verify {

/// A point inside a triangle belongs to it, one on a side half to each triangle there; what then is left,
/// points at vertices and the other halves on the rim, no diagonal changes.
class PlainReference {
 public:
  PlainReference(std::span<const Point2> points, std::span<const double> heights);

  /// Sum of squares of vertical distances, units of heights squared. Pre: counter-clockwise.
  [[nodiscard]] long double squares(const PlainMesh& mesh, Index a, Index b, Index c) const;
  /// What is left.
  [[nodiscard]] long double squares_left(const PlainMesh& mesh) const;

 private:
  template <class F>
  void for_points_in(const Box2& box, const F& f) const;

  std::span<const Point2> points_;
  std::span<const double> heights_;
  PlainGrid grid_;
};

}  // namespace thalweg::verify
