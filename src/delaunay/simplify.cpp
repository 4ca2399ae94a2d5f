// Simplification by greedy insertion (growing_tin.cpp) between fixed lines.
//
// 1. Fixed are the ends of constraint edges, and the vertices of the outline but those inside of a straight,
//    unconstrained piece of it: these lie on the outline whether or not they are there, so they may wait.
// 2. The fixed vertices are triangulated with the constraint edges and the outline as constraints; what lies
//    outside is dropped. All others wait in the triangles that hold them.
// 3. The worst is inserted until a limit is reached.
// 4. Triangles that are flat or turned over as written (the written coordinates bend against the plane, most
//    at a curved rim) get the neighbours that their corners have in the dense TIN, which is valid in both;
//    then step 3 again.
#include "growing_tin.hpp"

#include <thalweg/base/assert.hpp>
#include <thalweg/base/error.hpp>
#include <thalweg/delaunay/simplify.hpp>
#include <thalweg/delaunay/surface.hpp>
#include <thalweg/delaunay/triangulate.hpp>
#include <thalweg/delaunay/trim.hpp>
#include <thalweg/geometry/predicates.hpp>
#include <thalweg/mesh/change_tin.hpp>
#include <thalweg/mesh/rim.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

namespace thalweg {

namespace {

using detail::GrowingTin;
using detail::kNoSide;

/// What of the dense TIN stays whatever the limits.
struct Frame {
  std::vector<bool> fixed;                             ///< per vertex
  std::vector<std::pair<VertexId, VertexId>> outline;  ///< straight pieces, the surface to their left
  bool convex = false;
};

Frame frame_of(const Tin& dense) {
  Frame frame;
  frame.fixed.assign(dense.vertex_count(), false);
  for (const ConstraintEdge& edge : dense.constraint_edges()) {
    frame.fixed[edge.a.index()] = true;
    frame.fixed[edge.b.index()] = true;
  }
  const std::vector<std::vector<VertexId>> loops = rim_loops(dense);
  std::vector<std::uint8_t> passes(dense.vertex_count(), 0);
  for (const auto& loop : loops) {
    for (const VertexId v : loop)
      passes[v.index()] = static_cast<std::uint8_t>(passes[v.index()] == 0 ? 1 : 2);
  }
  frame.convex = loops.size() == 1;
  for (const auto& loop : loops) {
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const VertexId before = loop[i == 0 ? loop.size() - 1 : i - 1], v = loop[i];
      const VertexId next = loop[i + 1 == loop.size() ? 0 : i + 1];
      const int turn = orientation(dense.point(before), dense.point(v), dense.point(next));
      if (turn != 0 || passes[v.index()] > 1) frame.fixed[v.index()] = true;
      if (turn < 0 || passes[v.index()] > 1) frame.convex = false;
    }
    const auto start =
        std::find_if(loop.begin(), loop.end(), [&](VertexId v) { return frame.fixed[v.index()]; });
    std::vector<VertexId> corners;
    std::for_each(start, loop.end(), [&](VertexId v) {
      if (frame.fixed[v.index()]) corners.push_back(v);
    });
    for (std::size_t i = 0; i < corners.size(); ++i) {
      frame.outline.emplace_back(corners[i], corners[i + 1 == corners.size() ? 0 : i + 1]);
    }
  }
  return frame;
}

class Simplifier {
 public:
  Simplifier(const Tin& dense, const SimplifyOptions& options, Progress& progress)
      : dense_(dense),
        options_(options),
        progress_(progress),
        frame_(frame_of(dense)),
        growing_(dense.points(), dense.heights(), options.max_error.value_or(0)) {}

  Simplified run() {
    start();
    Simplified result;
    do {
      result.stop = grow();
    } while (mend_written());
    take_result(result);
    return result;
  }

 private:
  void start();
  SimplifyStop grow();
  bool mend_written();
  void take_result(Simplified& result) const;

