// A reference is read as any source of points.
#include "pipeline/reference.hpp"

#include <utility>

namespace thalweg {

ReferencePoints read_reference(const SourceSpec& source, const CrsInfo& crs, const Plane& plane,
                               Progress& progress) {
  ReadResult read = read_survey(std::span(&source, 1), {}, {}, progress);
  const bool same = read.crs.vertical_metres_per_unit == crs.vertical_metres_per_unit &&
                    means_same_crs(read.crs.wkt, crs.wkt);
  if (crs.known && read.crs.known && !same) {
    ReadOptions options;
    options.target_crs = crs.wkt;
    read = read_survey(std::span(&source, 1), {}, options, progress);
  }
  return {plane.to_plane(read.survey.points.xy, progress), std::move(read.survey.points.z)};
}

}  // namespace thalweg
