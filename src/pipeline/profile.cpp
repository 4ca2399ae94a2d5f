// Lines are straight in the plane of the TIN; distances are metres there.
#include "pipeline/profile.hpp"

#include "pipeline/read_in_crs.hpp"

#include <thalweg/base/error.hpp>
#include <thalweg/terrain/profile.hpp>

#include <fmt/format.h>

#include <iterator>
#include <span>
#include <vector>

namespace thalweg {

ProfileTable profile_table(const LoadedTin& loaded, const ProfileConfig& config, Progress& progress) {
  const LineSource source{config.lines, EdgeKind::Breakline};
  const Survey survey = read_in_crs({}, std::span(&source, 1), {}, loaded.crs, progress).survey;
  progress.start_phase("profile");
  const Plane& plane = loaded.plane;
  const ProfileTracer tracer(loaded.tin);
  ProfileTable table{.csv = "line,part,distance,x,y,z\n", .lines = survey.lines.size()};
  auto out = std::back_inserter(table.csv);
  for (std::size_t l = 0; l < survey.lines.size(); ++l) {
    const std::vector<Point2> line = plane.to_plane(survey.lines[l].xy, progress);
    for (const ProfilePoint& p : tracer.trace(line, progress)) {
      const Point2 xy = plane.to_written(p.xy);
      fmt::format_to(out, "{},{},{},{},{},{}\n", l, p.part, p.distance * plane.metres_per_unit(), xy.x, xy.y,
                     p.z);
      ++table.rows;
    }
  }
  if (table.rows == 0) {
    throw Error(ErrorCode::OutsideHull, config.lines.path + ": none of " + std::to_string(table.lines) +
                                            " lines meets the TIN; is it of the same place and CRS?");
  }
  return table;
}

}  // namespace thalweg
