#pragma once

/// What the writers of meshes share: progress by element, and the lines of constraint edges.

#include "io/edge_chains.hpp"
#include "io/tin_format.hpp"

#include <cstddef>
#include <vector>

namespace thalweg {

/// Calls `write` for 0 .. count - 1 and reports the job's progress as elements `start` and on of all vertices
/// and triangles. Throws: Error{Cancelled}; what `write` throws.
template <class Write>
void write_each(const TinWriteJob& job, std::size_t start, std::size_t count, const Write& write) {
  constexpr std::size_t kProgressStep = std::size_t{1} << 14U;
  const double total = static_cast<double>(job.view.tin.vertex_count() + job.view.tin.triangle_count() + 1);
  for (std::size_t i = 0; i < count; ++i) {
    if (i % kProgressStep == 0) job.progress.advance(static_cast<double>(start + i) / total);
    write(i);
  }
}

/// The constraint edges that the creation option EDGES wants.
inline std::vector<ConstraintEdge> edges_to_write(const TinWriteJob& job) {
  return job.options.enabled("EDGES") ? job.view.tin.constraint_edges() : std::vector<ConstraintEdge>{};
}

/// The same as lines.
inline std::vector<EdgeChain> chains_to_write(const TinWriteJob& job) {
  const std::vector<ConstraintEdge> edges = edges_to_write(job);
  return chain_edges(edges);
}

}  // namespace thalweg
