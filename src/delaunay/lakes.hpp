#pragma once

/// Lakes: areas of a ground that are flat, each at one height.

#include "drawing.hpp"

#include <thalweg/base/progress.hpp>
#include <thalweg/mesh/tin.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace thalweg {

struct LevelledLakes {
  std::vector<double> z;                         ///< heights of the TIN's vertices
  std::size_t lakes = 0;                         ///< bodies of water; lakes that touch are one
  std::size_t points = 0;                        ///< points whose height gave way
  std::vector<Conflict> conflicts;               ///< heights that gave way, and levels that disagree
  std::vector<std::uint32_t> conflict_vertices;  ///< the vertex of the drawing of each
};

/// True if the survey has a line of kind Lake.
bool has_lakes(const Survey& survey);

/// Gives all vertices in a lake, shore included, its level: the lowest height that its rings have, else the
/// lowest of the vertices on its shore. A lake is what an odd number of the rings of a feature surrounds.
/// Pre: the pieces of the rings are edges of `hull`, which covers all vertices; vertex v of the drawing is
/// now_of[v] in it. Throws: Error{Cancelled}. Complexity: linear.
LevelledLakes level_lakes(const Survey& survey, const Drawing& drawing, const Tin& hull,
                          std::span<const std::uint32_t> now_of, const Progress& progress);

}  // namespace thalweg
