// The way of points from a source into the survey.
#include "io/point_collector.hpp"

#include <thalweg/base/error.hpp>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <span>
#include <string>

namespace thalweg {

namespace {

// A triangulation of n vertices has fewer than 2 n triangles, whose sides are told by 32 bits, four each.
constexpr std::size_t kMostPoints = std::numeric_limits<std::uint32_t>::max() / 8;

}  // namespace

void check_room(const SurveyPoints& points, std::size_t more) {
  if (points.xy.size() + more <= kMostPoints) return;
  throw Error(ErrorCode::SizeLimit, "the sources hold more than " + std::to_string(kMostPoints) +
                                        " points; read them in parts (--bbox) or thin them out");
}

void expect_points(ReadContext& run, double more) {
  SurveyPoints& points = run.result.survey.points;
  const ReadOptions& options = run.options;
  const bool all_stay =
      !options.bbox && options.where.empty() && options.classes.empty() && options.returns == LasReturns::All;
  // Far below what a size can hold: a header may say anything.
  if (options.admit && all_stay) {
    options.admit(points.xy.size() + static_cast<std::size_t>(std::min(more, 1e15)));
  }
  // A guess shall not fail for want of memory that is not needed in the end.
  constexpr double kMostExpected = 1U << 26U;
  const std::size_t room = points.xy.size() + static_cast<std::size_t>(std::min(more, kMostExpected));
  if (room <= points.xy.capacity()) return;
  // At least doubled, so that many small sources do not copy the points before them each time.
  points.xy.reserve(std::max(room, 2 * points.xy.capacity()));
  points.z.reserve(std::max(room, 2 * points.z.capacity()));
}

void PointCollector::flush() {
  run_.progress.check();
  const std::span xy(xy_.data(), pending_);
  const std::span z(z_.data(), pending_);
  if (!transform_.identity()) transform_.apply(xy, z);
  SurveyPoints& points = run_.result.survey.points;
  check_room(points, pending_);
  run_.result.points_read += pending_;
  const std::optional<Box2>& box = run_.options.bbox;
  if (box) {
    for (std::size_t i = 0; i < pending_; ++i) {
      run_.extent.add(xy[i]);
      if (!box->contains(xy[i])) {
        ++run_.result.outside_bbox;
        continue;
      }
      points.xy.push_back(xy[i]);
      points.z.push_back(z[i]);
    }
  } else {
    points.xy.insert(points.xy.end(), xy.begin(), xy.end());
    points.z.insert(points.z.end(), z.begin(), z.end());
  }
  pending_ = 0;
  if (run_.options.admit) run_.options.admit(points.xy.size());
}

}  // namespace thalweg
