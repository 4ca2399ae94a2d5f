#include "pipeline/read_in_crs.hpp"

namespace thalweg {

ReadResult read_in_crs(std::span<const SourceSpec> points, std::span<const LineSource> lines,
                       ReadOptions options, const CrsInfo& crs, Progress& progress) {
  ReadResult read = read_survey(points, lines, options, progress);
  const bool same = is_same_unit(read.crs.vertical_metres_per_unit, crs.vertical_metres_per_unit) &&
                    means_same_crs(read.crs.wkt, crs.wkt);
  if (!crs.known || !read.crs.known || same) return read;
  options.target_crs = crs.wkt;
  return read_survey(points, lines, options, progress);
}

}  // namespace thalweg
