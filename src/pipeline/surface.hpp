#pragma once

/// The second half of every run: from the constrained Delaunay ground to the optimised TIN and its files.

#include "pipeline/plane.hpp"

#include <thalweg/io/pending_outputs.hpp>
#include <thalweg/mesh/survey.hpp>
#include <thalweg/mesh/tin.hpp>
#include <thalweg/order/quadrilaterals.hpp>
#include <thalweg/pipeline/build.hpp>
#include <thalweg/terrain/pits.hpp>
#include <thalweg/terrain/source_error.hpp>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <vector>

namespace thalweg {

/// Seconds since the last call of `lap`, or since construction.
class Stopwatch {
 public:
  double lap();
  [[nodiscard]] double total() const;

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
  Clock::time_point last_ = start_;
};

/// The files of a run: paths are reserved before the work starts, so that a missing folder or an existing
/// output is said at once, and renamed together when all are whole.
struct RunOutputs {
  RunOutputs(const OutputConfig& config, const std::vector<std::string>& sources);

  PendingOutputs pending;
  std::string report, picture, problem, proof;  ///< temporary paths; empty where none was asked for
};

/// The ground and what of it is surface. Vertex ids serve the work: neighbours are close in memory.
struct Terrain {
  Tin ground;
  GroundMode mode = GroundMode::Hull;
  std::vector<bool> keep;                   ///< per triangle of the ground: part of the surface
  std::vector<Point2> written;              ///< per vertex, as written to files; empty: the plane's own
  std::vector<Point2> continuous;           ///< the same without a jump at the antimeridian, to check them
  std::vector<std::uint8_t> vertex_source;  ///< per vertex: 0 point, 1 line vertex, 2 crossing
  std::vector<VertexId> number;             ///< per vertex its id in the outputs; empty: the same
  LeftOutPoints left_out;                   ///< of a simplified terrain, in triangles of the ground
  double error_limit = 0;                   ///< no diagonal may leave one farther off; units of height

  /// Whether all triangles are part of the surface. Complexity: linear.
  [[nodiscard]] bool whole() const { return std::find(keep.begin(), keep.end(), false) == keep.end(); }
};

/// What a run works with from the ground on.
struct RunContext {
  const Plane& plane;
  const CrsInfo& crs;
  const LabellingConfig& labelling;
  const ConditionConfig& condition;
  const OutputConfig& output;
  RunOutputs& outputs;
  Stopwatch& watch;
  std::vector<Point2> outlets;  ///< of conditioning, as written
  Survey drawn_valleys;         ///< those to be made monotone, in the plane, where they are known
};

/// Finds the quadrilaterals, optimises, checks, writes all outputs, and fills the rest of what is built; its
/// report has been begun. Throws: Error; nothing is left behind then.
void finish_run(Terrain terrain, const RunContext& run, BuiltTin& built, Progress& progress);

/// Writes the TIN aside. Throws: as write_tin.
void write_tin_of(const BuiltTin& built, const OutputConfig& output, PendingOutputs& pending,
                  Progress& progress);

/// Counts that the report, `info` and the demo share.
ReportTin describe_tin(const Tin& tin, const Plane& plane, std::span<const Point2> written);
ReportCrs describe_plane(const Plane& plane, const CrsInfo& crs);
ReportPits describe_pits(const PitSummary& pits);
/// Notes in the report what is taken for granted where the CRS does not tell.
void note_assumptions(const CrsInfo& crs, std::span<const Point2> written, Report& report);

}  // namespace thalweg
