#pragma once

/// Lines of a mesh file, found again among the edges of its triangles.

#include <thalweg/io/read_tin.hpp>

#include <cstddef>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace thalweg {

/// Collects the edges of triangles along pieces of lines.
/// Laws: (1) an edge is found if one end of its piece is a vertex and all edges from there on, or to there,
/// lie exactly on the piece; (2) an edge of several lines has the kinds of all; (3) pieces that edges do not
/// cover are counted. Pre: the ids of the triangles are indices of the points; both outlive the matcher.
class LineMatcher {
 public:
  LineMatcher(std::span<const Point2> points, std::span<const Triangle> triangles);

  /// A piece from one place to another; an end that is no vertex is an invalid id.
  struct Piece {
    Point2 from, to;
    VertexId from_vertex, to_vertex;
  };
  void add(const Piece& piece, EdgeKind kind);
  void add(VertexId from, VertexId to, EdgeKind kind);
  /// Adds the edges to the constraints, and a note of what was not found. `path` is for the note.
  void deliver(TinFile& tin, const std::string& path) const;

 private:
  using Side = std::pair<VertexId, VertexId>;
  /// Whether edges lead from `start` to `end`, which may be a vertex.
  bool follow(VertexId start, Point2 end, VertexId end_vertex, EdgeKind kind);
  [[nodiscard]] VertexId next_on(Point2 begin, VertexId v, Point2 end) const;

  std::span<const Point2> points_;
  std::vector<Side> sides_;  // both ways, sorted
  std::map<Side, EdgeKind> found_;
  std::size_t pieces_ = 0, uncovered_ = 0;
};

}  // namespace thalweg
