#pragma once

/// A criterion with its term: the private half of its declaration.

#include "optimize/face.hpp"

#include <thalweg/optimize/criterion.hpp>

namespace thalweg {

/// The term of a triangle.
using TriangleTerm = double (*)(const Face&, Scale);
/// The term of an interior edge; symmetric in its triangles.
using EdgeTerm = double (*)(const Face&, const Face&, Scale);

/// Of the terms there is the one that the coupling says; for Plateau there is none (plateaus.cpp).
struct Declaration {
  CriterionTraits traits;
  TriangleTerm triangle = nullptr;
  EdgeTerm edge = nullptr;
};

const Declaration& declaration_of(Criterion criterion);

}  // namespace thalweg
