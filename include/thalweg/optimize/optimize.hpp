#pragma once

/// The best triangulation among those of first order: one diagonal is chosen in each quadrilateral.

#include <thalweg/base/progress.hpp>
#include <thalweg/mesh/tin.hpp>
#include <thalweg/optimize/criterion.hpp>
#include <thalweg/optimize/reference.hpp>
#include <thalweg/order/quadrilaterals.hpp>

#include <cstdint>
#include <iosfwd>
#include <span>
#include <string>
#include <vector>

namespace thalweg {

constexpr std::uint32_t kMaxWidthLimit = 24;

struct OptimizeOptions {
  /// In order of priority: each decides among the triangulations that are best in all before it.
  std::vector<Objective> criteria = {Criterion::LocalMinima, Criterion::NormalAngleSum};
  double horizontal_metres_per_unit = 1;
  double vertical_metres_per_unit = 1;
  const Reference* reference = nullptr;  ///< for vertical-error; outlives the call
  /// Largest number of undecided quadrilaterals that one table of the dynamic program covers, 1 to 24; a
  /// table of width w has 2^w entries of 24 bytes.
  std::uint32_t width_limit = 18;
  /// Work allowed on what is wider than that, in table entries: a count, so the result is the same
  /// everywhere.
  std::uint64_t effort = 2'000'000'000;
  /// Where the stages of a proof go, in the words of thalweg/verify/proof.hpp; null: nowhere. What is proved
  /// is solved twice then.
  std::ostream* proof = nullptr;
};

/// How good the result is in one criterion. Sums are exact sums of terms, each rounded once to 2^-32 of its
/// unit (areas: 2^-22).
struct CriterionResult {
  std::string name;
  std::string unit;
  std::string direction;  ///< "min" or "max"
  double delaunay = 0;    ///< value of the given TIN
  double result = 0;
  /// No triangulation of first order that is best in the criteria before has a better value than this.
  double bound = 0;
  bool optimal = false;  ///< result equals bound, proved
  std::string method;    ///< what proved the bound
};

struct OptimizeResult {
  /// For each quadrilateral: 1 if the result has the diagonal st, 0 if it keeps uv.
  std::vector<std::uint8_t> flipped;
  std::vector<CriterionResult> criteria;  ///< as the options' criteria
  std::size_t quadrilaterals = 0;
  std::size_t fixed_by_elimination = 0;
  std::size_t pieces = 0;         ///< independent problems that were left
  std::size_t largest_piece = 0;  ///< quadrilaterals in the largest of them
  std::size_t width = 0;          ///< largest width of a table that was needed, at most the limit
};

/// Chooses diagonals. Criteria first, then fewest flips, then a rule on coordinates alone, so that the result
/// is one triangulation, whatever the order of the input or the number of threads.
///
/// Pre: the quadrilaterals are strictly convex, unconstrained pairs of triangles of the TIN, no two of which
/// share a triangle; ascending by diagonal. Heights are finite.
/// Throws: Error{Usage} if a criterion is repeated or lacks its reference, a unit is not positive or the
/// width limit is out of range; Error{SizeLimit} from 2^28 edges on; Error{Cancelled}. Complexity: linear but
/// for pieces that stay wide, and 2^k for k quadrilaterals at a vertex where a criterion of vertices depends
/// on them, k <= 20; where it depends on more, that vertex is taken at its best in the bound.
OptimizeResult optimize_first_order(const Tin& tin, std::span<const Quadrilateral> quadrilaterals,
                                    const OptimizeOptions& options, Progress& progress);

/// Writes the problem for toulbar2, in its .cfn format (JSON), so that another solver can confirm the result.
///
/// Variable qI is quadrilateral I of the list, value 0 its diagonal uv, value 1 st. If local minima come
/// first, outlet variables say by which diagonal each plateau is connected, and forbid every choice that has
/// more pits than need be; the pits themselves are not in the cost. The cost is the value of the first sum
/// among the criteria in steps of 2^-32 of its unit, the triangulation's constant part included; of flips, if
/// there is no sum. The optimum found is so 2^32 times the `result` of that criterion. Lower priorities,
/// flips and the tie rule are left out. If the first criterion besides local minima is the worst of its
/// terms, the cost is the number of terms that are no better than the result, which is found first: an
/// optimum above 0 says that nothing is better. Pre and Throws: as optimize_first_order, and Error{Usage} if
/// there is no criterion. Complexity: linear, but for b^3 where b plateaus hang together, and what the result
/// takes.
void dump_problem(std::ostream& out, const Tin& tin, std::span<const Quadrilateral> quadrilaterals,
                  const OptimizeOptions& options, Progress& progress);

}  // namespace thalweg
