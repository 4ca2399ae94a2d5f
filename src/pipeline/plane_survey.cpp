// Reading into the plane of triangulation.
#include "pipeline/plane_survey.hpp"

#include <thalweg/delaunay/split_lines.hpp>
#include <thalweg/mesh/densify.hpp>

#include <utility>
#include <vector>

namespace thalweg {

namespace {

PlaneSurvey to_plane(Survey survey, const Plane& plane, const Progress& progress) {
  PlaneSurvey result;
  if (plane.projected()) {
    result.written_points = survey.points.xy;
    survey.points.xy = plane.to_plane(result.written_points, progress);
    for (SurveyLine& line : survey.lines) {
      result.written_lines.push_back(line.xy);
      line.xy = plane.to_plane(line.xy, progress);
    }
  }
  result.survey = std::move(survey);
  return result;
}

}  // namespace

SurveyInPlane read_into_plane(std::span<const SourceSpec> points, std::span<const LineSource> lines,
                              const ReadOptions& options, Progress& progress, const MemorySource& memory) {
  ReadResult read = read_survey(points, lines, options, progress, memory);
  std::size_t inserted = 0;
  if (read.crs.geographic) inserted += split_lines_at_points(read.survey, progress);
  Plane plane(read.crs, positions_of(read.survey));
  if (plane.projected()) {
    inserted += densify_lines(read.survey, [&](Point2 p) { return plane.to_plane(p); },
                              {.x_period = plane.x_period()});
  }
  PlaneSurvey survey = to_plane(std::move(read.survey), plane, progress);
  survey.vertices_inserted_on_lines = inserted;
  return {std::move(read), std::move(plane), std::move(survey)};
}

std::vector<Point2> written_of(const Ground& ground, const PlaneSurvey& survey, const Plane& plane) {
  std::vector<Point2> written;
  if (!plane.projected()) return written;
  written.reserve(ground.origins.size());
  for (std::size_t v = 0; v < ground.origins.size(); ++v) {
    const VertexOrigin& origin = ground.origins[v];
    switch (origin.kind) {
      case VertexOrigin::Kind::Point:
        written.push_back(survey.written_points[origin.index]);
        break;
      case VertexOrigin::Kind::LineVertex:
        written.push_back(survey.written_lines[origin.index][origin.vertex]);
        break;
      case VertexOrigin::Kind::Crossing:
        written.push_back(plane.to_written(ground.tin.point(VertexId{v})));
        break;
    }
  }
  return written;
}

}  // namespace thalweg
