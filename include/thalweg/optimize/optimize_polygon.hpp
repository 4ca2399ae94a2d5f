#pragma once

/// The best triangulation of order at most k of a simple polygon, under any measure that is made up of those
/// of triangles and of neighbours.

#include <thalweg/base/progress.hpp>
#include <thalweg/mesh/tin.hpp>
#include <thalweg/optimize/criterion.hpp>
#include <thalweg/order/definition.hpp>
#include <thalweg/order/order_triangles.hpp>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

namespace thalweg {

/// A decomposable measure, to be minimised: the sum, or the largest, of terms. Each term is rounded once to a
/// multiple of 2^-32, so that sums are exact. Pre: terms are less than 2^31 in magnitude, and depend on
/// nothing but what they are given.
struct PolygonMeasure {
  enum class Combine : std::uint8_t { Sum, Largest };
  Combine combine = Combine::Sum;
  /// Of a triangle, counter-clockwise; empty: none.
  std::function<double(const Triangle&)> of_triangle;
  /// Of two triangles at a diagonal, in either order the same; empty: none, and the work is less.
  std::function<double(const Triangle&, const Triangle&)> of_neighbours;
};

struct PolygonOptimizeOptions {
  OrderDefinition definition = OrderDefinition::SeesOpp;
  std::size_t max_order = 1;
  PolygonMeasure measure;
};

struct PolygonTriangulation {
  std::vector<OrderTriangle> triangles;  ///< sorted
  /// Of the measure; lowest() if that is the largest of no terms.
  double value = 0;
  std::size_t candidates = 0;  ///< triangles of order at most k
};

/// The least value that a triangulation of order at most k has, and one that has it: where several do, that
/// of each part is settled by coordinates, so it does not depend on ids or threads. None if no triangulation
/// has that order (Std only).
///
/// Law (test): of all triangulations of the polygon whose triangles have order at most k, none has less.
/// Pre: `polygon` is the constrained Delaunay triangulation of a simple polygon, as build_ground gives it in
/// mode Polygon. Throws: Error{Unsupported} if it has a hole, a vertex inside, or a rim that meets itself;
/// {SizeLimit} as find_order_triangles; {Cancelled}.
/// Complexity: finding the triangles of order at most k; then, if there are t of them, at most d at each
/// diagonal and v at each vertex, t log v, and with terms of neighbours t (d + log v). Where t is k^2 n, d is
/// k and v is k^2, as where nothing blocks, that is k^2 n log k, the bound of Silveira and van Kreveld
/// (2009), and k^3 n with neighbours.
std::optional<PolygonTriangulation> optimize_polygon(const Tin& polygon,
                                                     const PolygonOptimizeOptions& options,
                                                     Progress& progress);

struct PolygonScale {
  double horizontal_metres_per_unit = 1;
  double vertical_metres_per_unit = 1;
};

/// An objective as a measure of triangulations of the polygon, its sign turned if it is maximised; in the
/// unit of its terms. The TIN must outlive it. Throws: Error{Unsupported} if it is of pits, vertices or a
/// reference, or its parts are measured apart.
PolygonMeasure measure_of(const Tin& polygon, const Objective& objective, const PolygonScale& scale);

}  // namespace thalweg
