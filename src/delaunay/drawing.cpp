// A survey's points and lines as one plan.
//
// 1. Keep the points and the vertices of the lines drawn; number them anew.
// 2. Node the pieces of the lines; append the crossings to the vertices.
// 3. List which lines pass through which vertices, at one of their own vertices or on an edge.
#include "drawing.hpp"

#include "provenance.hpp"

#include <thalweg/base/error.hpp>

#include <fmt/format.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <tuple>
#include <utility>

namespace thalweg {

namespace {

constexpr std::uint32_t kNone = VertexId::kInvalid;

// Only what is needed: all points, and the vertices of the given lines.
MergedVertices restrict_to(const Survey& survey, MergedVertices merged,
                           std::span<const std::uint32_t> lines) {
  if (lines.size() == survey.lines.size()) return merged;
  std::vector<bool> used(merged.xy.size());
  std::fill(used.begin(), used.begin() + static_cast<std::ptrdiff_t>(merged.point_count), true);
  for (const std::uint32_t l : lines) {
    for (std::size_t i = 0; i < survey.lines[l].xy.size(); ++i) used[merged.of_line(l, i)] = true;
  }
  MergedVertices kept;
  std::vector<std::uint32_t> number(merged.xy.size(), kNone);
  for (std::size_t v = 0; v < used.size(); ++v) {
    if (!used[v]) continue;
    number[v] = static_cast<std::uint32_t>(kept.xy.size());
    kept.xy.push_back(merged.xy[v]);
    kept.origins.push_back(merged.origins[v]);
  }
  kept.point_count = merged.point_count;
  kept.pixel = merged.pixel;
  kept.of_point = merged.of_point;
  kept.first_of_line = merged.first_of_line;
  kept.of_line_vertex.reserve(merged.of_line_vertex.size());
  for (const std::uint32_t v : merged.of_line_vertex) kept.of_line_vertex.push_back(number[v]);
  return kept;
}

std::vector<SegmentEnds> segments_of(const MergedVertices& vertices, std::span<const LinePiece> pieces) {
  std::vector<SegmentEnds> segments;
  segments.reserve(pieces.size());
  for (const LinePiece& piece : pieces) {
    segments.push_back(
        {vertices.of_line(piece.line, piece.vertex), vertices.of_line(piece.line, piece.vertex + 1)});
  }
  return segments;
}

std::vector<Passage> find_passages(const Survey& survey, const Drawing& drawing,
                                   std::span<const std::uint32_t> lines) {
  std::vector<Passage> passages;
  for (const std::uint32_t l : lines) {
    for (std::uint32_t i = 0; i < survey.lines[l].xy.size(); ++i) {
      passages.push_back({drawing.vertices.of_line(l, i), l, i, Passage::Where::AtVertex});
    }
  }
  for (std::size_t s = 0; s < drawing.pieces.size(); ++s) {
    const auto chain = drawing.noding.chain(s);
    for (std::size_t i = 1; i + 1 < chain.size(); ++i) {
      passages.push_back(
          {chain[i], drawing.pieces[s].line, drawing.pieces[s].vertex, Passage::Where::OnEdge});
    }
  }
  tbb::parallel_sort(passages.begin(), passages.end(), [](const Passage& p, const Passage& q) {
    return std::tie(p.vertex, p.line, p.at, p.where) < std::tie(q.vertex, q.line, q.at, q.where);
  });
  return passages;
}

void append_crossings(Drawing& drawing) {
  MergedVertices& vertices = drawing.vertices;
  const std::size_t first = vertices.xy.size();
  if (!drawing.noding.crossings.empty()) vertices.along_curve.clear();
  vertices.xy.insert(vertices.xy.end(), drawing.noding.crossings.begin(), drawing.noding.crossings.end());
  vertices.origins.resize(vertices.xy.size());
  for (std::size_t i = drawing.passages.size(); i-- > 0;) {
    const Passage& passage = drawing.passages[i];
    if (passage.vertex < first) break;
    vertices.origins[passage.vertex] = {VertexOrigin::Kind::Crossing, passage.line, passage.at};
  }
}

[[noreturn]] void refuse(const Survey& survey, std::span<const LinePiece> pieces,
                         const Noding::Failure& failure) {
  const LinePiece one = pieces[failure.segment];
  const LinePiece other = pieces[failure.other_segment];
  throw Error(
      ErrorCode::TooClose,
      fmt::format("{} and {} have vertices near {} that are too close together for double arithmetic; "
                  "merge them with --snap DISTANCE",
                  describe_line_edge(survey, one.line, one.vertex),
                  describe_line_edge(survey, other.line, other.vertex),
                  describe_place(survey, failure.place)));
}

}  // namespace

Drawing draw(const Survey& survey, MergedVertices merged, std::span<const std::uint32_t> lines,
             Progress& progress) {
  Drawing drawing;
  drawing.vertices = restrict_to(survey, std::move(merged), lines);
  if (lines.empty()) return drawing;
  for (const std::uint32_t l : lines) {
    for (std::uint32_t i = 0; i + 1 < survey.lines[l].xy.size(); ++i) drawing.pieces.push_back({l, i});
  }
  const std::vector<SegmentEnds> segments = segments_of(drawing.vertices, drawing.pieces);
  drawing.noding = node_segments(drawing.vertices.xy, segments, progress, drawing.vertices.pixel);
  if (drawing.noding.failure) refuse(survey, drawing.pieces, *drawing.noding.failure);
  drawing.passages = find_passages(survey, drawing, lines);
  append_crossings(drawing);
  return drawing;
}

std::vector<ConstraintEdge> constraint_edges(const Survey& survey, const Drawing& drawing) {
  std::vector<ConstraintEdge> edges;
  for (std::size_t s = 0; s < drawing.pieces.size(); ++s) {
    const auto chain = drawing.noding.chain(s);
    const EdgeKind kind = survey.lines[drawing.pieces[s].line].kind;
    for (std::size_t i = 0; i + 1 < chain.size(); ++i) {
      const auto [low, high] = std::minmax(chain[i], chain[i + 1]);
      edges.push_back({VertexId{low}, VertexId{high}, kind});
    }
  }
  const auto ends = [](const ConstraintEdge& edge) { return std::pair(edge.a, edge.b); };
  tbb::parallel_sort(edges.begin(), edges.end(),
                     [&](const auto& p, const auto& q) { return ends(p) < ends(q); });
  std::size_t count = 0;
  for (const ConstraintEdge& edge : edges) {
    if (count > 0 && ends(edges[count - 1]) == ends(edge)) {
      edges[count - 1].kind = edges[count - 1].kind | edge.kind;
    } else {
      edges[count++] = edge;
    }
  }
  edges.resize(count);
  return edges;
}

}  // namespace thalweg
