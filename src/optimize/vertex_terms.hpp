#pragma once

/// Terms of vertices, as functions of the labels of the quadrilaterals that have the vertex as a corner.

#include "optimize/declaration.hpp"
#include "optimize/tables.hpp"
#include "optimize/term_scan.hpp"

#include <thalweg/base/progress.hpp>

#include <cstdint>
#include <vector>

namespace thalweg {

/// The most quadrilaterals at one vertex that a table takes.
constexpr std::size_t kMostAtVertex = 20;

struct VertexTerms {
  Tables<1> tables;  ///< variables are quadrilaterals; those that change nothing are left out
  std::vector<std::int64_t> constants;  ///< terms that no label changes
};

/// The term of every vertex that is in a triangle, each once; the result does not depend on the number of
/// threads. Throws: Error{Unsupported} if more than kMostAtVertex quadrilaterals meet at a vertex.
/// Complexity: k 2^k for a vertex with k quadrilaterals; runs on all threads.
VertexTerms find_vertex_terms(const TermScan& scan, VertexTerm term, const Progress& progress);

}  // namespace thalweg
