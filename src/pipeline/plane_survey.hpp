#pragma once

/// Sources read and brought to the plane of triangulation.

#include "pipeline/plane.hpp"

#include <thalweg/base/progress.hpp>
#include <thalweg/delaunay/ground.hpp>
#include <thalweg/io/source.hpp>

#include <span>
#include <vector>

namespace thalweg {

/// Doubles that are longitudes are up to 3e-9 m apart; two programs that compute the same one differ by a
/// few.
constexpr double kGeographicResolutionM = 0x1p-20;

/// A survey in the plane, and the coordinates that it was given in.
struct PlaneSurvey {
  Survey survey;
  std::vector<Point2> written_points;              ///< empty: the plane's own
  std::vector<std::vector<Point2>> written_lines;  ///< per line
  std::size_t vertices_inserted_on_lines = 0;
};

struct SurveyInPlane {
  ReadResult read;  ///< its survey is moved out
  Plane plane;
  PlaneSurvey survey;
};

/// Reads the sources and projects them. In a geographic survey points on a line become its vertices and
/// pieces that bend are densified before anything is projected; then lines get vertices where the plane has a
/// point on their wrong side. Throws: what reading and projecting throw.
SurveyInPlane read_into_plane(std::span<const SourceSpec> points, std::span<const LineSource> lines,
                              const ReadOptions& options, Progress& progress,
                              const MemorySource& memory = {});

/// The written coordinates of the vertices of a ground that was built of the survey; empty: the plane's own.
std::vector<Point2> written_of(const Ground& ground, const PlaneSurvey& survey, const Plane& plane);

}  // namespace thalweg
