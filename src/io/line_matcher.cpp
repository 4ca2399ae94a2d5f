// Along a piece of a line the edges are followed from one end: the next one is that to the neighbour that
// lies exactly on the piece (exact predicate), farther on, and not beyond its end. Where there is none, the
// piece is followed from its other end, too. Lines of other programs often pass over vertices that they do
// not list.
#include "io/line_matcher.hpp"

#include <thalweg/geometry/predicates.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace thalweg {

namespace {

/// Whether b lies between a and c, and is not a. Pre: they are on one line.
bool goes_on(Point2 a, Point2 b, Point2 c) {
  const auto between = [](double p, double q, double r) { return (p < q && q <= r) || (p > q && q >= r); };
  return a.x != c.x ? between(a.x, b.x, c.x) : between(a.y, b.y, c.y);
}

}  // namespace

LineMatcher::LineMatcher(std::span<const Point2> points, std::span<const Triangle> triangles)
    : points_(points) {
  sides_.reserve(6 * triangles.size());
  for (const Triangle& t : triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      sides_.emplace_back(t[i], t[(i + 1) % 3]);
      sides_.emplace_back(t[(i + 1) % 3], t[i]);
    }
  }
  std::ranges::sort(sides_);
}

VertexId LineMatcher::next_on(Point2 begin, VertexId v, Point2 end) const {
  auto side = std::ranges::lower_bound(sides_, v, {}, &Side::first);
  for (; side != sides_.end() && side->first == v; ++side) {
    const Point2 p = points_[side->second.index()];
    if (orientation(begin, end, p) == 0 && goes_on(points_[v.index()], p, end)) return side->second;
  }
  return {};
}

bool LineMatcher::follow(VertexId start, Point2 end, VertexId end_vertex, EdgeKind kind) {
  const Point2 begin = points_[start.index()];
  for (VertexId v = start; points_[v.index()] != end;) {
    const bool is_edge = end_vertex.valid() && std::ranges::binary_search(sides_, Side{v, end_vertex});
    const VertexId next = is_edge ? end_vertex : next_on(begin, v, end);
    if (!next.valid()) return false;
    EdgeKind& known = found_[std::minmax(v, next)];
    known = known | kind;
    v = next;
  }
  return true;
}

void LineMatcher::add(const Piece& piece, EdgeKind kind) {
  if (piece.from == piece.to) return;
  ++pieces_;
  if (piece.from_vertex.valid() && follow(piece.from_vertex, piece.to, piece.to_vertex, kind)) return;
  if (piece.to_vertex.valid() && follow(piece.to_vertex, piece.from, piece.from_vertex, kind)) return;
  ++uncovered_;
}

void LineMatcher::add(VertexId from, VertexId to, EdgeKind kind) {
  add({points_[from.index()], points_[to.index()], from, to}, kind);
}

void LineMatcher::deliver(TinFile& tin, const std::string& path) const {
  for (const auto& [edge, kind] : found_) tin.constraints.push_back({edge.first, edge.second, kind});
  if (uncovered_ == 0) return;
  tin.notes.push_back(
      fmt::format("{}: {} of {} pieces of its lines do not run along edges of its triangles, "
                  "and are left out as far as they do not",
                  path, uncovered_, pieces_));
}

}  // namespace thalweg
