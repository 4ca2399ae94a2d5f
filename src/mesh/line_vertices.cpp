// Segments are taken from their lexicographically smaller end, so that a segment that is drawn twice, in
// either direction, gets the same vertices and heights.
#include "line_vertices.hpp"

#include "straight_piece.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace thalweg {

namespace {

/// A line in the making: what `line` has up to a vertex, and what comes between.
class LineBuilder {
 public:
  LineBuilder(const SurveyLine& line, const std::vector<Point2>* written) : line_(line), written_(written) {}
  void add_old_to(std::size_t end) {
    for (; next_ < end; ++next_) {
      xy_.push_back(line_.xy[next_]);
      if (!line_.z.empty()) z_.push_back(line_.z[next_]);
      if (written_ != nullptr) new_written_.push_back((*written_)[next_]);
    }
  }
  void add(const LineVertex& vertex) {
    xy_.push_back(vertex.xy);
    if (!line_.z.empty()) z_.push_back(vertex.z);
    if (written_ != nullptr) new_written_.push_back(vertex.written);
  }
  /// Ends the use of the builder.
  void move_to(SurveyLine& line, std::vector<Point2>* written) {
    add_old_to(line_.xy.size());
    line.xy = std::move(xy_);
    line.z = std::move(z_);
    if (written != nullptr) *written = std::move(new_written_);
  }

 private:
  const SurveyLine& line_;
  const std::vector<Point2>* written_;
  std::size_t next_ = 0;
  std::vector<Point2> xy_, new_written_;
  std::vector<double> z_;
};

std::vector<LineVertex> one_a_place(std::vector<LineVertex> vertices, double apart) {
  std::sort(vertices.begin(), vertices.end());
  std::vector<LineVertex> kept;
  for (const LineVertex& vertex : vertices) {
    const bool beside = !kept.empty() && kept.back().segment == vertex.segment;
    const LineVertex last = beside ? kept.back() : LineVertex();
    const bool near = beside && std::hypot(last.xy.x - vertex.xy.x, last.xy.y - vertex.xy.y) <= apart;
    const bool two_points = last.of_point && vertex.of_point && last.xy != vertex.xy;
    if (!near || two_points) {
      kept.push_back(vertex);
    } else if (vertex.of_point && !last.of_point) {
      kept.back() = vertex;
    }
  }
  return kept;
}

}  // namespace

std::vector<Point2> positions_of(const Survey& survey) {
  std::vector<Point2> all(survey.points.xy);
  for (const SurveyLine& line : survey.lines) all.insert(all.end(), line.xy.begin(), line.xy.end());
  return all;
}

std::vector<LineSegment> line_segments(const Survey& survey) {
  std::vector<LineSegment> segments;
  for (std::uint32_t l = 0; l < survey.lines.size(); ++l) {
    const std::vector<Point2>& xy = survey.lines[l].xy;
    for (std::uint32_t i = 0; i + 1 < xy.size(); ++i) {
      if (xy[i] == xy[i + 1]) continue;
      const auto [low, high] = std::minmax(xy[i], xy[i + 1]);
      segments.push_back({l, i, low, high, xy[i + 1] < xy[i]});
    }
  }
  return segments;
}

double height_on(const Survey& survey, const LineSegment& segment, double along) {
  const std::vector<double>& z = survey.lines[segment.line].z;
  if (z.empty()) return 0;
  return height_between(z[segment.low_vertex()], z[segment.high_vertex()], along);
}

std::size_t insert_line_vertices(Survey& survey, std::span<std::vector<Point2>> written_lines,
                                 std::span<const LineSegment> segments, std::vector<LineVertex> vertices,
                                 double apart) {
  vertices = one_a_place(std::move(vertices), apart);
  for (std::size_t i = 0; i < vertices.size();) {
    const std::uint32_t l = segments[vertices[i].segment].line;
    SurveyLine& line = survey.lines[l];
    std::vector<Point2>* const written = written_lines.empty() ? nullptr : &written_lines[l];
    LineBuilder builder(line, written);
    while (i < vertices.size() && segments[vertices[i].segment].line == l) {
      const LineSegment& segment = segments[vertices[i].segment];
      std::size_t end = i;
      while (end < vertices.size() && vertices[end].segment == vertices[i].segment) ++end;
      builder.add_old_to(segment.vertex + 1);
      for (std::size_t k = 0; k < end - i; ++k) {
        const LineVertex& vertex = vertices[segment.reversed ? end - 1 - k : i + k];
        builder.add(vertex);
      }
      i = end;
    }
    builder.move_to(line, written);
  }
  return vertices.size();
}

}  // namespace thalweg