  const Tin& dense_;
  const SimplifyOptions& options_;
  Progress& progress_;
  Frame frame_;
  GrowingTin growing_;
  std::size_t count_ = 0;  ///< vertices that are in
};

// Step 2.
void Simplifier::start() {
  std::vector<std::uint32_t> ids, number(dense_.vertex_count(), kNoSide);
  std::vector<Point2> points;
  std::vector<double> heights;
  for (std::uint32_t v = 0; v < dense_.vertex_count(); ++v) {
    if (!frame_.fixed[v]) continue;
    number[v] = static_cast<std::uint32_t>(ids.size());
    ids.push_back(v);
    points.push_back(dense_.points()[v]);
    heights.push_back(dense_.heights()[v]);
  }
  count_ = ids.size();
  const auto renumbered = [&](VertexId v) { return VertexId{number[v.index()]}; };
  std::vector<ConstraintEdge> constraints;
  for (const ConstraintEdge& edge : dense_.constraint_edges()) {
    constraints.push_back({renumbered(edge.a), renumbered(edge.b), edge.kind});
  }
  std::vector<std::pair<VertexId, VertexId>> outline;
  for (const auto& [a, b] : frame_.outline) {
    outline.emplace_back(renumbered(a), renumbered(b));
    constraints.push_back({renumbered(a), renumbered(b), EdgeKind::Boundary});
  }
  Tin tin = triangulate(std::move(points), std::move(heights), constraints, progress_, options_.engine);
  tin = keep_triangles(tin, inside_outline(tin, outline));
  progress_.start_phase("simplify");
  growing_.start(tin, ids, progress_);
}

// Step 3.
SimplifyStop Simplifier::grow() {
  constexpr std::size_t kInsertionsBetweenChecks = 256;
  while (true) {
    const std::optional<std::uint32_t> worst = growing_.worst();
    if (!worst) {
      if (growing_.find_missed(progress_)) continue;
      return options_.max_error ? SimplifyStop::MaxError : SimplifyStop::Exact;
    }
    if (options_.max_vertices && count_ >= *options_.max_vertices) return SimplifyStop::MaxVertices;
    growing_.insert(*worst);
    ++count_;
    if (count_ % kInsertionsBetweenChecks != 0) continue;
    progress_.advance(options_.max_vertices
                          ? static_cast<double>(count_) / static_cast<double>(*options_.max_vertices)
                          : 0);
  }
}

// Step 4; whether anything was inserted.
bool Simplifier::mend_written() {
  growing_.place_all();
  if (options_.written.empty()) return false;
  std::vector<std::uint32_t> wanted;
  for (const detail::Cell& cell : growing_.cells()) {
    const auto [a, b, c] = cell.vertex;
    if (orientation(options_.written[a], options_.written[b], options_.written[c]) > 0) continue;
    for (const std::uint32_t v : cell.vertex) {
      for (const HalfedgeId h : dense_.outgoing(VertexId{v})) {
        for (const VertexId near : {dense_.target(h), dense_.apex(h)}) wanted.push_back(near.value());
      }
    }
  }
  std::sort(wanted.begin(), wanted.end());
  wanted.erase(std::unique(wanted.begin(), wanted.end()), wanted.end());
  std::erase_if(wanted, [&](std::uint32_t v) { return growing_.cell_of_waiting(v) == kNoSide; });
  for (const std::uint32_t v : wanted) growing_.insert(v);
  count_ += wanted.size();
  return !wanted.empty();
}

void Simplifier::take_result(Simplified& result) const {
  const std::size_t dense_count = dense_.vertex_count();
  std::vector<VertexId> number(dense_count);
  std::vector<Point2> points;
  std::vector<double> heights;
  for (std::uint32_t v = 0; v < dense_count; ++v) {
    result.fixed += frame_.fixed[v] ? 1 : 0;
    if (growing_.cell_of_waiting(v) != kNoSide) {
      result.left_out.emplace_back(v);
      continue;
    }
    number[v] = VertexId{result.kept.size()};
    result.kept.emplace_back(v);
    points.push_back(dense_.points()[v]);
    heights.push_back(dense_.heights()[v]);
  }
  std::vector<ConstraintEdge> constraints;
  for (const ConstraintEdge& edge : dense_.constraint_edges()) {
    constraints.push_back({number[edge.a.index()], number[edge.b.index()], edge.kind});
  }
  std::vector<Triangle> triangles;
  result.outlined = !frame_.convex;
  for (const detail::Cell& cell : growing_.cells()) {
    Triangle& corner = triangles.emplace_back();
    for (std::size_t i = 0; i < 3; ++i) corner[i] = number[cell.vertex[i]];
    for (std::uint32_t i = 0; result.outlined && i < 3; ++i) {
      if (cell.neighbour[i] != kNoSide) continue;
      const VertexId a = corner[detail::after(i)], b = corner[detail::before(i)];
      const HalfedgeId h = dense_.find_halfedge(result.kept[a.index()], result.kept[b.index()]);
      if (!h.valid() || !dense_.constrained(h)) {
        constraints.push_back({a, b, EdgeKind::Boundary});
      }
    }
  }
  result.tin = Tin(std::move(points), std::move(heights), triangles, constraints);
  std::vector<TriangleId> made;
  made.reserve(triangles.size());
  for (const Triangle& corner : triangles) {
    made.push_back(Tin::triangle_of(result.tin.find_halfedge(corner[0], corner[1])));
  }
  result.left_out_in.reserve(result.left_out.size());
  for (const VertexId v : result.left_out) {
    result.left_out_in.push_back(made[growing_.cell_of_waiting(v.value())]);
  }
  result.max_error = growing_.largest_error();
}

}  // namespace

Simplified simplify(const Tin& dense, const SimplifyOptions& options, Progress& progress) {
  if (options.max_error && !(*options.max_error >= 0)) {
    throw Error(
        ErrorCode::Usage,
        fmt::format("the largest error of a simplified TIN has to be 0 or more, not {}", *options.max_error));
  }
  return Simplifier(dense, options, progress).run();
}

}  // namespace thalweg
