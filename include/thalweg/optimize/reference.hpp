#pragma once

/// Heights that a surface is compared with: the cell centres of a DEM, or any points.

#include <thalweg/base/progress.hpp>
#include <thalweg/geometry/point.hpp>
#include <thalweg/mesh/tin.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace thalweg {

/// Reference points, filed for triangles. Units: those of the TIN.
///
/// Law: every point on a TIN, rim included, is counted exactly once: by the one triangle that owns it, or as
/// left on the rim. A triangle owns a point if the point, moved a little to the right and by much less
/// upwards, is inside it: this asks for nothing but the triangle.
class Reference {
 public:
  /// Pre: positions and heights are finite and as many. Complexity: n log n.
  Reference(std::span<const Point2> points, std::span<const double> heights);

  /// Sum of squares of the vertical distances between the plane of a counter-clockwise triangle and the
  /// points that it owns. The result depends neither on ids nor on the order of points; on the first corner
  /// only in its last bits. Complexity: the points in the triangle's box.
  [[nodiscard]] double squares(const std::array<Point2, 3>& at, const std::array<double, 3>& heights) const;

  /// The same sum over the points on the rim of the TIN that no triangle owns; edges within do not change it.
  [[nodiscard]] double squares_left_on_rim(const Tin& tin, const Progress& progress) const;

 private:
  template <class Visit>
  void for_points_in(const Box2& box, const Visit& visit) const;

  Box2 box_;
  double cell_ = 1;
  std::size_t columns_ = 1, rows_ = 1;
  std::vector<std::uint32_t> first_;  ///< by cell, row by row; then the end
  std::vector<Point2> points_;        ///< by cell; in a cell sorted
  std::vector<double> heights_;
};

}  // namespace thalweg
