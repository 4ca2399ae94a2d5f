#pragma once

/// Whether a TIN keeps what it was made of: points, lines and their heights.
///
/// Plain code that shares nothing with the noding: every point and every vertex of a line is looked up by its
/// position, every piece of a line is covered, interval by interval, by the constraint edges that run along
/// it.

#include <thalweg/base/progress.hpp>
#include <thalweg/mesh/survey.hpp>
#include <thalweg/verify/verify.hpp>

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace thalweg::verify {

/// A line in the plane of triangulation.
struct SourceLine {
  EdgeKind kind = EdgeKind::Breakline;
  std::string feature;  ///< "lines.gpkg|valleys feature 3": the rings of one area have it in common
  std::string name;     ///< "lines.gpkg|valleys feature 3 part 0"
  std::vector<Point2> xy;
  std::vector<double> z;    ///< as long as xy; empty: a soft line
  std::vector<bool> given;  ///< false: not drawn, but on the way where the line bends; empty: all are drawn
};

/// Points and lines in the plane of triangulation, as read.
struct Sources {
  std::vector<Point2> points;
  std::vector<double> heights;
  std::vector<std::string> names;         ///< one a run of points
  std::vector<std::size_t> first_of_run;  ///< index of its first point
  std::vector<SourceLine> lines;
  double snap = 0;   ///< plane units: a position may have moved so far to another one
  double pixel = 0;  ///< plane units: so far the vertex of a line may be from its position, edges from a line
  double bend = 0;   ///< plane units: edges may be farther from a line by this
  /// What the report says, if there is one: places where heights disagree (in the plane, to within a
  /// micrometre or a pixel), and how many positions the surface does not hold.
  std::optional<std::vector<Conflict>> conflicts;
  std::optional<std::size_t> positions_left_out;
  /// Heights that the report says were changed, with their new value: sources have another one there.
  struct Conditioned {
    Point2 xy;
    double before = 0, after = 0;
  };
  std::vector<Conditioned> conditioned;
  /// Of a simplified source: no point is vertically farther from the TIN, in the unit of heights.
  std::optional<double> largest_error;
  /// Whether the surface may end before its sources do: an area bounds it, or triangles at the rim went.
  bool is_cut = false;
};

/// One line for each: points (of a simplified source: those that were kept) and vertices of lines are
/// vertices, heights are theirs, lines are covered, lakes are flat. What lies on the surface and is missing
/// breaks the claim; what lies off it has to be allowed for by `is_cut` and `positions_left_out`. Pre: the
/// mesh is sound. Throws: Error{Cancelled}. Complexity: n log n for usual input.
std::vector<Finding> check_sources(const Subject& subject, const Sources& sources, Progress& progress);

}  // namespace thalweg::verify
