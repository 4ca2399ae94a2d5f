#include "pipeline/outlets.hpp"

#include "pipeline/read_in_crs.hpp"

#include <thalweg/base/error.hpp>
#include <thalweg/geometry/predicates.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

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
  const Triangle& corners = tin.triangle(*t);
  std::vector<VertexId> near(corners.begin(), corners.end());
  for (std::size_t side = 0; side < 3; ++side) {  // on an edge the triangle beyond holds it too
    const HalfedgeId h = Tin::halfedge(*t, side), twin = tin.twin(h);
    if (!twin.valid() || orientation(tin.point(tin.origin(h)), tin.point(tin.target(h)), p) != 0) continue;
    near.push_back(tin.target(Tin::next(twin)));
  }
  const auto key = [&](VertexId v) {
    return std::pair(std::hypot(tin.point(v).x - p.x, tin.point(v).y - p.y), tin.point(v));
  };
  return *std::min_element(near.begin(), near.end(), [&](VertexId a, VertexId b) { return key(a) < key(b); });
}

}  // namespace thalweg
