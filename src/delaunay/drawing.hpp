#pragma once

/// Points and lines of a survey as one plan: vertices, noded lines, and what lines have to do with vertices.

#include "merge.hpp"
#include "noding.hpp"

#include <thalweg/base/progress.hpp>
#include <thalweg/mesh/survey.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace thalweg {

/// A line goes through a vertex.
struct Passage {
  enum class Where : std::uint8_t { AtVertex, OnEdge };
  std::uint32_t vertex = 0;  ///< of the drawing
  std::uint32_t line = 0;    ///< of the survey
  std::uint32_t at = 0;      ///< vertex of the line; on an edge: the one before
  Where where = Where::AtVertex;
};

/// The piece of a line from one of its vertices to the next.
struct LinePiece {
  std::uint32_t line = 0;
  std::uint32_t vertex = 0;
};

struct Drawing {
  /// All vertices: points, line vertices, crossings. Line vertices of lines that were not drawn are left out.
  MergedVertices vertices;
  Noding noding;
  std::vector<LinePiece> pieces;  ///< one a segment of the noding
  std::vector<Passage> passages;  ///< in order of vertex, line, place along the line; none twice
};

/// Draws the given lines with all points. Throws: Error{TooClose} naming the lines.
Drawing draw(const Survey& survey, MergedVertices merged, std::span<const std::uint32_t> lines,
             Progress& progress);

/// The constraint edges of a drawing, each once, in order of vertices. Pre: it was drawn from `survey`.
std::vector<ConstraintEdge> constraint_edges(const Survey& survey, const Drawing& drawing);

}  // namespace thalweg
