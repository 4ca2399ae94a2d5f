#pragma once

/// What a TIN file is, a picture of it, and one of what changed.

#include <thalweg/base/progress.hpp>
#include <thalweg/geometry/point.hpp>
#include <thalweg/mesh/validate.hpp>
#include <thalweg/pipeline/report.hpp>
#include <thalweg/terrain/statistics.hpp>

#include <optional>
#include <string>
#include <vector>

namespace thalweg {

/// What the TIN is measured against.
struct VolumeConfig {
  std::optional<double> above;  ///< a level plane, in the TIN's unit of heights
  std::string between;          ///< another TIN file in the same CRS; empty: none
};

/// Where both surfaces are.
struct VolumeInfo {
  std::string reference;  ///< "height 12.5", or the path
  double above_m3 = 0;    ///< what the TIN has above the reference
  double below_m3 = 0;    ///< and below
  double area_above_m2 = 0;
  double area_below_m2 = 0;
  double area_m2 = 0;
};

struct TinInfo {
  std::string path;
  std::string crs_name;  ///< empty: unknown
  Box2 extent;           ///< of the written coordinates
  ReportTin tin;
  ReportPits pits;
  TinStatistics statistics;
  std::string digest;
  std::vector<VolumeInfo> volumes;
  std::vector<Violation> violations;  ///< empty: valid
  std::vector<std::string> notes;     ///< what reading it took otherwise than it stands there
};

/// Reads and measures a TIN file. Throws: Error{NotFound, BadFormat, InvalidTin, ...}; Error{BadCrs} if the
/// TIN to compare with has another CRS.
TinInfo inspect_tin(const std::string& path, Progress& progress, const VolumeConfig& volumes = {});
std::string to_json(const TinInfo& info);
std::string to_text(const TinInfo& info);

struct ViewConfig {
  std::string input;
  std::string output;  ///< .png, .svg, .pdf
  bool overwrite = false;
  int width_px = 1600;
};

/// Draws a TIN file. Throws: as inspect_tin, and Error{OutputExists, WriteFailed, Usage}.
void view_tin(const ViewConfig& config, Progress& progress);

struct CompareConfig {
  std::string before;  ///< the TIN of the left map
  std::string after;   ///< the TIN of the right map; the same vertices, to the last bit
  std::string output;  ///< .png, .svg, .pdf
  bool overwrite = false;
  int width_px = 2400;
};

/// Draws two TINs of the same vertices side by side: edges that changed, pits removed, left and new.
/// Throws: as view_tin, and Error{Usage} naming the first vertex that differs.
void view_comparison(const CompareConfig& config, Progress& progress);

}  // namespace thalweg
