#pragma once

/// Volumes between surfaces.

#include <thalweg/base/progress.hpp>
#include <thalweg/mesh/tin.hpp>

namespace thalweg {

/// What one surface has above and below another, in the plane's unit, squared, and its product with the unit
/// of heights; where both are.
struct Volumes {
  double above = 0;  ///< not negative
  double below = 0;  ///< not negative
  double area_above = 0;
  double area_below = 0;
  double area = 0;  ///< where both surfaces are, level parts included
};

/// The TIN against the level plane at `height`. Exact but for rounding: each triangle is cut where it crosses
/// the plane. Throws: Error{Cancelled}. Complexity: linear.
Volumes volume_above(const Tin& tin, double height, const Progress& progress);

/// `tin` against `base`, in the same plane and units. Exact but for rounding: triangles are cut along each
/// other's sides and where they cross. Throws: Error{Cancelled}. Complexity: the pairs of triangles that
/// overlap, and those whose boxes do.
Volumes volume_between(const Tin& tin, const Tin& base, const Progress& progress);

}  // namespace thalweg
