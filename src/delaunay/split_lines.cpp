// A tree of all segments; each point and each line vertex asks it for those that come near.
//
// In the plane the curve that a line is in its source's coordinates lies beside the chord that stands for it.
// A point between them is on one side of the line as written and on the other as triangulated, so a triangle
// of the two would be turned over as written. A vertex at the point's foot on the curve brings the chord
// there.
#include "box_tree.hpp"
#include "heights.hpp"
#include "noding.hpp"

#include <thalweg/delaunay/split_lines.hpp>
#include <thalweg/geometry/predicates.hpp>

#include <base/parallel.hpp>
#include <mesh/line_vertices.hpp>
#include <mesh/straight_piece.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace thalweg {

namespace {

double squared_distance(Point2 p, Point2 q) {
  return (p.x - q.x) * (p.x - q.x) + (p.y - q.y) * (p.y - q.y);
}

// The lines' vertices to come: `consider(segment, along, i, found)` is asked of each candidate i that is
// beside a segment and within the margin of its box, but not within a pixel of an end: these become one.
template <class Consider>
std::vector<LineVertex> find_vertices(std::span<const LineSegment> segments,
                                      std::span<const Point2> candidates, double margin, double pixel,
                                      const Progress& progress, const Consider& consider) {
  constexpr std::size_t kBlock = 1 << 12;
  std::vector<Segment> ends;
  ends.reserve(segments.size());
  for (const LineSegment& segment : segments) ends.push_back({segment.low, segment.high});
  const BoxTree tree = segment_tree(ends, progress);
  std::vector<std::vector<LineVertex>> found((candidates.size() + kBlock - 1) / kBlock);
  for_each_block(candidates.size(), kBlock, progress, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Point2 p = candidates[i];
      tree.visit(box_around(p, margin), [&](std::uint32_t s) {
        const double to_low = squared_distance(segments[s].low, p);
        const double to_high = squared_distance(segments[s].high, p);
        if (std::min(to_low, to_high) <= pixel * pixel) return;
        const double along = part_along(segments[s], p);
        if (along > 0 && along < 1) consider(s, along, i, found[begin / kBlock]);
      });
    }
  });
  std::vector<LineVertex> all;
  for (const auto& part : found) all.insert(all.end(), part.begin(), part.end());
  return all;
}

// A segment of the plane as its source has it.
StraightPiece written_piece(const LineSegment& segment, std::span<const std::vector<Point2>> written,
                            double x_period) {
  const std::vector<Point2>& line = written[segment.line];
  return {line[segment.low_vertex()], line[segment.high_vertex()], x_period};
}

// The side of p, in the turn in which the piece is.
int written_side(const StraightPiece& piece, Point2 p, double x_period) {
  if (x_period > 0) p.x -= x_period * std::round((p.x - piece.low().x) / x_period);
  return orientation(piece.low(), piece.high(), p);
}

// A vertex at position `i` (of all, points first). On a hard line it has the height of the point itself, if
// the two agree.
LineVertex vertex_at(const Survey& survey, std::span<const LineSegment> segments, std::uint32_t s,
                     double along, Point2 p, std::size_t i, double pixel) {
  const LineSegment& segment = segments[s];
  const bool of_point = i < survey.points.xy.size();
  LineVertex vertex{s, along, p, {}, of_point, height_on(survey, segment, along)};
  if (i >= survey.points.z.size() || survey.lines[segment.line].z.empty()) return vertex;
  const double slack = height_slack(segment.low, height_on(survey, segment, 0), segment.high,
                                    height_on(survey, segment, 1), pixel);
  if (std::abs(survey.points.z[i] - vertex.z) <= slack) vertex.z = survey.points.z[i];
  return vertex;
}

// The place on the curve that is beside p, by steps that each take off most of what is missing.
LineVertex foot_of(const LineSegment& segment, const StraightPiece& piece, Point2 p,
                   const std::function<Point2(Point2)>& to_plane) {
  const double beside = part_along(segment, p);
  double along = beside;
  LineVertex foot;
  for (int step = 0; step < 3; ++step) {
    foot = {0, along, to_plane(piece.at(along)), piece.at(along), false, 0};
    along += beside - part_along(segment, foot.xy);
  }
  return foot;
}

}  // namespace

std::size_t split_lines_at_points(Survey& survey, double x_period, Progress& progress) {
  progress.start_phase("finding points on lines");
  const std::vector<LineSegment> segments = line_segments(survey);
  const std::vector<Point2> candidates = positions_of(survey);
  const double pixel = snapping_pixel(candidates, 0);
  const auto consider = [&](std::uint32_t s, double along, std::size_t i, std::vector<LineVertex>& found) {
    const auto& [line, vertex, a, b, reversed] = segments[s];
    if (x_period > 0 && b.x - a.x > x_period / 2) return;
    const Point2 foot = {std::lerp(a.x, b.x, along), std::lerp(a.y, b.y, along)};
    if (squared_distance(foot, candidates[i]) > pixel * pixel) return;
    found.push_back(vertex_at(survey, segments, s, along, candidates[i], i, pixel));
  };
  std::vector<LineVertex> vertices = find_vertices(segments, candidates, pixel, pixel, progress, consider);
  const std::size_t count = insert_line_vertices(survey, {}, segments, std::move(vertices), pixel);
  progress.advance(1);
  return count;
}

std::size_t split_lines_beside_points(Survey& survey, WrittenSurvey written,
                                      const std::function<Point2(Point2)>& to_plane,
                                      const DensifyOptions& options, double resolution, Progress& progress) {
  progress.start_phase("finding points beside lines");
  constexpr int kRounds = 8;  // a foot can leave another point on the wrong side where a line bends both ways
  std::size_t count = 0;
  for (int round = 0; round < kRounds; ++round) {
    const std::vector<LineSegment> segments = line_segments(survey);
    const std::vector<Point2> candidates = positions_of(survey);
    std::vector<Point2> sources(written.points.begin(), written.points.end());
    for (const auto& line : written.lines) sources.insert(sources.end(), line.begin(), line.end());
    const double pixel = snapping_pixel(candidates, resolution), reach = options.limit + pixel;
    const auto consider = [&](std::uint32_t s, double along, std::size_t i, std::vector<LineVertex>& found) {
      const auto& [line, vertex, a, b, reversed] = segments[s];
      const Point2 p = candidates[i], beside = {std::lerp(a.x, b.x, along), std::lerp(a.y, b.y, along)};
      if (squared_distance(beside, p) > reach * reach) return;
      const StraightPiece piece = written_piece(segments[s], written.lines, options.x_period);
      LineVertex foot = foot_of(segments[s], piece, p, to_plane);
      foot.segment = s;
      if (!(foot.along > 0 && foot.along < 1)) return;
      if (squared_distance(foot.xy, p) <= pixel * pixel) {
        found.push_back(vertex_at(survey, segments, s, foot.along, p, i, pixel));
        found.back().written = sources[i];
      } else if (orientation(a, b, p) * written_side(piece, sources[i], options.x_period) < 0) {
        foot.z = height_on(survey, segments[s], foot.along);
        found.push_back(foot);
      }
    };
    std::vector<LineVertex> vertices = find_vertices(segments, candidates, reach, pixel, progress, consider);
    if (vertices.empty()) break;
    count += insert_line_vertices(survey, written.lines, segments, std::move(vertices), pixel);
  }
  progress.advance(1);
  return count;
}

}  // namespace thalweg
