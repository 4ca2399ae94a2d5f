// Reading sources into one survey.
//
// 1. All sources are opened, so that what is missing is known before the first long read.
// 2. The frame of the survey is the target CRS, else the first CRS that a source declares. Sources without
//    CRS are taken to be in that first one.
// 3. Each source is read through its transform into the survey, points first.
// 4. Options that no source could use are errors; so are an empty survey and degrees out of range.
// 5. Heights are brought from the ellipsoid to a geoid or back, where that is asked for.
#include "io/gdal_session.hpp"
#include "io/geoid_heights.hpp"
#include "io/memory_source.hpp"
#include "io/source_reader.hpp"
#include "io/spatial_reference.hpp"

#include <thalweg/base/error.hpp>
#include <thalweg/io/source.hpp>

#include <algorithm>
#include <cmath>
#include <new>
#include <span>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace thalweg {

namespace {

std::string in_digits(Point2 p) {
  std::ostringstream text;
  text.precision(12);
  text << p.x << ", " << p.y;
  return text.str();
}

std::string in_digits(const Box2& box) {
  return in_digits(Point2{box.x_min, box.y_min}) + ", " + in_digits(Point2{box.x_max, box.y_max});
}

void check_options(const ReadOptions& options) {
  if (!options.target_crs.empty() && !options.assigned_crs.empty()) {
    throw Error(ErrorCode::Usage,
                "a CRS can be transformed to or assigned, not both: give --t-crs or --a-crs; what the "
                "sources are in is --s-crs");
  }
  if (options.coords) {
    for (const std::string& crs : {options.source_crs, options.assigned_crs}) {
      if (crs.empty() || describe_crs(crs).geographic) continue;
      throw Error(ErrorCode::Usage, "--coords gives longitudes and latitudes, and " + crs +
                                        " is no geographic CRS; transform to it with --t-crs");
    }
  }
  if (!options.bbox) return;
  const Box2& box = *options.bbox;
  const bool finite =
      is_usable(box.x_min) && is_usable(box.y_min) && is_usable(box.x_max) && is_usable(box.y_max);
  if (!finite || box.x_min > box.x_max || box.y_min > box.y_max) {
    throw Error(ErrorCode::Usage, "the box " + in_digits(box) + " is not of the form xmin,ymin,xmax,ymax");
  }
}

class SurveyReading {
 public:
  SurveyReading(const ReadOptions& options, Progress& progress)
      : run_{.options = options, .progress = progress} {}

  void open(std::span<const SourceSpec> points, std::span<const LineSource> lines,
            const MemorySource& memory) {
    if (!memory.xy.empty() || !memory.z.empty()) readers_.push_back(open_memory_points(memory));
    for (const SourceSpec& spec : points) readers_.push_back(open_points(spec, run_.options, run_.progress));
    point_sources_ = readers_.size();
    if (!memory.lines.empty()) readers_.push_back(open_memory_lines(memory));
    for (const LineSource& source : lines) readers_.push_back(thalweg::open_lines(source));
    run_.sources = readers_.size();
    for (const auto& reader : readers_) sources_.push_back(reader->name());
    take_warnings("opening");
  }

  void choose_frames() {
    const ReadOptions& options = run_.options;
    const OGRSpatialReference given =
        options.source_crs.empty() ? OGRSpatialReference() : parse_reference(options.source_crs);
    for (const auto& reader : readers_) {
      frames_.push_back(frame_of(*reader, given));
      note_other(reader->name() + " declares", reader->reference(), options.source_crs, "--s-crs");
    }
    const auto known = std::find_if(frames_.begin(), frames_.end(),
                                    [](const Frame& frame) { return !frame.reference.IsEmpty(); });
    if (known != frames_.end()) {
      adopt_unknown(*known);
      survey_ = *known;
    } else if (!frames_.empty()) {
      survey_ = frames_.front();
    }
    if (!options.target_crs.empty()) {
      if (known == frames_.end()) {
        throw Error(ErrorCode::BadCrs, "nothing can be transformed to " + options.target_crs +
                                           ", because no source declares its CRS; give --s-crs");
      }
      survey_.reference = parse_reference(options.target_crs);
      survey_.vertical_metres_per_unit =
          describe_reference(survey_.reference, options.target_crs).vertical_metres_per_unit;
    }
    note_other("the sources are in", survey_.reference, options.assigned_crs, "--a-crs");
    describe_survey();
  }

