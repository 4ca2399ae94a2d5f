// Points on lines become vertices of them.
//
// 1. A tree of all segments; each point and each line vertex asks it for the segments whose boxes it is in,
//    and an exact predicate says which ones it lies on.
// 2. The hits of a segment, sorted along it (by x and y, which grow or fall monotonically along a segment)
// and
//    without repetition, are inserted into its line.
#include "box_tree.hpp"

#include <thalweg/delaunay/split_lines.hpp>
#include <thalweg/delaunay/surface.hpp>
#include <thalweg/geometry/predicates.hpp>

#include <base/parallel.hpp>

#include <tuple>

namespace thalweg {

namespace {

constexpr std::size_t kBlock = 1 << 12;

struct Hit {
  std::uint32_t segment = 0;
  Point2 xy;
  auto operator<=>(const Hit&) const = default;
};

// The segments of a line are numbered from first_segment[line] on, one a vertex but the last.
struct Segments {
  std::vector<Segment> all;
  std::vector<std::size_t> first_of_line;
};

Segments collect_segments(const Survey& survey) {
  Segments segments;
  for (const SurveyLine& line : survey.lines) {
    segments.first_of_line.push_back(segments.all.size());
    for (std::size_t i = 0; i + 1 < line.xy.size(); ++i) {
      segments.all.push_back({line.xy[i], line.xy[i + 1]});
    }
  }
  return segments;
}

std::vector<Hit> find_hits(const Survey& survey, std::span<const Segment> segments,
                           const Progress& progress) {
  const BoxTree tree = segment_tree(segments, progress);
  std::vector<Point2> candidates = survey.points.xy;
  for (const SurveyLine& line : survey.lines) {
    candidates.insert(candidates.end(), line.xy.begin(), line.xy.end());
  }
  std::vector<std::vector<Hit>> found((candidates.size() + kBlock - 1) / kBlock);
  for_each_block(candidates.size(), kBlock, progress, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Point2 p = candidates[i];
      tree.visit(box_around(p, 0), [&](std::uint32_t segment) {
        const auto& [a, b] = segments[segment];
        if (p != a && p != b && on_segment(a, b, p)) found[begin / kBlock].push_back({segment, p});
      });
    }
  });
  std::vector<Hit> hits;
  for (const auto& part : found) hits.insert(hits.end(), part.begin(), part.end());
  std::sort(hits.begin(), hits.end());
  hits.erase(std::unique(hits.begin(), hits.end()), hits.end());
  return hits;
}

// Pre: `hits` are those of the line, in order of (segment, x, y).
SurveyLine with_vertices(const SurveyLine& line, std::span<const Hit> hits, std::size_t first_segment) {
  SurveyLine split = line;
  split.xy.clear();
  split.z.clear();
  const bool hard = !line.z.empty();
  const auto append = [&](Point2 p, double z) {
    split.xy.push_back(p);
    if (hard) split.z.push_back(z);
  };
  for (std::size_t i = 0; i < line.xy.size(); ++i) {
    append(line.xy[i], hard ? line.z[i] : 0);
    std::size_t count = 0;
    while (count < hits.size() && hits[count].segment == first_segment + i) ++count;
    const auto append_hit = [&](const Hit& hit) {
      append(hit.xy,
             hard ? interpolate_on_segment(line.xy[i], line.z[i], line.xy[i + 1], line.z[i + 1], hit.xy) : 0);
    };
    const std::span<const Hit> here = hits.first(count);
    if (count > 0 && line.xy[i] < line.xy[i + 1]) {
      for (const Hit& hit : here) append_hit(hit);
    } else {
      for (std::size_t k = count; k-- > 0;) append_hit(here[k]);
    }
    hits = hits.subspan(count);
  }
  return split;
}

}  // namespace

std::size_t split_lines_at_points(Survey& survey, Progress& progress) {
  progress.start_phase("finding points on lines");
  const Segments segments = collect_segments(survey);
  const std::vector<Hit> hits = find_hits(survey, segments.all, progress);
  auto from = hits.begin();
  for (std::size_t l = 0; l < survey.lines.size() && from != hits.end(); ++l) {
    const std::size_t end_segment =
        l + 1 < survey.lines.size() ? segments.first_of_line[l + 1] : segments.all.size();
    const auto to =
        std::find_if(from, hits.end(), [&](const Hit& hit) { return hit.segment >= end_segment; });
    if (to != from) {
      survey.lines[l] = with_vertices(survey.lines[l], std::span(from, to), segments.first_of_line[l]);
    }
    from = to;
  }
  progress.advance(1);
  return hits.size();
}

}  // namespace thalweg
