#pragma once

/// What can be optimised over the first-order triangulations of a TIN.

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace thalweg {

/// What each one measures, precisely, is said where it is declared: src/optimize/criterion.cpp.
enum class Criterion : std::uint8_t {
  LocalMinima,
  NormalAngleSum,
  NormalAngleSquares,
  EdgeLength,
  AreaRatioSum,
  ConvexEdges,
  FlatTriangles,
  NormalAngleMax,
  AreaRatioMax,
  MaxArea,
  MaxAngle,
  MinAngle,
  VerticalError,
  ConvexVertices,
  MixedVertices,
  MaxDegree,
  PitDepth,
  ValleyTriangles,
  DrainingValleys
};

/// What one term of a criterion depends on.
enum class Coupling : std::uint8_t {
  OneTriangle,  ///< a triangle
  Edge,         ///< the two triangles at an interior edge, so at most two quadrilaterals
  VertexStar,   ///< the triangles at a vertex, so all quadrilaterals that have it as a corner
  Plateau       ///< all edges that leave a connected set of vertices that are not higher than some height
};

/// How terms become the value.
enum class Combination : std::uint8_t { Sum, Count, Max, Min };

enum class Direction : std::uint8_t { Minimise, Maximise };

/// All that is known of a criterion but its term.
struct CriterionTraits {
  Criterion criterion;
  std::string_view name;  ///< as on the command line and in the report
  std::string_view unit;
  Direction direction;
  Coupling coupling;
  Combination combination;
  double term_unit = 1;  ///< terms are in so many units: more than 1 where values are large
};

/// Every criterion, in the order of the enumeration.
std::span<const CriterionTraits> all_criteria();
const CriterionTraits& traits_of(Criterion criterion);
/// The criterion with this name, if there is one.
std::optional<Criterion> find_criterion(std::string_view name);

/// What one level of priority optimises: a criterion, or a weighted sum of criteria.
///
/// A weighted sum is minimised, whatever the directions of its parts; a part to be maximised has a negative
/// weight. Its unit is none; each term is weighted, then rounded, once.
struct Objective {
  struct Part {
    Criterion criterion;
    double weight = 1;
    bool operator==(const Part&) const = default;
  };
  Objective(Criterion criterion) : parts{{criterion}} {}  // NOLINT(google-explicit-constructor)
  /// Throws: Error{Usage} without a part.
  explicit Objective(std::vector<Part> weighted);

  std::vector<Part> parts;
  bool is_weighted = false;  ///< false: one criterion, weight 1, in its own direction

  [[nodiscard]] bool is(Criterion criterion) const {
    return !is_weighted && parts.front().criterion == criterion;
  }
  /// Whether it is of pits: where it comes first it is a condition on which diagonals connect what.
  [[nodiscard]] bool is_of_pits() const;
  /// Whether its value is that of one term, the worst.
  [[nodiscard]] bool is_extreme() const;
  /// Whether a part measures against heights from elsewhere (`OptimizeOptions::reference`).
  [[nodiscard]] bool needs_reference() const;
  [[nodiscard]] std::string name() const;  ///< as `parse_objective` reads it
  [[nodiscard]] std::string_view unit() const;
  [[nodiscard]] Direction direction() const;
  bool operator==(const Objective&) const = default;
};

/// Reads a criterion's name, or a weighted sum such as `2*edge-length+0.5*normal-angle-sum-convex-edges`.
/// Throws: Error{Usage} if a name is unknown or repeated, a weight is no finite number or 0, or a part is no
/// sum of terms (a count is one; a largest or smallest value, local-minima and pit-depth are not).
Objective parse_objective(std::string_view text);

}  // namespace thalweg