  void read() {
    for (std::size_t i = 0; i < readers_.size(); ++i) {
      SourceReader& reader = *readers_[i];
      run_.advance(0);
      PlaneTransform transform(frames_[i], survey_, reader.name());
      for (const std::string& note : transform.notes()) run_.note(note);
      Survey& survey = run_.result.survey;
      survey.sources.push_back({reader.spec().path, reader.spec().layer});
      const std::size_t points_before = survey.points.xy.size();
      reader.read(run_, transform);
      if (survey.points.xy.size() > points_before) {
        survey.points.runs.push_back({points_before, static_cast<std::uint32_t>(i)});
      } else if (i < point_sources_) {
        run_.note("no points of " + reader.name() + " are left");
      }
      take_warnings(reader.name());
      readers_[i].reset();
      ++run_.sources_done;
    }
  }

  ReadResult finish() {
    settle(run_.where, run_.options.where, ErrorCode::Usage, "the condition");
    settle(run_.z_field, run_.options.z_field, ErrorCode::MissingHeight, "the field with heights of points,");
    settle(run_.line_z_field, run_.options.line_z_field, ErrorCode::MissingHeight,
           "the field with heights of lines,");
    if (!run_.options.classes.empty() || run_.options.returns != LasReturns::All)
      settle(run_.las_filter, "(--classes, --returns)", ErrorCode::Usage, "the filter of LAS points");
    if (run_.options.coords)
      settle(run_.coords, "--coords", ErrorCode::Usage, "the form of positions in text,");
    if (run_.options.nodata != NodataMode::BridgeHoles && !run_.nodata.taken)
      throw Error(ErrorCode::Usage, "--nodata is about rasters, and no source is one; leave it out");
    settle(run_.kind_field, run_.options.kind_field, ErrorCode::Usage, "the field with kinds of lines,");
    check_not_empty();
    check_degrees();
    if (!run_.options.geoid.empty()) apply_geoid(survey_, run_);
    if (run_.has_outside) run_.result.nodata = NodataRegion(std::move(run_.grids));
    run_.progress.advance(1);
    return std::move(run_.result);
  }

 private:
  Frame frame_of(const SourceReader& reader, const OGRSpatialReference& given) const {
    if (given.IsEmpty() && run_.options.assigned_crs.empty() && reader.unresolved_crs()) {
      throw Error(ErrorCode::BadCrs,
                  reader.name() + " declares a CRS that cannot be resolved" + *reader.unresolved_crs() +
                      "; say with --s-crs (or --a-crs) what it is in, or mend the file (ogr2ogr -a_srs)");
    }
    Frame frame;
    frame.reference = given.IsEmpty() ? reader.reference() : given;
    const CrsInfo info = describe_reference(frame.reference, reader.name());
    frame.vertical_unit_told = info.vertical_unit_told || reader.vertical_metres_per_unit().has_value();
    frame.vertical_metres_per_unit =
        info.vertical_unit_told ? info.vertical_metres_per_unit
                                : reader.vertical_metres_per_unit().value_or(info.vertical_metres_per_unit);
    return frame;
  }

  /// What an option puts in place of a CRS that is known.
  void note_other(const std::string& who, const OGRSpatialReference& declared, const std::string& given,
                  const char* option) {
    if (given.empty() || declared.IsEmpty()) return;
    const OGRSpatialReference other = parse_reference(given);
    if (means_same_crs(declared, other)) return;
    run_.note(who + " " + declared.GetName() + "; " + option + " puts " + other.GetName() + " in its place");
  }

  void adopt_unknown(const Frame& known) {
    for (std::size_t i = 0; i < frames_.size(); ++i) {
      if (!frames_[i].reference.IsEmpty()) continue;
      frames_[i].reference = known.reference;
      if (!frames_[i].vertical_unit_told)
        frames_[i].vertical_metres_per_unit = known.vertical_metres_per_unit;
      run_.note(readers_[i]->name() + " declares no CRS; it is taken to be in " + known.reference.GetName());
    }
  }

  void describe_survey() {
    const std::string& assigned = run_.options.assigned_crs;
    CrsInfo& crs = run_.result.crs;
    crs = assigned.empty() ? describe_reference(survey_.reference, "the survey") : describe_crs(assigned);
    if (!crs.vertical_unit_told && survey_.vertical_unit_told && run_.options.target_crs.empty()) {
      tell_vertical_unit(crs);
    }
    if (crs.vertical_unit_told || crs.vertical_metres_per_unit == 1) return;
    std::ostringstream metres;
    metres.precision(12);
    metres << crs.vertical_metres_per_unit;
    run_.note("the CRS " + crs.name +
              " does not tell the unit of heights; it is taken to be the horizontal one, " + metres.str() +
              " m (another: give a compound CRS, as EPSG:2994+5703)");
  }

