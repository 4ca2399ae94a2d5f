#pragma once

/// What was measured and drawn: points, lines and areas with their provenance, before anything is
/// triangulated.

#include <thalweg/geometry/point.hpp>
#include <thalweg/mesh/edge_kind.hpp>

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace thalweg {

/// One source that was read: a layer of a file.
struct SourceLayer {
  std::string file;   ///< path as the user gave it
  std::string layer;  ///< layer name, empty where the format has none
};

/// Elevation points in file order; parallel arrays.
struct SurveyPoints {
  std::vector<Point2> xy;
  std::vector<double> z;
  /// For each point the index of its source in Survey::sources; run-length: points from `first` on.
  struct Run {
    std::size_t first = 0;
    std::uint32_t source = 0;
  };
  std::vector<Run> runs;
};

/// One part of a line feature, or one ring of an area (then closed: the first vertex is repeated at the end).
struct SurveyLine {
  EdgeKind kind = EdgeKind::Breakline;
  std::vector<Point2> xy;
  std::vector<double> z;  ///< empty: a soft line, whose heights come from the surface; else as long as xy
  std::uint32_t source = 0;
  std::int64_t feature = 0;  ///< feature id in the layer
  std::uint32_t part = 0;    ///< part of a multi-geometry, ring of a polygon
};

/// One place where sources disagree about a height, and what was used.
struct Conflict {
  enum class Kind : std::uint8_t {
    DuplicatePoint,  ///< points with the same position
    PointOnLine,     ///< a point at a vertex or on an edge of a line with heights
    LineVertex,      ///< two lines share a vertex position
    Crossing,        ///< two lines cross, touch or overlap
    Lake,            ///< a point or a line in a lake, or a ring of it, that has not its level
  };
  Kind kind = Kind::DuplicatePoint;
  Point2 xy;
  double z_a = 0;
  double z_b = 0;
  double z_used = 0;
  std::string source_a;  ///< "file|layer feature 12 part 0 vertex 3", "file point 17", counted from 1
  std::string source_b;
};

/// The whole input of a TIN, all in one plane.
struct Survey {
  std::vector<SourceLayer> sources;
  SurveyPoints points;
  /// Ridges, valleys, breaklines, and rings of boundaries, holes and lakes, in the order they were given.
  std::vector<SurveyLine> lines;
  /// From the plane back to the coordinates of the sources, for messages; empty: they are the same.
  std::function<Point2(Point2)> to_source;
};

}  // namespace thalweg
