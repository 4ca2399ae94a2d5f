#include "pipeline/outlets.hpp"

#include "pipeline/read_in_crs.hpp"

#include <thalweg/base/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace thalweg {

std::vector<Point2> read_places(const std::vector<SourceSpec>& sources, const CrsInfo& crs,
                                Progress& progress) {
  std::vector<Point2> points;
  for (const SourceSpec& source : sources) {
    ReadOptions options;
    options.heights = HeightRule::Optional;
    const ReadResult read = read_in_crs({&source, 1}, {}, options, crs, progress);
    points.insert(points.end(), read.survey.points.xy.begin(), read.survey.points.xy.end());
  }
  return points;
}

VertexId outlet_at(Point2 written, const Tin& tin, const TriangleGrid& grid, const Plane& plane) {
  const Point2 p = plane.to_plane(written);
  const auto t = grid.find(p);
  if (!t) {
    throw Error(ErrorCode::OutsideHull,
                fmt::format("the outlet at {} {} is outside of the TIN; move it inside, or "
                            "take it out of --outlets",
                            written.x, written.y));
  }
  const auto distance = [&](VertexId v) { return std::hypot(tin.point(v).x - p.x, tin.point(v).y - p.y); };
  const Triangle& corner = tin.triangle(*t);
  return *std::min_element(corner.begin(), corner.end(),
                           [&](VertexId a, VertexId b) { return distance(a) < distance(b); });
}

}  // namespace thalweg
