#pragma once

/// What all readers of sources share: the source, its frame, and the run that reads it.

#include "io/plane_transform.hpp"

#include <thalweg/base/progress.hpp>
#include <thalweg/io/source.hpp>

#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace thalweg {

/// True for numbers that all later arithmetic can bear; not for NaN and infinities.
inline bool is_usable(double value) {
  constexpr double kLimit = 1e100;  // as the predicates ask
  return std::abs(value) < kLimit;
}

/// How the sources of a run took an option that not all of them need to have a use for.
struct OptionUse {
  bool taken = false;
  std::vector<std::string> refusals;  ///< "roads.gpkg|lines has no field \"class\""
};

/// One run of read_survey.
struct ReadContext {
  const ReadOptions& options;
  Progress& progress;
  ReadResult result;
  OptionUse where;
  OptionUse z_field;
  OptionUse line_z_field;
  OptionUse kind_field;
  OptionUse las_filter;
  OptionUse coords;
  OptionUse nodata;
  std::vector<std::shared_ptr<const NodataRegion::Grid>> grids;  ///< of all rasters
  bool has_outside = false;                                      ///< one of them has ground that is outside
  Box2 extent;  ///< with a box: of all points, in the plane of the survey
  std::size_t sources = 0;
  std::size_t sources_done = 0;

  /// Reports how much of the present source is done. Throws: Error{Cancelled}.
  void advance(double fraction) {
    progress.advance((static_cast<double>(sources_done) + fraction) / static_cast<double>(sources));
  }
  void note(std::string text) { result.notes.push_back(std::move(text)); }
};

/// An opened source, to be read once.
class SourceReader {
 public:
  explicit SourceReader(SourceSpec spec) : spec_(std::move(spec)) {}
  virtual ~SourceReader() = default;
  SourceReader(const SourceReader&) = delete;
  SourceReader& operator=(const SourceReader&) = delete;

  /// "file" or "file|layer", as messages name it.
  [[nodiscard]] std::string name() const {
    return spec_.layer.empty() ? spec_.path : spec_.path + "|" + spec_.layer;
  }
  [[nodiscard]] const SourceSpec& spec() const { return spec_; }
  /// The CRS that the source declares; empty if it declares none.
  [[nodiscard]] const OGRSpatialReference& reference() const { return reference_; }
  /// " (GDAL's words)" or "" if the source declares a CRS that cannot be resolved.
  [[nodiscard]] const std::optional<std::string>& unresolved_crs() const { return unresolved_crs_; }
  /// The unit of heights, where the source itself tells it apart from its CRS.
  [[nodiscard]] std::optional<double> vertical_metres_per_unit() const { return vertical_metres_per_unit_; }

  /// Adds what the source holds to the run's result.
  virtual void read(ReadContext& run, PlaneTransform& transform) = 0;

 protected:
  /// Counts a line that was read, and its vertices if it has two: else it is none, and false.
  static bool take_line(ReadContext& run, const SurveyLine& line) {
    ++run.result.breaklines_read;
    if (line.xy.size() < 2) return false;
    run.result.breakline_vertices += line.xy.size();
    return true;
  }
  void note_short_lines(ReadContext& run, std::size_t count) const {
    if (count == 0) return;
    run.note(name() + ": " + std::to_string(count) + " lines of fewer than two vertices were skipped");
  }
  void set_layer(const std::string& name) { spec_.layer = name; }
  void set_reference(const OGRSpatialReference& reference) { reference_ = reference; }
  void set_unresolved_crs(const std::string& reason) { unresolved_crs_ = reason; }
  void set_vertical_unit(double metres_per_unit) { vertical_metres_per_unit_ = metres_per_unit; }

 private:
  SourceSpec spec_;
  OGRSpatialReference reference_;
  std::optional<std::string> unresolved_crs_;
  std::optional<double> vertical_metres_per_unit_;
};

/// Opens a source of points, whatever it is. Throws: as read_survey.
std::unique_ptr<SourceReader> open_points(const SourceSpec& spec, const ReadOptions& options,
                                          const Progress& progress);
/// Opens a layer of lines or polygons. Throws: as read_survey.
std::unique_ptr<SourceReader> open_lines(const LineSource& source);

}  // namespace thalweg
