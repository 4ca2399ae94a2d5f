#pragma once

/// The triangles that labels choose from.

#include "optimize/face.hpp"
#include "optimize/sides.hpp"

#include <span>

namespace thalweg {

/// Label 1 flips. What is referred to outlives it.
struct LabelledFaces {
  const Tin& tin;
  std::span<const Quadrilateral> quadrilaterals;
  std::span<const std::uint32_t> owner;  ///< of each triangle, the quadrilateral or kNone
  Scale scale;

  [[nodiscard]] Face face(VertexId a, VertexId b, VertexId c) const {
    return make_face(corner_of(tin, a), corner_of(tin, b), corner_of(tin, c), scale);
  }
  [[nodiscard]] Face face(HalfedgeId h) const { return face(tin.origin(h), tin.target(h), tin.apex(h)); }
  [[nodiscard]] Face flipped_face(std::size_t q, bool at_s_u) const {
    const auto& [s, u, t, v, diagonal] = quadrilaterals[q];
    return at_s_u ? face(s, u, t) : face(t, v, s);
  }
  [[nodiscard]] std::uint32_t owner_across(HalfedgeId h) const {
    const HalfedgeId outer = tin.twin(h);
    return outer.valid() ? owner[Tin::triangle_of(outer).index()] : kNone;
  }
};

}  // namespace thalweg
