// From a survey to what the verifier looks up.
#include "pipeline/verify_sources.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace thalweg {

namespace {

constexpr double kDensifyLimitM = 0.1;  ///< a piece that bends by less was left straight
constexpr double kBendM = 0.01;         ///< what the points put in leave of a bend

/// Straight pieces between two vertices in the source's coordinates, the last point left out.
void append_piece(verify::SourceLine& line, const SurveyLine& source, std::size_t i, const Plane& plane) {
  const Point2 a = source.xy[i];
  Point2 b = source.xy[i + 1];
  const double period = plane.x_period();
  if (period > 0) b.x -= period * std::round((b.x - a.x) / period);
  const auto between = [&](double t) { return Point2{a.x + (b.x - a.x) * t, a.y + (b.y - a.y) * t}; };
  const Point2 first = plane.to_plane(a), last = plane.to_plane(source.xy[i + 1]);
  double bend = 0;
  for (const double t : {0.25, 0.5, 0.75}) {  // a piece that bends both ways may not bend in the middle
    const Point2 p = plane.to_plane(between(t));
    bend =
        std::max(bend, std::hypot(p.x - std::lerp(first.x, last.x, t), p.y - std::lerp(first.y, last.y, t)));
  }
  constexpr double kMost = 100'000;
  const double count = std::clamp(std::ceil(std::sqrt(bend / kBendM)), 1.0, kMost);
  for (double k = 0; k < count; ++k) {
    line.xy.push_back(k == 0 ? first : plane.to_plane(between(k / count)));
    line.given.push_back(k == 0);
    if (!source.z.empty()) line.z.push_back(source.z[i] + (source.z[i + 1] - source.z[i]) * (k / count));
  }
}

verify::SourceLine line_in_plane(const SurveyLine& source, const Survey& survey, const Plane& plane) {
  const SourceLayer& layer = survey.sources[source.source];
  verify::SourceLine line;
  line.kind = source.kind;
  line.feature = layer.file + (layer.layer.empty() ? "" : "|" + layer.layer) + " feature " +
                 std::to_string(source.feature);
  line.name = line.feature + " part " + std::to_string(source.part);
  if (!plane.projected()) {
    line.xy = source.xy;
    line.z = source.z;
    return line;
  }
  for (std::size_t i = 0; i + 1 < source.xy.size(); ++i) append_piece(line, source, i, plane);
  line.xy.push_back(plane.to_plane(source.xy.back()));
  line.given.push_back(true);
  if (!source.z.empty()) line.z.push_back(source.z.back());
  return line;
}

}  // namespace

verify::Sources sources_in_plane(const Survey& survey, const Plane& plane, double snapping_pixel,
                                 const Progress& progress) {
  verify::Sources sources;
  sources.points = plane.to_plane(survey.points.xy, progress);
  sources.heights = survey.points.z;
  for (const SurveyPoints::Run& run : survey.points.runs) {
    const SourceLayer& layer = survey.sources[run.source];
    sources.names.push_back(layer.file + (layer.layer.empty() ? "" : "|" + layer.layer));
    sources.first_of_run.push_back(run.first);
  }
  double largest = 0;
  for (const SurveyLine& line : survey.lines) {
    progress.check();
    sources.lines.push_back(line_in_plane(line, survey, plane));
    for (const Point2 p : sources.lines.back().xy)
      largest = std::max({largest, std::abs(p.x), std::abs(p.y)});
    sources.is_cut = sources.is_cut || line.kind == EdgeKind::Boundary || line.kind == EdgeKind::Hole;
  }
  constexpr double kPixelOfLargest = 0x1p-43, kGeographicPixel = 0x1p-20;
  sources.pixel = snapping_pixel > 0 ? snapping_pixel : largest * kPixelOfLargest;
  if (plane.projected()) {
    sources.pixel = std::max(sources.pixel, kGeographicPixel);
    sources.bend = kDensifyLimitM + kBendM;
  }
  return sources;
}

}  // namespace thalweg