  /// The unit of heights that a source tells, but the CRS does not, becomes a part of that, so that outputs
  /// tell it too. Where the CRS is unknown or local, heights are brought to its unit.
  void tell_vertical_unit(CrsInfo& crs) {
    const double unit = survey_.vertical_metres_per_unit;
    std::optional<OGRSpatialReference> compound;
    const bool differs = !is_same_unit(unit, crs.vertical_metres_per_unit);
    if (crs.known && differs) compound = with_heights_in(parse_reference(crs.wkt), unit);
    if (compound) {
      crs = describe_reference(*compound, "the survey");
    } else {
      survey_.vertical_metres_per_unit = crs.vertical_metres_per_unit;
    }
    crs.vertical_unit_told = true;
  }

  void take_warnings(const std::string& name) {
    for (const std::string& warning : session_.take_warnings()) run_.note(name + ": " + warning);
  }

  void settle(const OptionUse& use, const std::string& value, ErrorCode code, const std::string& what) {
    if (value.empty()) return;
    if (!use.taken) {
      throw Error(code, use.refusals.empty() ? what + " " + value + " fits no source" : use.refusals.front());
    }
    for (const std::string& refusal : use.refusals) run_.note(refusal + "; it is read without");
  }

  void check_not_empty() const {
    const ReadResult& result = run_.result;
    if (point_sources_ == 0 || !result.survey.points.xy.empty()) return;
    std::string reason;
    if (result.nodata_skipped > 0)
      reason += "; " + std::to_string(result.nodata_skipped) + " cells hold no data";
    if (run_.options.bbox) {
      reason += "; the box is " + in_digits(*run_.options.bbox);
      if (!run_.extent.empty()) reason += ", the points lie in " + in_digits(run_.extent);
    }
    if (!run_.options.where.empty()) reason += "; the condition is " + run_.options.where;
    throw Error(ErrorCode::EmptyInput, "no points are left of " + sources_[0] +
                                           (point_sources_ > 1 ? " and the other sources" : "") + reason);
  }

  void check_degrees() const {
    const CrsInfo& crs = run_.result.crs;
    if (!crs.geographic) return;
    const Survey& survey = run_.result.survey;
    const std::vector<SurveyPoints::Run>& runs = survey.points.runs;
    for (std::size_t i = 0; i < runs.size(); ++i) {
      const std::size_t end = i + 1 < runs.size() ? runs[i + 1].first : survey.points.xy.size();
      check_degrees(std::span(survey.points.xy).subspan(runs[i].first, end - runs[i].first), runs[i].source);
    }
    for (const SurveyLine& line : survey.lines) check_degrees(line.xy, line.source);
  }

  void check_degrees(std::span<const Point2> points, std::uint32_t source) const {
    const CrsInfo& crs = run_.result.crs;
    const double quarter = 90 / crs.degrees_per_unit;
    for (const Point2 p : points) {
      if (std::abs(p.y) <= quarter && std::abs(p.x) <= 4 * quarter) continue;
      const bool swapped = std::abs(p.x) <= quarter && std::abs(p.y) <= 4 * quarter;
      throw Error(ErrorCode::BadCoordinate,
                  sources_[source] + ": (" + in_digits(p) +
                      ") is no longitude and latitude, but the CRS is " + crs.name +
                      (swapped ? "; are x and y swapped?" : "; give the right one with --s-crs or --a-crs"));
    }
  }

  GdalSession session_;
  ReadContext run_;
  std::vector<std::unique_ptr<SourceReader>> readers_;
  std::vector<Frame> frames_;
  std::vector<std::string> sources_;
  Frame survey_;
  std::size_t point_sources_ = 0;
};

}  // namespace

ReadResult read_survey(std::span<const SourceSpec> points, std::span<const LineSource> lines,
                       const ReadOptions& options, Progress& progress, const MemorySource& memory) {
  check_options(options);
  progress.start_phase("read");
  try {
    SurveyReading reading(options, progress);
    reading.open(points, lines, memory);
    reading.choose_frames();
    reading.read();
    return reading.finish();
  } catch (const std::bad_alloc&) {
    throw Error(ErrorCode::OutOfMemory,
                "the memory does not suffice for the sources; read them in parts (--bbox) or thin them out");
  }
}

}  // namespace thalweg
