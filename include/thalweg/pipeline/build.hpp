#pragma once

/// One run of the main job: sources in, optimised TIN, report and picture out.

#include <thalweg/base/progress.hpp>
#include <thalweg/delaunay/ground.hpp>
#include <thalweg/io/crs.hpp>
#include <thalweg/io/source.hpp>
#include <thalweg/mesh/tin.hpp>
#include <thalweg/optimize/optimize.hpp>
#include <thalweg/optimize/pit_heuristics.hpp>
#include <thalweg/order/definition.hpp>
#include <thalweg/pipeline/condition.hpp>
#include <thalweg/pipeline/report.hpp>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace thalweg {

/// Where results go. Every file is written aside and renamed when all of them are whole.
struct OutputConfig {
  std::string path;                           ///< the TIN
  std::string format;                         ///< empty: by the path's extension
  std::vector<std::string> creation_options;  ///< K=V
  bool overwrite = false;
  std::string report_path;   ///< JSON report; empty: none ("-" is the caller's business)
  std::string picture_path;  ///< .png, .svg, .pdf; empty: none
  std::string problem_path;  ///< labelling problem, .cfn; empty: none
  std::string proof_path;    ///< proof of the criteria's bounds, for verify; empty: none
  std::string changes_path;  ///< layer of heights that conditioning changed, .gpkg; empty: none
  /// Told the report when all files are whole, before they get their names: what it throws leaves none.
  std::function<void(const Report&)> announce;
};

/// How the triangulation is chosen.
struct LabellingConfig {
  unsigned order = 1;  ///< largest order of a triangle
  /// After fewest pits the least sum of triangle orders, before the other criteria. Pre: local minima first.
  bool least_orders = false;
  OrderDefinition definition = OrderDefinition::SeesOpp;
  std::vector<Objective> criteria = {Criterion::LocalMinima, Criterion::NormalAngleSum};
  std::optional<std::uint64_t> effort;  ///< work limit, a count; none: the optimiser's own
  std::optional<SourceSpec> reference;  ///< what vertical-error is measured against: a DEM, or points

  /// How few pits are found; none: exactly. Pre: local minima first, order at least 1.
  std::optional<PitHeuristic> heuristic;

  /// Whether triangulations of faces are chosen, not diagonals of quadrilaterals: at orders above 1; at order
  /// 1 by heuristics, and where quadrilaterals overlap and are not all that can change.
  [[nodiscard]] bool by_faces() const {
    const bool overlap = definition == OrderDefinition::Sees3vtx || definition == OrderDefinition::EmptyQuad;
    return order > (overlap || heuristic ? 0U : 1U);
  }
};

struct BuildConfig {
  std::vector<SourceSpec> points;
  std::vector<LineSource> lines;
  ReadOptions read;
  GroundOptions ground;              ///< its `snap` is set from snap_m
  double snap_m = 0;                 ///< metres in the metric plane
  std::optional<double> max_edge_m;  ///< metres in the metric plane
  /// Simplification: largest vertical distance of the final TIN from any source point, metres (but where a
  /// line's height or another point's replaces it: those are conflicts), and a number of vertices; the first
  /// limit reached stops. No diagonal is taken that would break the bound.
  std::optional<double> max_error_m;
  std::optional<std::size_t> max_points;
  std::optional<std::size_t> memory_limit_bytes;  ///< refuse what needs more, by estimate
  LabellingConfig labelling;
  ConditionConfig condition;
  OutputConfig output;
};

/// A TIN that was built, under the ids of the outputs.
struct BuiltTin {
  Tin tin;                                  ///< in the plane of triangulation
  std::vector<Point2> written;              ///< per vertex, as written to files; empty: the plane's own
  CrsInfo crs;                              ///< of the written coordinates
  std::vector<std::uint8_t> vertex_source;  ///< per vertex: 0 point, 1 line vertex, 2 crossing
  std::vector<std::uint8_t> is_pit;
  std::vector<std::uint16_t> orders;  ///< per triangle
  Report report;
};

/// Runs the main job on the sources and on what is in memory, and writes nothing: `config.output` is not
/// looked at. Throws: Error with the code that fits; {OutOfMemory} before the work starts, by an estimate.
BuiltTin build_tin(const BuildConfig& config, const MemorySource& memory, Progress& progress);

/// Writes the TIN to `output.path`, the very bytes that `build` writes; of `output` its path, format,
/// creation options and `overwrite` count. Throws: Error; nothing is left behind then.
void write_built(const BuiltTin& built, const OutputConfig& output, Progress& progress);

/// Runs the main job and writes its outputs. Results do not depend on the number of threads.
/// Throws: Error with the code that fits; then no output is left behind.
Report build(const BuildConfig& config, Progress& progress);

struct OptimizeConfig {
  std::string input;
  LabellingConfig labelling;
  ConditionConfig condition;
  OutputConfig output;
};

/// The same optimisation on the vertices, constraint edges and outline of a TIN file.
/// An edge of the outline that is no edge of the constrained Delaunay triangulation becomes a constraint
/// edge.
Report optimize_tin(const OptimizeConfig& config, Progress& progress);
/// The same, with the TIN; without an output path nothing is written.
BuiltTin optimized_tin(const OptimizeConfig& config, Progress& progress);

}  // namespace thalweg
