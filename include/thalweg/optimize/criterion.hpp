#pragma once

/// What can be optimised over the first-order triangulations of a TIN.

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace thalweg {

enum class Criterion : std::uint8_t {
  LocalMinima,    ///< number of interior pits, as find_pits counts them
  NormalAngleSum  ///< sum over interior edges of the angle between the normals of the two triangles
};

/// What one term of a criterion depends on.
enum class Coupling : std::uint8_t {
  Edge,    ///< the two triangles at an edge, so at most two quadrilaterals
  Plateau  ///< all edges that leave a connected set of vertices of equal height
};

/// How terms become the value.
enum class Combination : std::uint8_t { Sum, Count };

enum class Direction : std::uint8_t { Minimise, Maximise };

/// All that is known of a criterion, in one place.
struct CriterionTraits {
  Criterion criterion;
  std::string_view name;  ///< as on the command line and in the report
  std::string_view unit;
  Direction direction;
  Coupling coupling;
  Combination combination;
};

/// Every criterion, in the order of the enumeration.
std::span<const CriterionTraits> all_criteria();
const CriterionTraits& traits_of(Criterion criterion);
/// The criterion with this name, if there is one.
std::optional<Criterion> find_criterion(std::string_view name);

}  // namespace thalweg
