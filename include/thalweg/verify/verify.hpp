#pragma once

/// A TIN is checked again by slow and plain code that shares nothing with what made it.
///
/// The module has its own exact arithmetic, mesh, grid, counting of orders, flips, formulas and solver. It
/// shares with the rest only plain values: points, kinds of edges, names of definitions.

#include <thalweg/base/progress.hpp>
#include <thalweg/geometry/point.hpp>
#include <thalweg/mesh/tin.hpp>
#include <thalweg/order/definition.hpp>
#include <thalweg/verify/proof.hpp>

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace thalweg::verify {

/// What a report says of one criterion.
struct CriterionClaim {
  std::string name;
  double delaunay = 0;
  double result = 0;
  double bound = 0;
  bool optimal = false;
};

struct PitsClaim {
  std::size_t interior = 0;
  std::size_t boundary = 0;
  std::size_t lake = 0;
};

/// What a report says of a TIN; what it does not say is not checked.
struct Claims {
  std::optional<std::string> digest;
  std::optional<std::size_t> vertices, triangles, edges, constraint_edges;
  std::optional<std::size_t> quadrilaterals, flipped;
  /// First-order quadrilaterals that were kept out for the sake of source points; not in `quadrilaterals`.
  std::size_t barred = 0;
  std::vector<std::uint16_t> orders;  ///< of the triangles; empty: nothing is said
  std::optional<std::size_t> max_order;
  std::vector<std::size_t> order_histogram;  ///< triangles of order 0, 1, ...; empty: nothing is said
  std::vector<CriterionClaim> criteria;
  std::optional<PitsClaim> pits_delaunay, pits_result;
  std::optional<Proof> proof;  ///< of the criteria's bounds
};

/// A TIN as its file holds it, in the plane in which it was made.
struct Subject {
  std::span<const Point2> points;   ///< in the plane of triangulation
  std::span<const Point2> written;  ///< as the file has them; empty: the plane's own
  /// Geographic input: the written coordinates without a jump at the antimeridian, in which the mesh must be
  /// valid, too.
  std::span<const Point2> continuous;
  std::span<const double> heights;
  std::span<const Triangle> triangles;
  std::span<const ConstraintEdge> constraints;
  /// What vertical-error is measured against, in the plane and the unit of heights; empty: it is not checked.
  std::span<const Point2> reference_points;
  std::span<const double> reference_heights;
  double horizontal_metres_per_unit = 1;
  double vertical_metres_per_unit = 1;
  OrderDefinition definition = OrderDefinition::SeesOpp;
  unsigned order = 1;
};

enum class Verdict : std::uint8_t {
  Holds,
  Broken,
  NotChecked  ///< never counts as holding
};

/// One line of the table.
struct Finding {
  std::string claim;
  Verdict verdict = Verdict::NotChecked;
  std::string detail;  ///< where it fails, what was found, or why it was not checked
};

/// Checks everything that follows from the TIN and the claims. If the mesh is no triangulation of its
/// points, what builds on that is not checked. Throws: Error{Cancelled}.
std::vector<Finding> check(const Subject& subject, const Claims& claims, Progress& progress);

}  // namespace thalweg::verify
