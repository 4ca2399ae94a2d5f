#pragma once

/// Heights of the vertices of a drawing, and where sources disagree.

#include "drawing.hpp"

#include <thalweg/delaunay/ground.hpp>

#include <vector>

namespace thalweg {

struct Heights {
  std::vector<double> z;
  std::vector<bool> known;                       ///< false: no point and no hard line passes there
  std::vector<Conflict> conflicts;               ///< in order of vertices
  std::vector<std::uint32_t> conflict_vertices;  ///< the vertex of each conflict
};

/// By how much a height interpolated between the ends of a hard segment, at a place that noding may have
/// moved by a pixel, may be off: heights that differ by no more agree. Pre: a != b.
double height_slack(Point2 a, double z_a, Point2 b, double z_b, double pixel);

/// A hard line beats points; lines among each other follow `crossing`, points `duplicates`.
/// Throws: Error{CrossingLines} under CrossingRule::Error.
Heights resolve_heights(const Survey& survey, const Drawing& drawing, const GroundOptions& options,
                        Progress& progress);

}  // namespace thalweg
