#pragma once

/// The criteria of a terrain as a sum of factors over the labels of its quadrilaterals.

#include "verify/factor_sum.hpp"
#include "verify/plain_criteria.hpp"
#include "verify/plain_delaunay.hpp"

#include <span>
#include <vector>

namespace thalweg::verify {

/// A terrain between whose triangulations a choice was made. Label true: the other diagonal.
struct PlainProblem {
  const PlainMesh& delaunay;
  std::span<const PlainQuadrilateral> quadrilaterals;
  PlainScale scale;
  const PlainReference* reference = nullptr;
  unsigned order = 1;
  bool structure_known = true;  ///< the quadrilaterals are all there are
  std::vector<bool> flipped;    ///< of the mesh that is checked: diagonals st
};

/// One component of the costs: the terms of a sum (less is better), or a count of terms beyond a limit.
struct Component {
  PlainCriterion criterion;
  bool counts_beyond = false;
  std::int64_t limit = 0;  ///< in steps; largest: terms of this and more count; smallest: of this and less
  std::size_t place = 0;   ///< in the cost
};

/// One factor a set of quadrilaterals that share a term; all that no label changes has an empty scope.
/// Pre: no two quadrilaterals share a triangle; at most 20 meet at a vertex, if criteria depend on vertices
/// (`most_at_vertex`). Complexity: linear; 2^k for k quadrilaterals at a vertex.
std::size_t most_at_vertex(const PlainProblem& problem);
std::vector<Factor> terms_of(const PlainProblem& problem, const std::vector<Component>& components);

}  // namespace thalweg::verify
