#pragma once

/// The outline of a TIN.

#include <thalweg/mesh/tin.hpp>

#include <vector>

namespace thalweg {

/// The rim as closed loops of vertices, the surface to their left: outer outlines counter-clockwise, holes
/// clockwise. Each loop starts at its smallest id, loops are sorted. At a vertex where several fans meet a
/// loop stays with its fan, so a loop may pass such a vertex more than once. Complexity: linear.
std::vector<std::vector<VertexId>> rim_loops(const Tin& tin);

/// The halfedges on the rim, sorted by their origins: one for each fan that is open, the first of it
/// counter-clockwise. Complexity: linear, r log r for r of them.
std::vector<HalfedgeId> rim_halfedges(const Tin& tin);

}  // namespace thalweg
