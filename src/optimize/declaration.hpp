#pragma once

/// A criterion with its term: the private half of its declaration.

#include "optimize/face.hpp"

#include <thalweg/optimize/criterion.hpp>
#include <thalweg/optimize/reference.hpp>

namespace thalweg {

/// The term of a triangle.
using TriangleTerm = double (*)(const Face&, Scale);
/// The term of an interior edge; symmetric in its triangles.
using EdgeTerm = double (*)(const Face&, const Face&, Scale);
/// The term of an interior edge, of the angle between the upward normals of its triangles, in radians; 0
/// where the surface goes on flat.
using AngleTerm = double (*)(double);
/// The angle itself.
inline double the_angle(double radians) {
  return radians;
}

/// The same where it matters what is drawn: the TIN says which edges are drawn as what.
using DrawnTriangleTerm = double (*)(const Face&, const Tin&);
using DrawnEdgeTerm = double (*)(const Face&, const Face&, Scale, const Tin&);

/// The term of a triangle that is measured against a reference, and what it leaves for the rim of the TIN.
using ReferenceTerm = double (*)(const Face&, Scale, const Reference&);

/// What meets at a vertex. The surface is strictly convex or reflex at an edge, or flat, decided exactly.
struct Star {
  std::uint32_t edges = 0;                            ///< rim edges included
  bool convex = false, reflex = false, flat = false;  ///< whether it is so at some edge
  bool on_rim = false;
};
/// The term of a vertex that is in a triangle: a whole number.
using VertexTerm = std::int64_t (*)(const Star&);

/// Of the terms there is the one that the coupling says (of a triangle's or an edge's, one); for Plateau
/// there is none (plateaus.cpp, spills.cpp).
struct Declaration {
  CriterionTraits traits;
  TriangleTerm triangle = nullptr;
  EdgeTerm edge = nullptr;
  ReferenceTerm against_reference = nullptr;
  VertexTerm vertex = nullptr;
  bool sum_is_fixed = false;  ///< no label changes the sum of all terms
  AngleTerm of_angle = nullptr;
  DrawnTriangleTerm drawn_triangle = nullptr;
  DrawnEdgeTerm drawn_edge = nullptr;

  /// Of the coupling OneTriangle: its term. `reference` may be null if it is not measured against one.
  [[nodiscard]] double of_triangle(const Face& face, Scale scale, const Tin& tin,
                                   const Reference* reference) const {
    if (triangle != nullptr) return triangle(face, scale);
    return drawn_triangle != nullptr ? drawn_triangle(face, tin) : against_reference(face, scale, *reference);
  }
  /// Of the coupling Edge: its term.
  [[nodiscard]] double of_edge(const Face& left, const Face& right, Scale scale, const Tin& tin) const {
    if (of_angle != nullptr) return of_angle(angle_between(left.normal, right.normal));
    return edge != nullptr ? edge(left, right, scale) : drawn_edge(left, right, scale, tin);
  }
};

const Declaration& declaration_of(Criterion criterion);

/// Steps of an objective's value in one unit; negative where it is maximised.
double steps_per_unit(const Objective& objective);

}  // namespace thalweg
