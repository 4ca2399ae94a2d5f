// Reading into the plane of triangulation.
#include "pipeline/plane_survey.hpp"

#include <thalweg/delaunay/split_lines.hpp>
#include <thalweg/mesh/densify.hpp>

#include <mesh/line_vertices.hpp>

#include <utility>
#include <vector>

namespace thalweg {

namespace {

PlaneSurvey to_plane(Survey survey, const Plane& plane, Progress& progress) {
  PlaneSurvey result;
  result.survey = std::move(survey);
  if (!plane.projected()) return result;
  std::vector<SurveyLine>& lines = result.survey.lines;
  std::vector<Point2>& points = result.survey.points.xy;
  const DensifyOptions options = {.x_period = plane.x_period()};
  const auto project = [&](Point2 p) { return plane.to_plane(p); };
  std::size_t inserted = 0;
  if (!lines.empty()) {
    inserted += split_lines_at_points(result.survey, options.x_period, progress);
    inserted += densify_lines(result.survey, project, options);
  }
  result.written_points = std::exchange(points, plane.to_plane(points, progress));
  for (SurveyLine& line : lines) {
    result.written_lines.push_back(std::exchange(line.xy, plane.to_plane(line.xy, progress)));
  }
  if (!lines.empty()) {
    const WrittenSurvey written = {result.written_points, result.written_lines};
    inserted +=
        split_lines_beside_points(result.survey, written, project, options, kGeographicResolutionM, progress);
  }
  result.vertices_inserted_on_lines = inserted;
  return result;
}

}  // namespace

SurveyInPlane read_into_plane(std::span<const SourceSpec> points, std::span<const LineSource> lines,
                              const ReadOptions& options, Progress& progress, const MemorySource& memory) {
  ReadResult read = read_survey(points, lines, options, progress, memory);
  Plane plane(read.crs, positions_of(read.survey));
  PlaneSurvey survey = to_plane(std::move(read.survey), plane, progress);
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
