// The ground of a survey.
#include "merge.hpp"

#include <thalweg/base/error.hpp>
#include <thalweg/delaunay/ground.hpp>
#include <thalweg/delaunay/triangulate.hpp>

namespace thalweg {

Ground build_ground(const Survey& survey, const GroundOptions& options, Progress& progress) {
  if (!survey.lines.empty()) throw Error(ErrorCode::Unsupported, "lines are not taken yet");
  MergedVertices merged = merge_vertices(survey, options.snap, progress);
  Ground ground;
  std::vector<double> heights(merged.xy.size());
  for (std::size_t v = 0; v < heights.size(); ++v) heights[v] = survey.points.z[merged.origins[v].index];
  for (const std::uint32_t v : merged.of_point) ground.point_vertices.emplace_back(v);
  ground.duplicates_merged = survey.points.xy.size() - merged.point_count;
  ground.tin = triangulate(std::move(merged.xy), std::move(heights), {}, progress);
  ground.origins = std::move(merged.origins);
  return ground;
}

}  // namespace thalweg
