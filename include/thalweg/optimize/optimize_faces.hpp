#pragma once

/// The best triangulation among those of a higher order: a triangulation is chosen in each face.

#include <thalweg/base/progress.hpp>
#include <thalweg/mesh/tin.hpp>
#include <thalweg/optimize/optimize.hpp>
#include <thalweg/order/fixed_faces.hpp>

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace thalweg {

struct FaceOptimizeOptions {
  OptimizeOptions common;
  /// If given, the sum of the orders of all triangles is minimised after that many of the criteria, and
  /// before the others: shape is given up only where the criteria before it gain. Its line in the result is
  /// `order-sum`.
  std::optional<std::size_t> order_sum_after;
  /// Largest number of edges in the fronts of one face. Where there are more, only triangulations of a
  /// smaller order are chosen from, and those of the heuristics if pits are counted; the bound holds for all.
  std::size_t work_limit = 2'000'000;
  /// Largest number of comparisons of partial triangulations of one face: a count, so the answer is the same
  /// everywhere. From there on only `few_labels` are kept of those that have the same front; the bound holds
  /// for all.
  std::size_t most_comparisons = 100'000'000;
  std::size_t few_labels = 16;
  bool bounds_alone = false;  ///< whether to find these, of the result
};

struct FaceOptimizeResult {
  std::vector<OrderTriangle> triangles;   ///< the result, sorted
  Tin tin;                                ///< made of them
  std::vector<CriterionResult> criteria;  ///< as the options' criteria, and the sum of orders in its place
  /// By criterion a bound over all triangulations, whatever they reach in the criteria before it.
  std::vector<double> bounds_alone;
  std::size_t faces = 0;
  std::size_t partial_faces = 0;  ///< those of which only some triangulations were chosen from
  std::size_t largest_face = 0;   ///< triangles
  std::size_t labels = 0;         ///< triangulations of all faces that may be best for choices elsewhere
  std::size_t most_labels = 0;    ///< of one face
  std::size_t new_edges = 0;      ///< that the given TIN does not have
  std::size_t fixed_by_elimination = 0;  ///< variables: faces, and what counts pits
  std::size_t pieces = 0;
  std::size_t largest_piece = 0;  ///< variables
  std::size_t width = 0;          ///< the largest table has up to 2^width entries
};

/// Chooses a triangulation of each face: criteria first, then fewest edges that the given TIN does not have,
/// then a rule on coordinates alone, so that the result is one triangulation, whatever the order of the input
/// or the number of threads. `bound` and `optimal` of each criterion as for optimize_first_order, over all
/// triangulations that the faces leave.
///
/// Pre: `delaunay` is the constrained Delaunay triangulation on the surface for which the faces were found.
/// Throws: Error{Usage} as optimize_first_order; {Unsupported} for a criterion of vertices and for depths of
/// pits; {SizeLimit} if a face has more fronts than the options allow and the Delaunay
/// triangulation is none of its own; {Cancelled}.
/// Complexity: fronts of all faces, and what is kept at each; then linear but for pieces that stay wide. Runs
/// on all threads.
FaceOptimizeResult optimize_faces(const Tin& delaunay, const FixedFaces& faces,
                                  const FaceOptimizeOptions& options, Progress& progress);

/// Throws: Error{Unsupported} for a criterion that `optimize_faces` does not take.
void require_face_criteria(const std::vector<Objective>& criteria);

/// Bounds the values of another choice by those of one that may have more: `of` are its criteria, `alone` its
/// `bounds_alone`, which hold where a criterion before is not reached. Says what is `optimal`, and adds to
/// the methods.
void take_bounds(std::span<const CriterionResult> of, std::span<const double> alone,
                 std::span<CriterionResult> lines);

}  // namespace thalweg
