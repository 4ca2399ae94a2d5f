#pragma once

/// Reading points, lines and areas from files into one survey.

#include <thalweg/base/progress.hpp>
#include <thalweg/geodesy/position_text.hpp>
#include <thalweg/geometry/point.hpp>
#include <thalweg/io/crs.hpp>
#include <thalweg/io/nodata_region.hpp>
#include <thalweg/mesh/edge_kind.hpp>
#include <thalweg/mesh/survey.hpp>

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace thalweg {

/// A file (or GDAL virtual path, or database connection) and one of its layers; empty: the only one that
/// fits.
struct SourceSpec {
  std::string path;
  std::string layer;
};

/// Splits "PATH" or "PATH|layername=NAME". Throws: Error{Usage} if the path or the name is empty, or for the
/// other suffixes that QGIS writes (|layerid=, |subset=, |geometrytype=).
SourceSpec parse_source(std::string_view text);

/// Lines of one kind: ridges, valleys, breaklines; or, for the kinds Boundary, Hole and Lake, rings of areas.
struct LineSource {
  SourceSpec source;
  EdgeKind kind = EdgeKind::Breakline;
};

/// Points and lines that a caller holds in memory.
struct MemoryLine {
  EdgeKind kind = EdgeKind::Breakline;
  std::vector<Point2> xy;
  std::vector<double> z;  ///< empty: a soft line; else as long as xy
};
struct MemorySource {
  std::vector<Point2> xy;
  std::vector<double> z;  ///< as long as xy
  std::vector<MemoryLine> lines;
};

/// Whether points need a height.
enum class HeightRule {
  Required,  ///< a point without height is an error
  Optional   ///< it gets the height 0
};

/// Which returns of a pulse are points, in LAS files.
enum class LasReturns {
  All,
  First,
  Last  ///< of single returns, the one there is
};

/// What the heights of sources are above, where a geoid model brings them from one to the other.
enum class HeightsAbove {
  Ellipsoid,  ///< as GNSS measures them; they become heights above the geoid
  Geoid       ///< as maps have them; they become heights above the ellipsoid
};

/// How sources are read. An option that names a field, and `where`, apply to every source that has the field;
/// a source that has not is read without it, and a note says so; no source that has it: Error.
struct ReadOptions {
  std::string z_field;  ///< attribute or text column with the height of points; goes before the geometry's z
  std::string line_z_field;  ///< attribute with the one height of a line
  std::string
      kind_field;     ///< attribute that begins with "ridge" or "valley" (any case); else the source's kind
  std::string where;  ///< condition on attributes, in OGR's SQL
  /// In the plane of the survey. Points outside are left out. Lines stay whole if they meet the box, else
  /// they go; holes and lakes likewise by their area; boundaries always stay.
  std::optional<Box2> bbox;
  std::string source_crs;  ///< replaces the CRS that the sources declare
  std::string target_crs;  ///< CRS of the survey; default: that of the first source that has one
  std::string
      assigned_crs;  ///< CRS of the survey by declaration, nothing is transformed to it; excludes target_crs
  std::vector<unsigned> classes;  ///< LAS: classes that are points (2 is ground); empty: all
  LasReturns returns = LasReturns::All;
  /// How x and y of text are written, if not as plain numbers; they become longitude and latitude, of
  /// WGS 84 unless a .prj file or `source_crs` tells another geographic CRS.
  std::optional<PositionForm> coords;
  std::string geoid;  ///< model (egm2008-5) whose heights are taken off or added; empty: none
  HeightsAbove heights_above = HeightsAbove::Ellipsoid;  ///< before the geoid model comes to them
  NodataMode nodata = NodataMode::BridgeHoles;
  HeightRule heights = HeightRule::Required;
  /// Told now and then how many points there are, and before a source is read how many there will be (by its
  /// header, or the lengths of its first rows; not where a filter may leave few). Throws to refuse.
  std::function<void(std::size_t)> admit;
};

/// The survey, and what happened on the way to it.
struct ReadResult {
  Survey survey;
  CrsInfo crs;  ///< of the survey's coordinates and heights
  std::size_t points_read =
      0;  ///< points that the sources hold, after `where`; of a raster: points in the box
  std::size_t outside_bbox = 0;        ///< points outside of the box; of a raster: cells, valid or not
  std::size_t nodata_skipped = 0;      ///< raster cells without data, in the box
  std::size_t breaklines_read = 0;     ///< lines and rings that the sources hold, after `where`, in the box
  std::size_t breakline_vertices = 0;  ///< their vertices, the repeated one of a closed ring included
  std::size_t lines_outside_bbox = 0;  ///< lines and rings left out
  NodataRegion nodata;
  std::size_t nodata_holes = 0;    ///< regions without data that are bridged
  std::size_t bridged_cells = 0;   ///< their cells
  std::vector<std::string> notes;  ///< what a user should know, one sentence each
};

/// Reads all sources, in the order given, into one plane; those in memory come first.
///
/// Points: OGR layers of points and multipoints; text (.csv .tsv .txt .xyz .asc .dat, also with .gz:
/// separators , ; tab or blanks; # comments; columns by name, else the first three); rasters (a point a valid
/// cell centre, first band, from the top row down; x = x0 + (column + 0.5) dx, y = y0 + (row + 0.5) dy for a
/// raster that is not rotated); LAS 1.2 to 1.4, uncompressed (points marked as withheld are left out); meshes
/// that Thalweg wrote. Lines: OGR lines and polygons, curves as OGR linearises them; with z hard, without
/// soft. Empty geometries are skipped, with a note. Where a source's CRS differs from the survey's, its
/// coordinates are transformed, and its heights are brought to the survey's unit of heights. Sources without
/// CRS are taken to be in the survey's, with a note.
///
/// Throws: Error{NotFound}: no such file or layer; Error{Unreadable}: not openable, in GDAL's words;
/// Error{BadFormat}: broken content, naming row or feature; Error{EmptyInput}; Error{WrongGeometry};
/// Error{MissingHeight}; Error{BadCoordinate}; Error{BadCrs}; Error{Usage}; Error{Unsupported};
/// Error{SizeLimit}; Error{Cancelled}. Complexity: linear; text is read in blocks and never held whole.
ReadResult read_survey(std::span<const SourceSpec> points, std::span<const LineSource> lines,
                       const ReadOptions& options, Progress& progress, const MemorySource& memory = {});

}  // namespace thalweg
