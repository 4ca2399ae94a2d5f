#pragma once

/// Which triangle is in which quadrilateral, and who is whose neighbour.

#include "optimize/labelling.hpp"

#include <thalweg/mesh/tin.hpp>
#include <thalweg/order/quadrilaterals.hpp>

#include <array>
#include <span>
#include <vector>

namespace thalweg {

/// The quadrilateral of each triangle, or kNone. Throws: Error{Unsupported} if two of them share a triangle.
/// Complexity: linear.
std::vector<std::uint32_t> quadrilaterals_of_triangles(const Tin& tin,
                                                       std::span<const Quadrilateral> quadrilaterals);

/// One side of a quadrilateral, seen from inside.
struct Side {
  HalfedgeId inner;     ///< of the triangle in the TIN, which has it under label 0
  bool at_s_u = false;  ///< under label 1 it belongs to triangle sut, else to tvs
};

/// Sides su, ut, tv, vs. Label 0 has triangles suv (sides 0 and 3) and vut, label 1 sut and tvs.
inline std::array<Side, 4> sides_of(const Tin& tin, const Quadrilateral& quadrilateral) {
  const HalfedgeId uv = quadrilateral.diagonal;
  const HalfedgeId vu = tin.twin(uv);
  return {
      {{Tin::previous(uv), true}, {Tin::next(vu), true}, {Tin::previous(vu), false}, {Tin::next(uv), false}}};
}

/// Two quadrilaterals with a common side, and where each stands in the row of the other.
struct Neighbours {
  std::uint32_t q = 0, p = 0;
  std::uint32_t q_slot = 0, p_slot = 0;  ///< slot in q's row, which holds p; in p's row, which holds q
};

/// Values of a term by the labels of q and p: f00, f10 (q has label 1), f01, f11.
using PairValues = std::array<double, 4>;

}  // namespace thalweg
