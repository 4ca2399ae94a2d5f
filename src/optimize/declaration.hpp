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

/// The term of a triangle that is measured against a reference, and what it leaves for the rim of the TIN.
using ReferenceTerm = double (*)(const Face&, Scale, const Reference&);

/// Of the terms there is the one that the coupling says (of a triangle's, one); for Plateau there is none
/// (plateaus.cpp).
struct Declaration {
  CriterionTraits traits;
  TriangleTerm triangle = nullptr;
  EdgeTerm edge = nullptr;
  ReferenceTerm against_reference = nullptr;
};

const Declaration& declaration_of(Criterion criterion);

}  // namespace thalweg
