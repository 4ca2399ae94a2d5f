#pragma once

/// What a run tells about itself: the JSON report with fixed keys, and the same as a table for people.

#include <thalweg/mesh/survey.hpp>
#include <thalweg/pipeline/lengths_report.hpp>
#include <thalweg/pipeline/water_report.hpp>

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace thalweg {

/// Seconds of the phases of a run.
struct PhaseSeconds {
  double read = 0, triangulate = 0, simplify = 0;
  double orders = 0;
  double optimize = 0;
  double check = 0;  ///< the TIN's laws, pits and figures, by plain code
  double write = 0;
  double total = 0;
};

struct ReportInput {
  std::size_t points_read = 0;
  std::size_t points_used = 0;
  std::size_t duplicates_merged = 0;
  std::size_t outside_boundary = 0;
  std::size_t outside_bbox = 0;  ///< points; of a raster cells, valid or not
  std::size_t nodata_skipped = 0;
  std::size_t nodata_holes_bridged = 0;
  std::size_t nodata_cells_bridged = 0;
  std::size_t breaklines_read = 0;
  std::size_t breakline_vertices = 0;
  std::size_t lines_outside_bbox = 0;
  std::size_t crossings = 0;
  std::size_t lakes = 0;                       ///< bodies of water; lakes that touch are one
  std::size_t points_in_lakes = 0;             ///< points whose height gave way to a lake's level
  std::size_t vertices_inserted_on_lines = 0;  ///< points on a line or hardly beside it, densified pieces
  double snapping_pixel = 0;  ///< side of the snapping grid, units of the plane; 0 without lines
};

struct ReportCrs {
  std::string wkt;                ///< empty: unknown, planar metres are assumed
  std::string metric_projection;  ///< PROJ string of the plane of triangulation; empty: the CRS's own plane
  double horizontal_metres_per_unit = 1;
  double vertical_metres_per_unit = 1;
};

struct ReportTin {
  std::size_t vertices = 0;
  std::size_t triangles = 0;
  std::size_t edges = 0;
  std::size_t constraint_edges = 0;
  std::size_t hull_vertices = 0;
  std::size_t dropped_rim_triangles = 0;
  std::size_t vertices_left_out = 0;  ///< vertices that lost all triangles
  double area_m2 = 0;
  std::optional<double> area_geodesic_m2;         ///< geographic input only
  ReportLengths lengths;                          ///< in the plane
  std::optional<ReportLengths> lengths_geodesic;  ///< on the ellipsoid; geographic input only
  double min_angle_deg = 0;
  /// Triangles by their smallest angle, six bins of 10 degrees.
  std::array<std::size_t, 6> angle_histogram{};
  std::array<std::size_t, 6> angle_histogram_delaunay{};
  std::size_t flat_triangles = 0;
  unsigned max_order = 0;
};

struct ReportFirstOrder {
  std::string definition;
  std::size_t quadrilaterals = 0;
  std::size_t flipped = 0;
  std::size_t fixed_by_elimination = 0;
  std::size_t pieces = 0;
  std::size_t largest_piece = 0;
  std::size_t width = 0;
};

/// Of a run that chose triangulations of faces: above order 1, and where quadrilaterals overlap.
struct ReportHigherOrder {
  std::string definition;
  unsigned order = 0;
  bool only_flips = false;        ///< chosen from: else all triangulations of the order
  std::size_t faces = 0;          ///< between fixed edges, those with a choice
  std::size_t partial_faces = 0;  ///< that take too much work: only some triangulations were chosen from
  std::size_t largest_face = 0;   ///< triangles
  std::size_t labels = 0;         ///< triangulations of all faces, those that look alike from outside once
  std::size_t most_labels = 0;    ///< of one face
  std::size_t new_edges = 0;      ///< of the result, that the Delaunay triangulation does not have
  std::vector<std::size_t> order_histogram;  ///< triangles of order 0, 1, ...
  std::size_t fixed_by_elimination = 0;      ///< faces, and variables that count pits
  std::size_t pieces = 0;
  std::size_t largest_piece = 0;
  std::size_t width = 0;  ///< the largest table has up to 2^width entries
};

struct ReportCriterion {
  std::string name, unit;
  std::string direction;  ///< "min" or "max"
  double delaunay = 0, result = 0, bound = 0;
  bool optimal = false;
  std::string method;
};

/// Of a run with --max-error or --max-points. Pairs: the Delaunay TIN, the result.
struct ReportSimplification {
  std::optional<double> max_error_m;
  std::optional<std::size_t> max_points;
  std::string stopped_by;             ///< "max-error", "max-points", "exact" (no error is left)
  std::size_t source_points = 0;      ///< vertices before
  std::size_t fixed_vertices = 0;     ///< vertices of lines and of the outline, which stay
  std::size_t inserted_vertices = 0;  ///< the others that the TIN has
  std::size_t barred_diagonals = 0;   ///< quadrilaterals that keep theirs for the error's sake
  std::array<double, 2> largest_error_m{}, rms_error_m{};  ///< rms: over all source points
};

struct Report {
  std::string command, engine;  ///< the engine is that which triangulated; see `engine_name`
  std::string digest;           ///< see `digest_of`
  ReportInput input;
  std::vector<Conflict> conflicts;
  ReportCrs crs;
  ReportTin tin;
  std::optional<ReportSimplification> simplification;
  ReportFirstOrder first_order;                   ///< of orders 0 and 1
  std::optional<ReportHigherOrder> higher_order;  ///< if triangulations of faces were chosen
  std::vector<ReportCriterion> criteria;
  ReportPits pits_delaunay;
  ReportPits pits_result;
  std::optional<ReportConsistency> consistency;
  std::optional<ReportConditioned> conditioned;  ///< if heights were to be changed
  PhaseSeconds timings_s;
  std::size_t peak_memory_bytes = 0;
  std::vector<std::string> notes;  ///< what was assumed or is worth knowing, one sentence each
};

/// The report as JSON, keys as documented, indented, ending in a newline.
std::string to_json(const Report& report);
/// The report as aligned tables for people.
std::string to_text(const Report& report);

/// Version of the library, "0.1.0".
std::string version();

}  // namespace thalweg
