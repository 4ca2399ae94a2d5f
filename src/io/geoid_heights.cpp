// Geoid heights are those at longitude and latitude on WGS 84, whatever the survey's CRS.
#include "io/geoid_heights.hpp"

#include "io/spatial_reference.hpp"

#include <thalweg/base/error.hpp>
#include <thalweg/geodesy/geoid.hpp>

#include <algorithm>
#include <iomanip>
#include <sstream>

namespace thalweg {

namespace {

class GeoidShift {
 public:
  GeoidShift(const ReadContext& run, const Frame& frame)
      : geoid_(run.options.geoid),
        to_lonlat_(frame, {.reference = parse_reference("EPSG:4326"), .vertical_metres_per_unit = 1},
                   "the survey"),
        sign_(run.options.heights_above == HeightsAbove::Ellipsoid ? -1 : 1),
        metres_per_unit_(run.result.crs.vertical_metres_per_unit) {}

  void apply(std::vector<Point2> xy, std::span<double> z) {
    if (z.empty()) return;
    to_lonlat_.apply(xy, {});
    const Geoid::Range range = geoid_.add_to(z, xy, sign_, metres_per_unit_);
    range_ = first_ ? range
                    : Geoid::Range{std::min(range.min_m, range_.min_m), std::max(range.max_m, range_.max_m)};
    first_ = false;
  }
  [[nodiscard]] Geoid::Range range() const { return range_; }

 private:
  Geoid geoid_;
  PlaneTransform to_lonlat_;
  double sign_;
  double metres_per_unit_;
  Geoid::Range range_;
  bool first_ = true;
};

void check_crs(const OGRSpatialReference& reference) {
  if (reference.IsEmpty()) {
    throw Error(ErrorCode::BadCrs,
                "--geoid needs to know where the sources lie; give their CRS with --s-crs or --a-crs");
  }
  if (reference.GetAxesCount() != 3) return;
  throw Error(ErrorCode::Usage, std::string("--geoid changes what heights are above, but the CRS ") +
                                    reference.GetName() +
                                    " fixes that; give the CRS without its heights (--s-crs or --a-crs)");
}

}  // namespace

void apply_geoid(const Frame& survey, ReadContext& run) {
  const ReadOptions& options = run.options;
  Frame frame = survey;
  if (!options.assigned_crs.empty()) frame.reference = parse_reference(options.assigned_crs);
  check_crs(frame.reference);
  GeoidShift shift(run, frame);
  Survey& read = run.result.survey;
  shift.apply(read.points.xy, read.points.z);
  for (SurveyLine& line : read.lines) shift.apply(line.xy, line.z);
  std::ostringstream note;
  note << std::fixed << std::setprecision(3) << "heights of the geoid " << options.geoid
       << " above the ellipsoid, " << shift.range().min_m << " to " << shift.range().max_m << " m, were "
       << (options.heights_above == HeightsAbove::Ellipsoid
               ? "taken off the heights, which are above the geoid now"
               : "added to the heights, which are above the ellipsoid now");
  run.note(note.str());
}

}  // namespace thalweg
