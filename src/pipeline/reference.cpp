// A reference is read as any source of points.
#include "pipeline/reference.hpp"

#include "pipeline/read_in_crs.hpp"

#include <utility>

namespace thalweg {

ReferencePoints read_reference(const SourceSpec& source, const CrsInfo& crs, const Plane& plane,
                               Progress& progress) {
  ReadResult read = read_in_crs(std::span(&source, 1), {}, {}, crs, progress);
  return {plane.to_plane(read.survey.points.xy, progress), std::move(read.survey.points.z)};
}

}  // namespace thalweg
